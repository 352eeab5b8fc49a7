#include "tools/whit/diff_folders.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/compare/comparison_json.h"
#include "core/compare/folders.h"
#include "core/compare/report_page.h"
#include "tools/whit/diff_outputs.h"
#include "tools/whit/diff_table.h"
#include "tools/whit/json.h"
#include "tools/whit/terminal.h"
#include "tools/whit/update_references.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// What is compared, how, and what was found out.
struct FolderDiff {
  const DiffFlags& flags;
  const Policy& policy;
  FolderPairs pairs;
  std::vector<DiffRow> rows;  ///< In the order of names.
  ReportPage page;
  std::vector<std::string> replaced;

  CompareRequest request(const std::string& name) const { return request_of(flags, policy, name); }
  /// Why a picture is left out, "" when it is not.
  std::string skip(const std::string& name) const { return policy.settings_for(name).skip.value_or(""); }
};

void complain(const std::string& problem) { say("whit diff: " + problem); }

std::string path_in(const std::string& folder, const std::string& name) { return (fs::path(folder) / name).string(); }

void compare_all(FolderDiff& diff) {
  std::vector<std::string> names;
  for (const std::string& name : diff.pairs.both)
    if (diff.skip(name).empty()) names.push_back(name);
  Progress progress("comparing");
  size_t done = 0;
  compare_folders(
      diff.flags.a, diff.flags.b, names, [&](const std::string& name) { return diff.request(name); },
      [&](const ComparedPair& pair) {
        const Comparison& c = pair.comparison;
        diff.rows.push_back(row_of(pair.name, c, pair.seconds));
        if (!diff.flags.html.empty()) diff.page.add(c, c.cannot.empty() ? &pair.pair : nullptr);
        progress.update(static_cast<double>(++done) / static_cast<double>(names.size()));
      });
}

std::string missing_reason(const FolderPairs& pairs, const std::string& name) {
  const auto alike = pairs.alike.find(name);
  if (alike == pairs.alike.end()) return "there is a reference, and no picture";
  return fmt::format("there is a reference, and no picture of that name; is {} meant?", alike->second);
}

/// All that is not compared.
void add_others(FolderDiff& diff) {
  const auto add = [&](DiffStatus status, const std::string& name, const std::string& reason) {
    const std::string why = diff.skip(name);
    diff.rows.push_back({why.empty() ? status : DiffStatus::Skipped, name, why.empty() ? reason : why, {}, 0});
  };
  for (const std::string& name : diff.pairs.both)
    if (!diff.skip(name).empty()) add(DiffStatus::Skipped, name, "");
  for (const std::string& name : diff.pairs.missing) add(DiffStatus::Missing, name, missing_reason(diff.pairs, name));
  for (const std::string& name : diff.pairs.extra) add(DiffStatus::Extra, name, "there is no reference");
  std::sort(diff.rows.begin(), diff.rows.end(), [](const DiffRow& l, const DiffRow& r) { return l.name < r.name; });
}

int exit_code_of(const FolderDiff& diff) {
  const std::set<std::string> replaced(diff.replaced.begin(), diff.replaced.end());
  int code = kDone;
  for (const DiffRow& row : diff.rows) {
    if (replaced.contains(row.name)) continue;
    if (row.status == DiffStatus::Missing || row.status == DiffStatus::Cannot) return kFileError;
    if (row.status == DiffStatus::Differs) code = kNo;
  }
  return code;
}

Json json_of(const FolderDiff& diff) {
  Json::Array pairs, skipped;
  std::vector<std::string> missing, extra;
  for (const DiffRow& row : diff.rows) {
    if (row.status == DiffStatus::Missing) {
      missing.push_back(row.name);
    } else if (row.status == DiffStatus::Extra) {
      extra.push_back(row.name);
    } else if (row.status == DiffStatus::Skipped) {
      skipped.push_back(Json::Object{{"name", row.name}, {"why", row.reason}});
    } else {
      Json::Object pair{{"name", row.name}};
      for (auto& member : to_json(row.comparison, diff.request(row.name).limits)) pair.push_back(std::move(member));
      pairs.push_back(std::move(pair));
    }
  }
  const auto count = [&](DiffStatus status) { return count_of(diff.rows, status); };
  return Json::Object{{"same", exit_code_of(diff) == kDone},
                      {"counts", Json::Object{{"same", count(DiffStatus::Same)},
                                              {"differ", count(DiffStatus::Differs)},
                                              {"cannot", count(DiffStatus::Cannot)}}},
                      {"missing", missing},
                      {"extra", extra},
                      {"skipped", std::move(skipped)},
                      {"updated", diff.replaced},
                      {"pairs", std::move(pairs)}};
}

std::vector<Compared> candidates(const FolderDiff& diff) {
  std::vector<Compared> out;
  for (const DiffRow& row : diff.rows) {
    if (row.status == DiffStatus::Extra) continue;
    const bool fails = row.status == DiffStatus::Differs || row.status == DiffStatus::Cannot;
    out.push_back(
        {row.name, path_in(diff.flags.a, row.name), path_in(diff.flags.b, row.name), !fails, diff.request(row.name)});
  }
  return out;
}

std::vector<std::string> pictures_of(const FolderDiff& diff) {
  std::vector<std::string> files;
  for (const auto* names : {&diff.pairs.both, &diff.pairs.extra})
    for (const std::string& name : *names) files.push_back(path_in(diff.flags.a, name));
  for (const auto* names : {&diff.pairs.both, &diff.pairs.missing})
    for (const std::string& name : *names) files.push_back(path_in(diff.flags.b, name));
  return files;
}

/// Warns of rules for pictures that there are not.
void check_rules(const FolderDiff& diff) {
  std::vector<std::string> names;
  for (const auto* some : {&diff.pairs.both, &diff.pairs.missing, &diff.pairs.extra})
    names.insert(names.end(), some->begin(), some->end());
  for (const std::string& problem : diff.policy.unmatched(names)) say("whit diff: warning: " + problem);
}

/// Warns of what is compared with itself, and so the same whatever it is.
void check_identity(const FolderDiff& diff) {
  std::error_code failed;
  if (fs::equivalent(diff.flags.a, diff.flags.b, failed) && !failed)
    return complain(fmt::format("warning: \"{}\" and \"{}\" are one folder", diff.flags.a, diff.flags.b));
  constexpr size_t kNamed = 10;
  std::vector<std::string> names;
  size_t count = 0;
  for (const std::string& name : diff.pairs.both)
    if (fs::equivalent(path_in(diff.flags.a, name), path_in(diff.flags.b, name), failed) && !failed &&
        ++count <= kNamed)
      names.push_back(name);
  if (count > 0)
    complain(fmt::format("warning: one file in both folders, and so compared with themselves: {}{}",
                         fmt::join(names, ", "), count > kNamed ? fmt::format(" and {} more", count - kNamed) : ""));
}

/// Finds the pairs. The exit code when there is nothing to do, which has been said, else kDone.
int begin(FolderDiff& diff) {
  const DiffFlags& flags = diff.flags;
  const std::string update = flags.update ? update_problem(flags.yes) : "";
  if (!update.empty()) return complain(update), kUsage;
  if (!flags.heatmap.empty()) return complain("--heatmap is of two pictures; of folders --html has them all"), kUsage;
  Result<FolderPairs> pairs = pair_folders(flags.a, flags.b);
  if (!pairs.ok()) return complain(pairs.error), kFileError;
  diff.pairs = std::move(pairs.value);
  if (diff.pairs.both.empty() && diff.pairs.missing.empty())
    return complain(fmt::format("there is no picture in \"{}\" to compare with", flags.b)), kFileError;
  if (const std::string problem = outputs_conflict(flags, pictures_of(diff)); !problem.empty())
    return complain(problem), kUsage;
  if (const std::string problem = outputs_problem(flags); !problem.empty()) return complain(problem), kFileError;
  check_rules(diff);
  check_identity(diff);
  return kDone;
}

void print_table(const FolderDiff& diff) {
  std::FILE* out = answer_stream(diff.flags);
  const int columns = ::isatty(::fileno(out)) == 1 ? columns_of(::fileno(out), 0) : 0;
  fmt::print(out, "{}", diff_table(diff.rows, diff.flags.verbose, takes_colour(out), static_cast<size_t>(columns)));
  std::fflush(out);
}

}  // namespace

int diff_folders(const DiffFlags& flags, const Policy& policy) {
  FolderDiff diff{flags, policy, {}, {}, ReportPage(), {}};
  if (const int code = begin(diff); code != kDone) return code;
  compare_all(diff);
  add_others(diff);
  if (!flags.json) print_table(diff);
  const std::string title = fmt::format("{} against {}", flags.a, flags.b);
  bool written = write_output(flags.html, [&] { return diff.page.html(title); });
  written &= write_output(flags.junit, [&] { return junit_of(flags, diff.rows); });
  // Afterwards, so that the page can be looked at before the question is answered.
  if (flags.update)
    diff.replaced = update_references(candidates(diff), flags.yes, flags.json ? stderr : answer_stream(flags));
  if (flags.json) fmt::print("{}\n", to_text(json_of(diff)));
  return written ? exit_code_of(diff) : kFileError;
}

}  // namespace whit
