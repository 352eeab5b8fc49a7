// The report for a terminal: ASCII, as all of the program says.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/accuracy/report.h"
#include "core/accuracy/report_axis.h"
#include "core/accuracy/report_words.h"
#include "core/base/plain_text.h"

namespace whit {
namespace {

constexpr int kLeastColumns = 80, kMostColumns = 140;

// Escape sequences, or nothing.
struct Ink {
  const char *bold, *dim, *green, *yellow, *off;
};
constexpr Ink kColours{"\x1b[1m", "\x1b[2m", "\x1b[32m", "\x1b[33m", "\x1b[0m"};
constexpr Ink kPlain{"", "", "", "", ""};

// Words in lines of at most `columns`, all but the first indented by `indent`.
std::string wrapped(const std::string& text, int columns, int indent) {
  std::string out, line;
  const auto flush = [&] {
    out += line + "\n";
    line = std::string(static_cast<size_t>(indent), ' ');
  };
  bool empty = true;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!empty && line.size() + 1 + word.size() > static_cast<size_t>(columns)) flush(), empty = true;
    line += (empty ? "" : " ") + word;
    empty = false;
    at = end + 1;
  }
  flush();
  return out;
}

struct Column {
  std::string name;
  std::vector<std::string> cells;
  int rank = 0;  // The highest go first where the terminal is narrow.
  bool left = false;

  size_t width() const {
    size_t w = name.size();
    for (const std::string& cell : cells) w = std::max(w, cell.size());
    return w;
  }
  std::string padded(const std::string& cell) const {
    return left ? fmt::format("{:<{}}", cell, width()) : fmt::format("{:>{}}", cell, width());
  }
};

size_t total_width(const std::vector<Column>& columns) {
  size_t width = 0;
  for (const Column& column : columns) width += column.width() + 2;
  return width;
}

void drop_to_fit(std::vector<Column>& columns, int width) {
  while (total_width(columns) > static_cast<size_t>(width)) {
    const auto least = std::max_element(columns.begin(), columns.end(),
                                        [](const Column& a, const Column& b) { return a.rank < b.rank; });
    if (least->rank == 0) return;
    columns.erase(least);
  }
}

// `ink_of` is the colour of a row.
template <class InkOf>
std::string table(std::vector<Column> columns, int width, const Ink& ink, const InkOf& ink_of) {
  if (columns.front().cells.empty()) return "";
  drop_to_fit(columns, width);
  std::string out = ink.bold;
  for (const Column& column : columns) out += "  " + column.padded(column.name);
  out += fmt::format("{}\n", ink.off);
  for (size_t row = 0; row < columns.front().cells.size(); ++row) {
    std::string line;
    for (const Column& column : columns) line += "  " + column.padded(column.cells[row]);
    line.erase(line.find_last_not_of(' ') + 1);
    out += ink_of(row) + line + ink.off + "\n";
  }
  return out;
}

std::string settings_table(const CostReport& report, int width, const Ink& ink) {
  std::vector<Column> columns{
      {"", {}, 0, true}, {"setting", {}, 0, true}, {"CPU", {}},     {"least, most", {}, 2}, {"wall", {}, 5},
      {"nRMSE", {}},     {"sure below", {}, 1},    {"bias", {}, 3}, {"> 2/255", {}, 6},     {"FLIP", {}, 7}};
  for (const CostSetting& s : report.settings) {
    const std::string cells[] = {s.pareto ? "*" : " ",
                                 setting_name(s),
                                 seconds_text(s.cpu_seconds.value),
                                 seconds_range(s.cpu_seconds),
                                 seconds_text(s.seconds.value),
                                 percent_interval(s.nrmse),
                                 percent_text(s.upper95),
                                 s.bias ? percent_interval(*s.bias) : "",
                                 percent_text(s.share_2_255),
                                 three_digits(s.flip)};
    for (size_t i = 0; i < columns.size(); ++i) columns[i].cells.push_back(cells[i]);
  }
  std::erase_if(columns, [](const Column& c) {
    return c.name == "bias" && std::all_of(c.cells.begin(), c.cells.end(), [](auto& cell) { return cell.empty(); });
  });
  return table(columns, width, ink,
               [&](size_t row) { return std::string(report.settings[row].pareto ? ink.green : ink.dim); });
}

std::string effects_table(const CostReport& report, int width, const Ink& ink) {
  std::vector<Column> columns{{"effect", {}, 0, true},
                              {"CPU seconds it takes", {}},
                              {"of all", {}, 2},
                              {"changes the mean by", {}, 1},
                              {"and of the pixels", {}, 1}};
  for (const CostEffect& e : report.effects) {
    const std::string cells[] = {one_line(e.name), effect_seconds(e), e.resolved ? percent_text(e.share) : "",
                                 signed_percent_text(e.mean_change), percent_text(e.pixels_changed)};
    for (size_t i = 0; i < columns.size(); ++i) columns[i].cells.push_back(cells[i]);
  }
  return table(columns, width, ink,
               [&](size_t row) { return std::string(report.effects[row].resolved ? "" : ink.dim); });
}

// A grid of characters with logarithmic axes.
struct Plot {
  int width, height;
  LogAxis x, y;
  std::vector<std::string> rows;

  int column(double value) const { return static_cast<int>(std::lround(x.place(value) * (width - 1))); }
  int row(double value) const { return static_cast<int>(std::lround((1 - y.place(value)) * (height - 1))); }
  char& at(int column, int row) { return rows[static_cast<size_t>(row)][static_cast<size_t>(column)]; }

  void line(double x0, double y0, double x1, double y1, char c) {
    const int c0 = column(x0), r0 = row(y0), c1 = column(x1), r1 = row(y1);
    const int steps = std::max({std::abs(c1 - c0), std::abs(r1 - r0), 1});
    for (int i = 0; i <= steps; ++i)
      at(c0 + static_cast<int>(std::lround(double(i) * (c1 - c0) / steps)),
         r0 + static_cast<int>(std::lround(double(i) * (r1 - r0) / steps))) = c;
  }
};

bool can_be_drawn(const CostSetting& s) {
  return s.cpu_seconds.value > 0 && s.nrmse.value > 0 && std::isfinite(s.cpu_seconds.value) &&
         std::isfinite(s.nrmse.value);
}

// 'o' are numbers of samples, '+' other knobs, 'x' what something measured beats.
char mark_of(const CostSetting& s) { return !s.pareto ? 'x' : s.knob == "samples" ? 'o' : '+'; }

void draw(Plot& plot, const std::vector<CostSetting>& settings) {
  const CostSetting* before = nullptr;
  for (const CostSetting& s : settings) {
    if (s.knob != "samples" || !can_be_drawn(s)) continue;
    if (before) plot.line(before->cpu_seconds.value, before->nrmse.value, s.cpu_seconds.value, s.nrmse.value, '.');
    before = &s;
  }
  for (bool pareto : {false, true})
    for (const CostSetting& s : settings)
      if (s.pareto == pareto && can_be_drawn(s))
        plot.at(plot.column(s.cpu_seconds.value), plot.row(s.nrmse.value)) = mark_of(s);
}

// The numbers under the axis, each below its mark where there is room.
std::string axis_labels(const Plot& plot, int margin) {
  std::string out(static_cast<size_t>(margin), ' ');
  for (double tick : plot.x.ticks(plot.width / 12)) {
    const std::string text = seconds_tick(tick);
    const size_t from =
        static_cast<size_t>(margin + std::max(0, plot.column(tick) - static_cast<int>(text.size()) / 2));
    if (from < out.size() && out.size() > static_cast<size_t>(margin)) continue;
    out.resize(std::max(from, out.size()), ' ');
    out += text;
  }
  return out + "\n";
}

std::string plot_text(const CostReport& report, int columns, const Ink& ink) {
  std::vector<double> seconds, errors;
  for (const CostSetting& s : report.settings) {
    if (!can_be_drawn(s)) continue;
    seconds.push_back(s.cpu_seconds.value);
    errors.push_back(s.nrmse.value);
  }
  if (seconds.size() < 2) return "";
  constexpr int kMargin = 10, kHeight = 12;
  const int width = std::min(columns, 90) - kMargin - 2;
  Plot plot{width, kHeight, axis_over(seconds), axis_over(errors), {}};
  plot.rows.assign(kHeight, std::string(static_cast<size_t>(width), ' '));
  draw(plot, report.settings);
  std::vector<std::string> labels(kHeight);
  for (double tick : plot.y.ticks(kHeight / 2)) labels[static_cast<size_t>(plot.row(tick))] = percent_tick(tick);
  std::string out = fmt::format("  {}nRMSE{} by CPU seconds: o samples, + others, x beaten\n\n", ink.bold, ink.off);
  for (size_t r = 0; r < plot.rows.size(); ++r) {
    std::string line = fmt::format("{:>{}} {} {}", labels[r], kMargin - 2, labels[r].empty() ? '|' : '+', plot.rows[r]);
    out += line.erase(line.find_last_not_of(' ') + 1) + "\n";
  }
  std::string ruler(static_cast<size_t>(width), '-');
  for (double tick : plot.x.ticks(width / 12)) ruler[static_cast<size_t>(plot.column(tick))] = '+';
  return out + std::string(kMargin - 1, ' ') + "+-" + ruler + "\n" + axis_labels(plot, kMargin + 1);
}

std::string worst_text(const CostReport& report, int columns) {
  if (report.half_error_pixels == 0) return "";
  const double all = double(report.resolution.x) * report.resolution.y;
  const std::string of_all = all > 0 ? fmt::format(" ({})", percent_text(double(report.half_error_pixels) / all)) : "";
  std::string out = fmt::format("Half of the squared error is in {} pixels{}:\n", report.half_error_pixels, of_all);
  constexpr size_t kShown = 5;
  for (size_t i = 0; i < std::min(kShown, report.worst.size()); ++i) {
    const CostWorst& w = report.worst[i];
    std::string line = fmt::format("  {} of all is {}", percent_text(w.share),
                                   w.shape.empty() ? "where rays leave the scene" : "on " + one_line(w.shape));
    if (!w.light.empty()) line += " by " + one_line(w.light);
    line += fmt::format(", most of it at ({}, {})", w.pixel.x, w.pixel.y);
    out += wrapped(line, columns, 4);
  }
  return out + "\n";
}

std::string answers_text(const CostReport& report, int columns, const Ink& ink) {
  std::string out;
  for (const CostAnswer& a : report.answers) {
    const std::string text = one_line(a.text) + (a.extrapolated ? " (extrapolated)" : "");
    out += ink.bold + wrapped("* " + text, columns, 2) + ink.off;
    if (!a.command.empty()) out += fmt::format("    {}{}{}\n", ink.green, one_line(a.command), ink.off);
  }
  return out.empty() ? out : out + "\n";
}

std::string not_known_text(const CostReport& report, int columns, const Ink& ink) {
  if (report.not_known.empty()) return "";
  std::string out = fmt::format("{}Not known:{}\n", ink.bold, ink.off);
  for (const std::string& what : report.not_known) out += wrapped("  - " + one_line(what), columns, 4);
  return out;
}

std::string head_text(const CostReport& report, int columns, const Ink& ink) {
  std::string out = fmt::format("{}{}{}\n", ink.bold, one_line(report.scene), ink.off);
  out += wrapped(
      one_line(fmt::format("{} x {} pixels, {} integrator, {} sampler, {} samples asked for; {}", report.resolution.x,
                           report.resolution.y, report.integrator, report.sampler, report.own_samples, report.machine)),
      columns, 0);
  out += wrapped(reference_text(report), columns, 0);
  if (!report.complete)
    out += fmt::format("{}Ended early: this is what was measured by then.{}\n", ink.yellow, ink.off);
  return out + "\n";
}

}  // namespace

std::string cost_text(const CostReport& report, bool colour, int columns) {
  const Ink& ink = colour ? kColours : kPlain;
  const int width = std::clamp(columns, kLeastColumns, kMostColumns);
  std::string out = head_text(report, width, ink);
  if (!report.settings.empty()) {
    out += settings_table(report, width, ink);
    out += wrapped("  * nothing measured is both faster and nearer", width, 4) + "\n";
    out += plot_text(report, width, ink) + "\n";
    out += wrapped(fmt::format("{}; CPU seconds are {}.", order_text(report), time_text(report)), width, 0) + "\n";
  }
  if (!report.effects.empty())
    out += effects_table(report, width, ink) + "  Effects interact: these need not add up.\n\n";
  out += worst_text(report, width);
  return out + answers_text(report, width, ink) + not_known_text(report, width, ink);
}

}  // namespace whit
