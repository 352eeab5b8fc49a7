#include "tools/whit/diff_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/compare/measures.h"
#include "parser/source.h"

namespace whit {
namespace {

constexpr size_t kLongestName = 60;
/// Pictures without a reference that are named when nobody wants all of them.
constexpr size_t kMostExtra = 20;

struct Label {
  const char* text;
  const char* colour;
};

Label label_of(DiffStatus status) {
  switch (status) {
    case DiffStatus::Missing: return {"missing", "\x1b[31m"};
    case DiffStatus::Cannot: return {"cannot", "\x1b[31m"};
    case DiffStatus::Differs: return {"differs", "\x1b[31m"};
    case DiffStatus::Extra: return {"extra", "\x1b[33m"};
    case DiffStatus::Skipped: return {"skipped", "\x1b[33m"};
    case DiffStatus::Same: break;
  }
  return {"same", "\x1b[32m"};
}

/// How many places a text takes on a terminal: its characters, not its bytes.
size_t width_of(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, size_t width) {
  const size_t has = width_of(text);
  return has < width ? text + std::string(width - has, ' ') : text;
}

std::vector<const DiffRow*> in_order(const std::vector<DiffRow>& rows, bool verbose) {
  std::vector<const DiffRow*> order;
  for (const DiffRow& row : rows)
    if (verbose || row.status < DiffStatus::Skipped) order.push_back(&row);
  std::stable_sort(order.begin(), order.end(), [](const DiffRow* l, const DiffRow* r) {
    if (l->status != r->status) return l->status < r->status;
    return badness(l->comparison) > badness(r->comparison);
  });
  return order;
}

/// The measures of the picture itself that any row has, which become columns.
std::vector<std::string> measured_in(const std::vector<DiffRow>& rows) {
  std::vector<std::string> names;
  for (const MeasureRow& measure : all_measures()) {
    const auto has = [&](const DiffRow& row) { return row.comparison.find(measure.name) != nullptr; };
    if (std::any_of(rows.begin(), rows.end(), has)) names.emplace_back(measure.name);
  }
  return names;
}

std::string value_text(const Comparison& comparison, const std::string& measure) {
  const Measured* m = comparison.find(measure);
  return m == nullptr ? "-" : fmt::format("{:.4g}", m->value);
}

/// A row's cells behind status and name.
std::vector<std::string> cells_of(const DiffRow& row, const std::vector<std::string>& measures) {
  std::vector<std::string> cells;
  for (const std::string& measure : measures) cells.push_back(value_text(row.comparison, measure));
  return cells;
}

std::string cut(std::string line, size_t columns) {
  if (columns < 20 || width_of(line) <= columns) return line;
  while (width_of(line) > columns - 3 || (line.back() & 0xc0) == 0x80) line.pop_back();
  return line + "...";
}

std::string line_of(DiffStatus status, const std::string& rest, bool colour, size_t columns) {
  const Label label = label_of(status);
  const std::string line = cut(padded(label.text, 9) + rest, columns);
  const size_t length = std::string_view(label.text).size();
  return colour ? label.colour + line.substr(0, length) + "\x1b[0m" + line.substr(length) + "\n" : line + "\n";
}

std::string totals(const std::vector<DiffRow>& rows) {
  const auto count = [&](DiffStatus status) { return count_of(rows, status); };
  const size_t differ = count(DiffStatus::Differs), skipped = count(DiffStatus::Skipped);
  return fmt::format("{} same, {} differ{}, {} cannot be compared, {} missing, {} extra{}\n", count(DiffStatus::Same),
                     differ, differ == 1 ? "s" : "", count(DiffStatus::Cannot), count(DiffStatus::Missing),
                     count(DiffStatus::Extra), skipped ? fmt::format(", {} skipped", skipped) : "");
}

std::string reason_of(const Comparison& c) {
  if (!c.cannot.empty()) return c.cannot;
  if (c.failed.empty()) return "";
  return failure_text(c.failed.front()) + (c.failed.size() > 1 ? fmt::format("; {} more", c.failed.size() - 1) : "");
}

}  // namespace

DiffRow row_of(const std::string& name, const Comparison& comparison, double seconds) {
  const DiffStatus status = !comparison.cannot.empty() ? DiffStatus::Cannot
                            : comparison.same()        ? DiffStatus::Same
                                                       : DiffStatus::Differs;
  return {status, name, reason_of(comparison), comparison, seconds};
}

size_t count_of(const std::vector<DiffRow>& rows, DiffStatus status) {
  return static_cast<size_t>(
      std::count_if(rows.begin(), rows.end(), [&](const DiffRow& row) { return row.status == status; }));
}

std::string diff_table(const std::vector<DiffRow>& rows, bool verbose, bool colour, size_t columns) {
  const std::vector<const DiffRow*> order = in_order(rows, verbose);
  const std::vector<std::string> measures = verbose ? measured_in(rows) : std::vector<std::string>();
  size_t name_width = 0;
  std::vector<size_t> widths;
  for (const std::string& measure : measures) widths.push_back(measure.size());
  for (const DiffRow* row : order) {
    name_width = std::max(name_width, std::min(width_of(printable(row->name)), kLongestName));
    const auto cells = cells_of(*row, measures);
    for (size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], cells[i].size());
  }
  std::string out;
  if (!measures.empty()) {
    out = std::string(9, ' ') + padded("", name_width);
    for (size_t i = 0; i < measures.size(); ++i) out += fmt::format("  {:>{}}", measures[i], widths[i]);
    out += "\n";
  }
  size_t extra = 0;
  for (const DiffRow* row : order) {
    if (row->status == DiffStatus::Extra && ++extra > kMostExtra && !verbose) continue;
    const auto cells = cells_of(*row, measures);
    std::string rest = padded(printable(row->name), name_width);
    for (size_t i = 0; i < cells.size(); ++i) rest += fmt::format("  {:>{}}", cells[i], widths[i]);
    if (!row->reason.empty()) rest += "  " + printable(row->reason);
    out += line_of(row->status, rest, colour, verbose ? 0 : columns);
  }
  if (extra > kMostExtra && !verbose)
    out += fmt::format("and {} more extra pictures (--verbose names them)\n", extra - kMostExtra);
  return out + totals(rows);
}

}  // namespace whit
