#include "tools/whit/diff_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/compare/measures.h"
#include "core/compare/number_words.h"
#include "parser/source.h"

namespace whit {
namespace {

constexpr size_t kShown = 8;  // Failures and regions; --json has all.

std::string coloured(const std::string& text, const char* code, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}

std::string headline(const Comparison& c, bool colour) {
  const std::string text = printable(verdict_text(c));
  const size_t colon = std::min(text.find(':'), text.find(' '));
  return coloured(text.substr(0, colon), c.same() ? "1;32" : "1;31", colour) + text.substr(colon) + "\n";
}

std::string region_text(const NoiseRegion& r) {
  // Of means that are equal, or of black, there is no change in per cent.
  const bool told = std::isfinite(r.change) && r.change != 0;
  const std::string by =
      told ? fmt::format("by {}{}", r.change > 0 ? "+" : "", short_percent_text(r.change)) : "differs";
  std::string text = fmt::format("  {}: {} {}, {}", window_text(r.box), r.channel, by, p_text(r.p));
  for (size_t k = 0; k < r.objects.size(); ++k) text.append(k == 0 ? ", in " : ", ").append(r.objects[k]);
  return printable(text) + "\n";
}

template <class Of>
std::string first_lines(size_t count, size_t first, const Of& of) {
  std::string text;
  for (size_t i = first; i < std::min(count, first + kShown); ++i) text += of(i);
  if (count > first + kShown) text += fmt::format("  and {} more\n", count - first - kShown);
  return text;
}

std::string noise_text(const NoiseVerdict& noise) {
  std::string text = fmt::format("noise: {} ({}), {}", noise.same ? "it can be noise alone" : "it is more than noise",
                                 p_text(noise.p), printable(noise.how));
  if (noise.untested > 0)
    text += fmt::format("; of {} of the numbers nothing can be said", short_percent_text(noise.untested));
  text += "\n";
  return text + first_lines(noise.regions.size(), 0, [&](size_t i) { return region_text(noise.regions[i]); });
}

std::string limits_text(const Limits& limits) {
  if (limits.exact) return "limits: every number equal\n";
  std::string text = "limits:";
  for (const MeasureRow& row : all_measures())
    if (const auto limit = limit_of(row, limits); limit && std::isfinite(*limit))
      text.append(fmt::format(" {} {}{:g}", row.name, row.falls ? ">= " : "", *limit));
  if (limits.hard_fail && std::isfinite(*limits.hard_fail))
    text.append(fmt::format(" hard-fail {:g}", *limits.hard_fail));
  if (limits.fail_pixels && *limits.fail_pixels < 1)
    text.append(fmt::format(" fail-pixels {:g} %", 100 * *limits.fail_pixels));
  if (limits.noise) text.append(fmt::format(" noise alpha {:g}", limits.alpha));
  return text + (text.back() == ':' ? " none\n" : "\n");
}

std::string place_text(const Measured& m) {
  std::string text = m.channel;
  if (m.at) text.append(fmt::format("{}({}, {})", text.empty() ? "" : " ", m.at->x, m.at->y));
  if (!m.words.empty()) text.append(text.empty() ? "" : " ").append(m.words);
  return text;
}

std::string table(const Comparison& c, const Limits& limits, bool colour) {
  std::string text = fmt::format("{:<16} {:<14} {:>12} {:>10}  {}\n", "layer", "measure", "value", "limit", "where");
  for (const Measured& m : c.measured) {
    const auto limit = limit_of(*find_measure(m.measure), limits);
    const bool failed = c.failure_of(m) != nullptr;
    const std::string line =
        fmt::format("{:<16} {:<14} {:>12} {:>10}  {}", m.layer.empty() ? "(picture)" : printable(m.layer), m.measure,
                    fmt::format("{:.5g}", m.value), limit ? fmt::format("{:g}", *limit) : "", printable(place_text(m)));
    text += failed ? coloured(line, "31", colour) : line;
    text += '\n';
  }
  return text;
}

}  // namespace

std::string diff_text(const Comparison& c, const Limits& limits, bool verbose, bool colour) {
  std::string text = headline(c, colour);
  if (!c.cannot.empty()) return text;
  text += first_lines(c.failed.size(), 1, [&](size_t i) { return "  " + printable(failure_text(c.failed[i])) + "\n"; });
  if (c.noise) text += noise_text(*c.noise);
  for (const std::string& note : c.notes) text.append("note: ").append(printable(note)).append("\n");
  if (verbose) text += table(c, limits, colour);
  return text + coloured(limits_text(limits), "2", colour);
}

}  // namespace whit
