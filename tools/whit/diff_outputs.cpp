#include "tools/whit/diff_outputs.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <set>

#include "core/compare/junit.h"
#include "tools/whit/terminal.h"
#include "tools/whit/text_file.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// The file that a path names, whatever the links on its way; also when it is not there yet.
std::string real_path(const std::string& path) {
  std::error_code failed;
  const fs::path real = fs::weakly_canonical(fs::absolute(path, failed), failed);
  return failed ? path : real.string();
}

/// The files that are asked for, by their flags.
std::vector<std::pair<std::string, std::string>> outputs_of(const DiffFlags& flags) {
  std::vector<std::pair<std::string, std::string>> all{
      {"--html", flags.html}, {"--junit", flags.junit}, {"--heatmap", flags.heatmap}};
  std::erase_if(all, [](const auto& output) { return output.second.empty(); });
  return all;
}

/// What a test of a CI system shows of a picture that was compared.
std::string details_of(const Comparison& c) {
  std::string text;
  for (const Failure& f : c.failed) text += failure_text(f) + "\n";
  for (const Measured& m : c.measured)
    text += fmt::format("{}{} {:.6g}\n", m.layer.empty() ? "" : m.layer + " ", m.measure, m.value);
  for (const std::string& note : c.notes) text += note + "\n";
  return text;
}

}  // namespace

std::string outputs_conflict(const DiffFlags& flags, const std::vector<std::string>& pictures) {
  std::vector<std::string> read = pictures;
  if (!flags.policy.empty()) read.push_back(flags.policy);
  std::set<std::string> seen;
  for (const auto& [flag, path] : outputs_of(flags)) {
    if (flags.json && is_stdout(path))
      return fmt::format("{} -: --json goes to standard output, too; give {} a file", flag, flag);
    if (!seen.insert(is_stdout(path) ? "-" : real_path(path)).second)
      return fmt::format("{} {}: another output goes to the same place", flag, path);
    std::error_code failed;
    if (is_stdout(path) || !fs::exists(path, failed)) continue;
    for (const std::string& file : read)
      if (fs::equivalent(path, file, failed) && !failed)
        return fmt::format("{} {}: would overwrite \"{}\", which is read", flag, path, file);
  }
  return "";
}

std::FILE* answer_stream(const DiffFlags& flags) {
  return is_stdout(flags.html) || is_stdout(flags.junit) ? stderr : stdout;
}

bool takes_colour(std::FILE* out) {
  const char* no = std::getenv("NO_COLOR");
  return ::isatty(::fileno(out)) == 1 && !(no && *no);
}

std::string outputs_problem(const DiffFlags& flags) {
  for (const auto& [flag, path] : outputs_of(flags))
    if (const std::string problem = text_file_problem(path); !problem.empty())
      return fmt::format("{}: {}", flag, problem);
  return "";
}

bool write_output(const std::string& path, const std::function<std::string()>& text) {
  const std::string problem = path.empty() ? "" : write_text(path, text());
  if (!problem.empty()) say("whit diff: " + problem);
  return problem.empty();
}

std::string junit_of(const DiffFlags& flags, const std::vector<DiffRow>& rows) {
  std::vector<JUnitCase> cases;
  for (const DiffRow& row : rows) {
    JUnitCase test{row.name, row.seconds, "", "", "", details_of(row.comparison)};
    if (row.status == DiffStatus::Missing || row.status == DiffStatus::Cannot) test.error = row.reason;
    else if (row.status == DiffStatus::Differs) test.failure = row.reason;
    else test.skipped = row.reason;
    cases.push_back(std::move(test));
  }
  return junit_text(fmt::format("{} against {}", flags.a, flags.b), cases,
                    fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(std::time(nullptr))));
}

}  // namespace whit
