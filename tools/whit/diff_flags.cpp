#include "tools/whit/diff_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <tuple>

#include "core/base/plain_text.h"
#include "core/color/to_linear.h"
#include "core/compare/measures.h"
#include "tools/whit/command_line.h"
#include "tools/whit/quantities.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

std::string defaults() {
  std::string text;
  for (const MeasureRow& row : all_measures())
    if (row.limit) text.append(fmt::format("{}{}={:g}", text.empty() ? "" : " ", row.name, *row.limit));
  return text;
}

std::string about() {
  std::string text =
      "Says whether picture A differs from the reference B, by how much and where. A and B may be folders.\n"
      "Exit code 0 same, 1 differs, 2 wrong usage, 4 cannot compare.\n\nMeasures:\n";
  for (const MeasureRow& row : all_measures()) text.append(fmt::format("  {:<14} {}\n", row.name, row.doc));
  return text;
}

std::string slow_names() {
  std::string names;
  for (const MeasureRow& row : all_measures())
    if (row.slow) names.append(names.empty() ? "" : ", ").append(row.name);
  return names;
}

std::vector<std::string> offered_measures() {
  std::vector<std::string> names{"all"};
  for (const MeasureRow& row : all_measures())
    if (row.slow) names.emplace_back(row.name);
  return names;
}

// What flags are read into before it is known to be right.
struct Raw {
  std::vector<std::string> above, below, slow;
  std::vector<int> crop;
  std::string fail_pixels, colour_space, channels;
  std::optional<double> relmse, ratio, block, hard_fail, pixel_error, alpha, heat_scale;
  bool exact = false, allow_nonfinite = false, noise = false;
};

// Why a number is no limit, or "".
std::string limit_problem(const char* flag, const std::optional<double>& value) {
  if (!value || *value >= 0) return "";
  return fmt::format("{} needs a number that is not below 0 (inf switches a limit off)", flag);
}

std::string take_limits(const Raw& raw, CompareSettings& said) {
  Limits limits;
  for (const std::string& text : raw.above)
    if (std::string problem = add_limit(text, false, limits); !problem.empty()) return "--fail-above: " + problem;
  for (const std::string& text : raw.below)
    if (std::string problem = add_limit(text, true, limits); !problem.empty()) return "--fail-below: " + problem;
  said.limits = limits.of;
  for (const auto& [name, value] : {std::pair{"relmse", raw.relmse}, {"ratio", raw.ratio}, {"block", raw.block}}) {
    if (std::string problem = limit_problem(fmt::format("--{}", name).c_str(), value); !problem.empty()) return problem;
    if (value) said.limits[name] = *value;
  }
  // Who limits the plain one in the old way means it instead of the robust one.
  if (raw.relmse && !limits.of.contains("relmse_robust")) said.limits["relmse_robust"] = *raw.relmse;
  if (raw.block && !limits.of.contains("channel_block")) said.limits["channel_block"] = 2 * *raw.block;
  return "";
}

bool is_zero(const std::string& share) {
  double number = 1;
  const auto [rest, error] = std::from_chars(share.data(), share.data() + share.size(), number);
  const std::string_view unit(rest, static_cast<size_t>(share.data() + share.size() - rest));
  return error == std::errc() && number == 0 && !std::signbit(number) && (unit.empty() || unit == "%");
}

std::string take_pixels(const Raw& raw, CompareSettings& said) {
  for (const auto& [flag, value] : {std::pair{"--hard-fail", raw.hard_fail}, {"--pixel-error", raw.pixel_error}})
    if (std::string problem = limit_problem(flag, value); !problem.empty()) return problem;
  said.hard_fail = raw.hard_fail;
  said.pixel_error = raw.pixel_error;
  if (raw.fail_pixels.empty()) return "";
  const double share = share_of(raw.fail_pixels);
  if ((share == 0 && !is_zero(raw.fail_pixels)) || share > 1)
    return fmt::format("--fail-pixels: \"{}\" is no share of the pixels, as 1% or 0.01 is", raw.fail_pixels);
  if (share == 1 && raw.fail_pixels.back() != '%')
    return fmt::format("--fail-pixels: {} is all pixels, and nothing could fail; write 1%, or 100% to switch it off",
                       raw.fail_pixels);
  said.fail_pixels = share;
  return "";
}

std::string take_slow(const Raw& raw, CompareRequest& base) {
  for (const std::string& name : raw.slow) {
    if (name != "all" && !find_measure(name))
      return fmt::format("--measure: there is no measure \"{}\"; those that are not taken anyway are {}, or all", name,
                         slow_names());
    for (const MeasureRow& row : all_measures())
      if (row.slow && (name == "all" || name == row.name)) base.slow.emplace_back(row.name);
  }
  return "";
}

std::string take_crop(const Raw& raw, PairRequest& pair) {
  if (raw.crop.empty()) return "";
  const int x0 = raw.crop[0], x1 = raw.crop[1], y0 = raw.crop[2], y1 = raw.crop[3];
  if (x0 >= x1 || y0 >= y1)
    return fmt::format("--crop {} {} {} {}: it takes pixels x0 x1 y0 y1, of which x1 and y1 are the first left out", x0,
                       x1, y0, y1);
  pair.crop = true;
  pair.window = {{x0, y0}, {x1 - 1, y1 - 1}};
  return "";
}

std::string take_heat(const Raw& raw, DiffFlags& flags) {
  const std::string ending = lower_case(std::filesystem::path(flags.heatmap).extension().string());
  if (!flags.heatmap.empty() && ending != ".png")
    return fmt::format("--heatmap {}: a heat map is a PNG, and its name must end in .png", flags.heatmap);
  if (!raw.heat_scale) return "";
  if (!(*raw.heat_scale > 0) || !std::isfinite(*raw.heat_scale)) return "--heat-scale needs a number above 0";
  flags.heat_scale = *raw.heat_scale;
  return "";
}

// What --exact leaves nothing to decide for, or "".
std::string void_by_exact(const Raw& raw) {
  if (!raw.exact) return "";
  std::vector<const char*> names;
  for (const auto& [name, given] : {std::pair{"--fail-above", !raw.above.empty()},
                                    {"--fail-below", !raw.below.empty()},
                                    {"--fail-pixels", !raw.fail_pixels.empty()},
                                    {"--pixel-error", raw.pixel_error.has_value()},
                                    {"--hard-fail", raw.hard_fail.has_value()},
                                    {"--relmse", raw.relmse.has_value()},
                                    {"--ratio", raw.ratio.has_value()},
                                    {"--block", raw.block.has_value()},
                                    {"--noise", raw.noise},
                                    {"--alpha", raw.alpha.has_value()}})
    if (given) names.push_back(name);
  if (names.empty()) return "";
  return fmt::format("--exact wants every number equal; beside it {} decide{} nothing", fmt::join(names, ", "),
                     names.size() == 1 ? "s" : "");
}

std::string take(const Raw& raw, DiffFlags& flags) {
  CompareSettings& said = flags.said;
  if (raw.exact) said.exact = true;
  if (raw.allow_nonfinite) said.allow_nonfinite = true;
  if (raw.noise) said.noise = true;
  said.alpha = raw.alpha;
  if (!raw.channels.empty()) said.channels = raw.channels;
  std::string problem;
  if (!raw.colour_space.empty()) {
    said.colour_space = raw.colour_space;
    problem = make_to_linear(raw.colour_space).error;
  }
  if (problem.empty()) problem = take_limits(raw, said);
  if (problem.empty()) problem = take_pixels(raw, said);
  if (problem.empty()) problem = take_slow(raw, flags.base);
  if (problem.empty()) problem = take_crop(raw, flags.base.pair);
  if (problem.empty()) problem = take_heat(raw, flags);
  flags.note = void_by_exact(raw);
  if (problem.empty() && flags.yes && !flags.update) problem = "--yes goes with --update";
  return problem;
}

}  // namespace

bool read_diff_flags(const Arguments& args, DiffFlags& flags, int& code) {
  Raw raw;
  const std::string description = about();
  const std::string above = "Limit MEASURE=VALUE, as often as wanted, of " +
                            fmt::format("{}", fmt::join(measure_names(false), ", ")) +
                            "; inf switches one off. By default: " + defaults();
  const std::string below =
      "The same of measures that fall: " + fmt::format("{}", fmt::join(measure_names(true), ", ")) +
      ". By default none";
  const std::string slow = "Also take a measure that takes long: " + slow_names() + ", or all";
  const FlagRules repeats{.repeats = true};
  const CommandLine command{
      "whit diff",
      description.c_str(),
      {{"a", &flags.a, "The picture that is judged, or a folder", {.required = true, .files = ""}},
       {"b", &flags.b, "The reference, or a folder", {.required = true, .files = ""}},
       {"--channels", &raw.channels, "Only channels of these patterns: 'R,G,B,Albedo.*', '!variance.*' all but these"},
       {"--colorspace", &raw.colour_space,
        "Of files with whole numbers: sRGB, Rec709, linear, gamma=2.2, or one of $OCIO's. By default the file's own"},
       {"--crop", &raw.crop, "Only pixels x0 <= x < x1, y0 <= y < y1, given as x0 x1 y0 y1", {.count = 4}},
       {"--fail-above", &raw.above, above.c_str(), repeats},
       {"--fail-below", &raw.below, below.c_str(), repeats},
       {"--fail-pixels", &raw.fail_pixels, "Share of the pixels that may be off by more than --pixel-error: 1%, 0.01"},
       {"--pixel-error", &raw.pixel_error, "What --fail-pixels counts, more than that; by default any difference"},
       {"--hard-fail", &raw.hard_fail, "No channel of any pixel may be off by more"},
       {"--exact", &raw.exact, "Every number of every channel must be equal; then no other limit holds"},
       {"--allow-nonfinite", &raw.allow_nonfinite, "NaN and infinity are no failure by themselves"},
       {"--noise", &raw.noise, "Ask whether it is only noise, in the place of the default limits"},
       {"--alpha",
        &raw.alpha,
        "Of pairs that differ by noise alone --noise calls so many different; by default 0.001",
        {.least = kLeastAlpha, .most = kMostAlpha}},
       {"--measure", &raw.slow, slow.c_str(), {.repeats = true, .offers = offered_measures}},
       {"--relmse", &raw.relmse, "Limit of relmse and relmse_robust"},
       {"--ratio", &raw.ratio, "The same as --fail-above ratio="},
       {"--block", &raw.block, "Limit of block; of channel_block twice that"},
       {"--policy", &flags.policy, "JSON file with limits for paths (docs/diff-in-ci.md)", {.files = "json"}},
       {"--heatmap", &flags.heatmap, "Write a PNG of |a - b|", {.files = "png"}},
       {"--signed", &flags.heat_signed, "The heat map is of a - b"},
       {"--heat-scale", &raw.heat_scale,
        "What the map's end stands for; by default what 99.9 % of the pixels are within"},
       {"--html", &flags.html, "Write a page to look at the pictures with", {.files = "html"}},
       {"--junit", &flags.junit, "Write a file for CI systems", {.files = "xml"}},
       {"--update", &flags.update, "Copy A over the references that failed, when asked"},
       {"--yes", &flags.yes, "Do not ask"},
       {"--verbose,-v", &flags.verbose, "A table of all measures"},
       {"--json", &flags.json, "Print what was found as JSON"}}};
  if (!parse_arguments(command, args, code)) return false;
  const std::string problem = take(raw, flags);
  if (problem.empty()) return true;
  say("whit diff: " + problem);
  code = kUsage;
  return false;
}

std::string flag_without_effect(const DiffFlags& flags, const Policy& policy) {
  const CompareSettings& said = flags.said;
  const auto a_rule = [&](const auto& says) { return std::any_of(policy.rules.begin(), policy.rules.end(), says); };
  const bool counts = said.fail_pixels || a_rule([](const PolicyRule& r) { return r.says.fail_pixels.has_value(); });
  const bool noise = said.noise || a_rule([](const PolicyRule& r) { return r.says.noise.value_or(false); });
  const bool map = !flags.heatmap.empty();
  for (const auto& [given, flag, other] : {std::tuple{said.pixel_error && !counts, "--pixel-error", "--fail-pixels"},
                                           {said.alpha && !noise, "--alpha", "--noise"},
                                           {flags.heat_signed && !map, "--signed", "--heatmap"},
                                           {flags.heat_scale > 0 && !map, "--heat-scale", "--heatmap"}})
    if (given) return fmt::format("{} has no effect without {}", flag, other);
  return "";
}

CompareRequest request_of(const DiffFlags& flags, const Policy& policy, const std::string& name) {
  CompareSettings settings = policy.settings_for(name);
  settings.lay(flags.said);
  CompareRequest request = flags.base;
  settings.apply(request);
  return request;
}

}  // namespace whit
