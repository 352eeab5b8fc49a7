// The page, of its parts. Its script is several pieces, in this order: they share their names.
#include "core/compare/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "core/base/plain_text.h"
#include "core/compare/colour_maps.h"
#include "core/compare/page_data.h"
#include "core/compare/page_markup.h"
#include "core/compare/page_row.h"
#include "core/compare/page_script_base.h"
#include "core/compare/page_script_data.h"
#include "core/compare/page_script_main.h"
#include "core/compare/page_script_paint.h"
#include "core/compare/page_script_panel.h"
#include "core/compare/page_script_view.h"
#include "core/compare/page_style.h"
#include "core/compare/page_table.h"
#include "core/compare/page_viewer_style.h"

namespace whit {
namespace {

std::string inert(const std::string& id, const std::string& text) {
  return text.empty() ? "" : fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, text);
}

std::string row_id(size_t i) { return fmt::format("d{}", i); }

std::string data_html(const std::vector<const PageRow*>& rows) {
  std::string out, list;
  for (size_t i = 0; i < rows.size(); ++i) {
    list += (i ? ",\n" : "") + row_json(*rows[i], row_id(i));
    for (size_t k = 0; k < rows[i]->layers.size(); ++k)
      out += inert(fmt::format("{}-{}", row_id(i), k), rows[i]->layers[k].data);
    out += inert(row_id(i) + "-flip", rows[i]->flip);
  }
  return out + fmt::format(
                   "<script type=\"application/json\" id=\"rows\">[{}]</script>\n<script type=\"application/json\" "
                   "id=\"maps\">{{\"magma\":\"{}\",\"berlin\":\"{}\"}}</script>\n",
                   list, hex_text(kMagma), hex_text(kBerlin));
}

std::string head_html(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<link "
      "rel=\"icon\" href=\"data:,\">\n<title>{0}</title>\n<style>{1}{2}</style>\n</head>\n<body>\n<main>\n<header>\n<p "
      "class=\"kind\">Pictures compared</p>\n<h1>{0}</h1>\n",
      html_text(title), kPageStyle, kPageViewerStyle);
}

std::string outcome_html(const PageRow& row) {
  return fmt::format("<p class=\"outcome {}\">{}</p>\n", row_status(row), html_text(verdict_text(row.comparison)));
}

// A part of the page that may be left out: a layer of a row.
struct Part {
  PageRow* row;
  size_t layer;
};

// What goes first is less: other layers before beauties, of the best rows before those of the worst.
auto worth(const Part& part) { return std::tuple(part.layer == 0, part.row->badness); }

size_t size_of(const PageRow& row, size_t layer) {
  return row.layers[layer].data.size() + (layer == 0 ? row.flip.size() : 0);
}

}  // namespace

ReportPage::ReportPage(size_t budget) : budget_(budget) {}
ReportPage::~ReportPage() = default;

void ReportPage::add(const Comparison& comparison, const PicturePair* pair) {
  rows_.push_back(std::make_unique<PageRow>(make_page_row(comparison, pair)));
  for (size_t layer = 0; layer < rows_.back()->layers.size(); ++layer) used_ += size_of(*rows_.back(), layer);
  keep_to_budget();
}

void ReportPage::keep_to_budget() {
  if (used_ <= budget_) return;
  std::vector<Part> parts;
  for (const auto& row : rows_)
    for (size_t layer = 0; layer < row->layers.size(); ++layer)
      if (!row->layers[layer].data.empty()) parts.push_back({row.get(), layer});
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return worth(a) < worth(b); });
  for (size_t i = 0; i < parts.size() && used_ > budget_; ++i) {
    used_ -= size_of(*parts[i].row, parts[i].layer);
    parts[i].row->layers[parts[i].layer].data.clear();
    if (parts[i].layer == 0) parts[i].row->flip.clear();
  }
}

std::string ReportPage::html(const std::string& title) const {
  std::vector<const PageRow*> rows;
  for (const auto& row : rows_) rows.push_back(row.get());
  std::stable_sort(rows.begin(), rows.end(),
                   [](const PageRow* a, const PageRow* b) { return a->badness > b->badness; });
  // The viewer says all that a table of one row would.
  const bool viewer_alone = rows.size() == 1 && !rows[0]->layers.empty() && !rows[0]->layers[0].data.empty();
  std::string out = head_html(title);
  if (viewer_alone) out += outcome_html(*rows[0]) + "</header>\n";
  else out += counts_html(rows) + "</header>\n" + table_html(rows);
  out += kPageMarkup;
  out += "</main>\n";
  out += data_html(rows) + "<script>\n\"use strict\";\n";
  for (const char* piece :
       {kPageScriptBase, kPageScriptData, kPageScriptPaint, kPageScriptView, kPageScriptPanel, kPageScriptMain})
    out += piece;
  return out + "</script>\n</body>\n</html>\n";
}

}  // namespace whit
