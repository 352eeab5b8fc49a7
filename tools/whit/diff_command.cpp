// `whit diff`: whether two pictures differ, by how much and where.

#include <fmt/format.h>

#include <filesystem>
#include <tuple>

#include "core/base/stopwatch.h"
#include "core/compare/compare.h"
#include "core/compare/comparison_json.h"
#include "core/compare/heatmap.h"
#include "core/compare/noise.h"
#include "core/compare/report_page.h"
#include "tools/whit/diff_flags.h"
#include "tools/whit/diff_folders.h"
#include "tools/whit/diff_outputs.h"
#include "tools/whit/diff_text.h"
#include "tools/whit/json.h"
#include "tools/whit/terminal.h"
#include "tools/whit/update_references.h"

namespace whit {
namespace {

// Where fixed limits do not hold, noise may be all it is: the question that people ask next.
void hint_at_noise(const PicturePair& pair, const CompareRequest& request, std::FILE* out) {
  // Of large pictures it would take as long as comparing them.
  constexpr size_t kMost = size_t{4} << 20;
  if (request.limits.noise || request.limits.exact || !pair.beauty() || pair.pixels() > kMost) return;
  const NoiseVerdict verdict = test_noise(pair, request.limits.alpha);
  if (verdict.same)
    fmt::print(out, "hint: it can be noise alone ({}); --noise asks for that in the place of the default limits\n",
               verdict.estimated ? "an estimate" : "by the variances in the files");
}

int exit_code_of(const Comparison& c) { return !c.cannot.empty() ? kFileError : c.same() ? kDone : kNo; }

// An older one that is still there is of other pictures.
void say_no_heatmap(const DiffFlags& flags) {
  say(fmt::format("whit diff: {} is not written, as nothing was compared", flags.heatmap));
}

// Writes what shows the pictures; false when something cannot be written.
bool write_reports(const DiffFlags& flags, const std::string& name, const Comparison& c, const PicturePair& pair,
                   double seconds) {
  bool written = write_output(flags.junit, [&] { return junit_of(flags, {row_of(name, c, seconds)}); });
  written &= write_output(flags.html, [&] {
    ReportPage page;
    page.add(c, c.cannot.empty() ? &pair : nullptr);
    return page.html(fmt::format("{} against {}", flags.a, flags.b));
  });
  if (flags.heatmap.empty()) return written;
  if (!c.cannot.empty()) return say_no_heatmap(flags), written;
  const HeatSign sign = flags.heat_signed ? HeatSign::Signed : HeatSign::Absolute;
  const std::string problem = write_heatmap(flags.heatmap, pair, sign, flags.heat_scale);
  if (!problem.empty()) say("whit diff: " + problem);
  return written && problem.empty();
}

void print_comparison(const DiffFlags& flags, const Comparison& c, const PicturePair& pair,
                      const CompareRequest& request) {
  if (!c.cannot.empty()) return say("whit diff: " + c.cannot);
  if (flags.json) return;
  std::FILE* out = answer_stream(flags);
  fmt::print(out, "{}", diff_text(c, request.limits, flags.verbose, takes_colour(out)));
  if (!c.same() && c.nonfinite_count == 0) hint_at_noise(pair, request, out);
  std::fflush(out);
}

// Afterwards, for it says what was done, too: it is the same, as the exit code says, when the reference was replaced.
void print_json(const DiffFlags& flags, const Comparison& c, const Limits& limits, bool replaced) {
  Json::Object json = to_json(c, limits);
  if (replaced) json.front().second = true;
  if (flags.update) json.emplace_back("updated", replaced ? Json::Array{flags.b} : Json::Array{});
  fmt::print("{}\n", to_text(json));
  std::fflush(stdout);
}

// As among the pictures of folders: no failure, and in the reports.
int skip(const DiffFlags& flags, const std::string& name, const std::string& why) {
  if (flags.json)
    fmt::print("{}\n", to_text(Json::Object{{"same", true}, {"a", flags.a}, {"b", flags.b}, {"skipped", why}}));
  else fmt::print(answer_stream(flags), "skipped by the policy: {}\n", printable(why));
  if (!flags.heatmap.empty()) say_no_heatmap(flags);
  const DiffRow row{DiffStatus::Skipped, name, why, {}, 0};
  bool written = write_output(flags.junit, [&] { return junit_of(flags, {row}); });
  written &=
      write_output(flags.html, [&] { return ReportPage().html(fmt::format("{} against {}", flags.a, flags.b)); });
  return written ? kDone : kFileError;
}

int diff_files(const DiffFlags& flags, const Policy& policy) {
  const std::string name = policy.path.empty() ? flags.b : policy.name_of(flags.b);
  std::error_code failed;
  const std::string why = policy.settings_for(name).skip.value_or("");
  // Of a reference that is not there nothing is skipped: it may be another that is meant.
  if (!why.empty() && std::filesystem::exists(flags.b, failed)) return skip(flags, name, why);
  const CompareRequest request = request_of(flags, policy, name);
  const Stopwatch watch;
  PicturePair pair;
  const Comparison c = compare_files(flags.a, flags.b, request, &pair);
  const double seconds = watch.elapsed().wall;
  print_comparison(flags, c, pair, request);
  const bool written = write_reports(flags, name, c, pair, seconds);
  bool replaced = false;
  if (written && flags.update && !c.same())
    replaced = !update_references({{name, flags.a, flags.b, false, request}}, flags.yes,
                                  flags.json ? stderr : answer_stream(flags))
                    .empty();
  if (flags.json) print_json(flags, c, request.limits, replaced);
  return !written ? kFileError : replaced ? kDone : exit_code_of(c);
}

// Warns of what cannot be meant.
void warn_of_pair(const DiffFlags& flags, const Policy& policy) {
  std::error_code failed;
  if (std::filesystem::equivalent(flags.a, flags.b, failed) && !failed)
    say(fmt::format("whit diff: warning: \"{}\" and \"{}\" are one file", flags.a, flags.b));
  if (policy.path.empty()) return;
  for (const std::string& problem : policy.missed(flags.b)) say("whit diff: warning: " + problem);
}

int diff(const DiffFlags& flags) {
  const auto refuse = [](const std::string& problem, int code) { return say("whit diff: " + problem), code; };
  const Result<Policy> policy = flags.policy.empty() ? Result<Policy>() : read_policy(flags.policy);
  if (!policy.ok()) return refuse(policy.error, kUsage);
  if (const std::string problem = flag_without_effect(flags, policy.value); !problem.empty())
    return refuse(problem, kUsage);
  if (!flags.note.empty()) say("whit diff: note: " + flags.note);
  std::error_code failed;
  const auto is_folder = [&](const std::string& path) { return std::filesystem::is_directory(path, failed); };
  const auto is_file = [&](const std::string& path) {
    return std::filesystem::exists(path, failed) && !is_folder(path);
  };
  const bool a_folder = is_folder(flags.a), b_folder = is_folder(flags.b);
  for (const auto& [folder, other, is_one] :
       {std::tie(flags.a, flags.b, a_folder), std::tie(flags.b, flags.a, b_folder)})
    if (is_one && is_file(other))
      return refuse(fmt::format("\"{}\" is a folder and \"{}\" is none", folder, other), kUsage);
  if (a_folder || b_folder) return diff_folders(flags, policy.value);
  if (const std::string problem = flags.update ? update_problem(flags.yes) : ""; !problem.empty())
    return refuse(problem, kUsage);
  if (const std::string problem = outputs_conflict(flags, {flags.a, flags.b}); !problem.empty())
    return refuse(problem, kUsage);
  if (const std::string problem = outputs_problem(flags); !problem.empty()) return refuse(problem, kFileError);
  warn_of_pair(flags, policy.value);
  return diff_files(flags, policy.value);
}

}  // namespace

int diff_command(const Arguments& args) {
  DiffFlags flags;
  int code = kDone;
  if (!read_diff_flags(args, flags, code)) return code;
  return diff(flags);
}

}  // namespace whit
