#include "core/compare/page_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/plain_text.h"
#include "core/compare/measures.h"

namespace whit {
namespace {

const char* status_word(const std::string& status) {
  return status == "same" ? "same" : status == "differs" ? "differs" : "cannot compare";
}

// Four digits; what is far below a thousandth with a power of ten.
std::string value_text(double v) {
  if (std::isinf(v)) return v > 0 ? "∞" : "−∞";
  return std::isnan(v) ? "NaN" : fmt::format("{:.4g}", v);
}

// Measures of the picture itself that have a limit in some row, in the order of the table of measures.
std::vector<std::string> columns_of(const std::vector<const PageRow*>& rows) {
  std::vector<std::string> columns;
  for (const MeasureRow& measure : all_measures())
    for (const PageRow* row : rows) {
      const Measured* m = row->comparison.find(measure.name);
      if (!m || !m->limit) continue;
      columns.emplace_back(measure.name);
      break;
    }
  return columns;
}

std::string measure_cell(const PageRow& row, const std::string& name) {
  const Measured* m = row.comparison.find(name);
  if (!m) return "<td></td>";
  const MeasureRow* measure = find_measure(name);
  const Failure* failure = row.comparison.failure_of(*m);
  std::string limit;
  if (m->limit && std::isfinite(*m->limit))
    limit = fmt::format("{}{}{}",
                        measure && measure->falls ? "≥\u00a0"
                        : name == "ratio"         ? "1\u00a0±\u00a0"
                                                  : "≤\u00a0",
                        value_text(*m->limit),
                        failure && failure->at ? fmt::format(" at {}, {}", failure->at->x, failure->at->y) : "");
  return fmt::format("<td class=\"m{}\" data-label=\"{}\"><b>{}</b><small>{}</small></td>", failure ? " bad" : "", name,
                     value_text(m->value), limit);
}

std::string picture_cell(const char* what, const std::string& address) {
  if (address.empty()) return "<td class=\"p\"></td>";
  return fmt::format(
      "<td class=\"p\" data-label=\"{0}\"><img src=\"{1}\" alt=\"{0}\" loading=\"lazy\" decoding=\"async\">"
      "</td>",
      what, address);
}

std::string row_html(const PageRow& row, size_t number, const std::vector<std::string>& columns) {
  const char* status = row_status(row);
  std::string out = fmt::format(
      "<tr class=\"row {0}\" data-row=\"{1}\" data-status=\"{0}\"><td class=\"left s\"><span "
      "class=\"pill {0}\">{2}</span></td>",
      status, number, status_word(status));
  out += fmt::format("<td class=\"left n\"><button class=\"open\">{}</button><p>{}</p></td>", html_text(row.name),
                     html_text(row_reason(row)));
  out += picture_cell("A", row.thumb_a) + picture_cell("B", row.thumb_b) + picture_cell("difference", row.thumb_heat);
  for (const std::string& column : columns) out += measure_cell(row, column);
  return out + "</tr>\n";
}

}  // namespace

std::string counts_html(const std::vector<const PageRow*>& rows) {
  std::string out = "<div class=\"counts\">";
  for (const char* status : {"differs", "cannot", "same"}) {
    const auto n = std::count_if(rows.begin(), rows.end(),
                                 [&](const PageRow* row) { return std::string(row_status(*row)) == status; });
    const std::string words = std::string(status) == "same"      ? (n == 1 ? "is the same" : "are the same")
                              : std::string(status) == "differs" ? (n == 1 ? "differs" : "differ")
                                                                 : "cannot be compared";
    if (n > 0)
      out += fmt::format("<button class=\"count {}\" data-status=\"{}\" aria-pressed=\"true\"><b>{}</b> {}</button>",
                         status, status, n, words);
  }
  return out + "</div>\n";
}

std::string table_html(const std::vector<const PageRow*>& rows) {
  const std::vector<std::string> columns = columns_of(rows);
  std::string out =
      "<div class=\"card scroll\"><table id=\"pictures\">\n<thead><tr><th class=\"left\"></th><th "
      "class=\"left\">picture</th><th class=\"p\">A</th><th class=\"p\">B</th><th class=\"p\">|A − B|</th>";
  for (const std::string& column : columns) {
    const MeasureRow* measure = find_measure(column);
    out += fmt::format("<th title=\"{}\"><code>{}</code></th>", html_text(measure ? measure->doc : ""), column);
  }
  out += "</tr></thead>\n<tbody>\n";
  for (size_t i = 0; i < rows.size(); ++i) out += row_html(*rows[i], i, columns);
  return out + "</tbody></table></div>\n";
}

}  // namespace whit
