#include "parser/include.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/base/limits.h"
#include "core/base/path_hint.h"
#include "parser/parameters.h"

namespace whit {

namespace {

/// Why a file is no scene, or "", and where that shows. Of a file on disk nothing gets into messages that may be a line of
/// something else altogether: it must begin with a statement, or what was meant for one.
std::string why_no_scene(Sources& sources, uint32_t file, uint64_t& at, std::string& remedy) {
  const std::string_view text = sources.text(file);
  std::string why = why_not_text(text);
  if (why.empty() && sources.is_on_disk(file)) {
    Diagnostics ignored;
    Reporter reporter(ignored);
    Lexer lexer(text, file, reporter);
    const Token first = lexer.peek();
    if (first.kind != TokenKind::End && !(first.kind == TokenKind::Word && resembles_directive(first.text))) {
      why = "it does not begin with a statement";
      at = first.offset, remedy = foreign_characters(first.text);
    }
  }
  if (!why.empty()) sources.hide(file);
  return why;
}

}  // namespace

std::optional<uint32_t> open_main(Sources& sources, const std::string& path, Diagnostics& diagnostics) {
  // A pipe with a name may have nobody at its other end, and would be waited for.
  const bool own = path.starts_with("/dev/") || path.starts_with("/proc/self/fd/");
  std::string problem;
  const std::optional<uint32_t> file = sources.open(path, problem, own ? Pipes::Read : Pipes::Refuse);
  if (!file) {
    const bool special = problem == kNotRegular;
    diagnostics.file_error({}, "cannot open " + quoted_path(path) + ": " + problem,
                           special ? "a scene can be read from standard input: name it -" : "");
  }
  return file;
}

bool check_is_scene(Sources& sources, uint32_t file, Reporter& reporter) {
  if (sources.text(file).empty()) {
    reporter.error({file, 0}, "the file is empty: there is nothing to render");
    return false;
  }
  uint64_t at = 0;
  std::string remedy;
  const std::string why = why_no_scene(sources, file, at, remedy);
  if (!why.empty()) reporter.error({file, at}, "not a scene file: " + why, remedy);
  return why.empty();
}

bool check_unchanged(const Sources& sources, Diagnostics& diagnostics) {
  const std::string problem = sources.problem();
  if (problem.empty()) return true;
  diagnostics = {};
  diagnostics.file_error({}, problem, "start again when it is complete");
  return false;
}

std::string join_path(const std::string& folder, const std::string& path) {
  return (std::filesystem::path(folder) / std::filesystem::path(path)).string();
}

namespace {

void report_unopened(Reporter& reporter, SourcePos where, const std::string& full, const std::string& problem) {
  reporter.file_error(where, "cannot open " + quoted_path(full) + ": " + problem, path_hint(full));
}

}  // namespace

bool check_include_exists(Reporter& reporter, const std::string& folder, const std::string& path, SourcePos where) {
  const std::string full = join_path(folder, path);
  const std::string problem = why_unreadable(full);
  if (!problem.empty()) report_unopened(reporter, where, full, problem);
  return problem.empty();
}

bool Inclusion::exhausted() const { return opened_ > kIncludes.most; }

bool Inclusion::check_limits(SourcePos where) {
  if (++opened_ > kIncludes.most) {
    reporter_.error(
        where, "files are included more than " + std::to_string(kIncludes.most) + " times, the limit " + kIncludes.name,
        "does every file include the next one more than once?");
    return false;
  }
  if (reading_.size() < kIncludeDepth.most) return true;
  reporter_.error(where, "files include one another more than " + std::to_string(kIncludeDepth.most) +
                             " deep, the limit " + kIncludeDepth.name);
  return false;
}

std::optional<uint32_t> Inclusion::open(const std::string& path, SourcePos where) {
  if (!check_limits(where)) return std::nullopt;
  const std::string full = join_path(folder_, path);
  std::string problem, remedy;
  const std::optional<uint32_t> file = sources_.open(full, problem);
  if (!file) {
    report_unopened(reporter_, where, full, problem);
    return std::nullopt;
  }
  if (std::find(reading_.begin(), reading_.end(), *file) != reading_.end()) {
    reporter_.error(where, "the file " + quoted_path(full) + " includes itself",
                    where.file == *file ? "" : "it is being read already, as the file that led here");
    return std::nullopt;
  }
  if (good_.contains(*file)) return file;
  uint64_t ignored = 0;
  const std::string why = why_no_scene(sources_, *file, ignored, remedy);
  if (why.empty()) return *good_.insert(*file).first;
  reporter_.error(where, quoted_path(full) + " is not a scene file: " + why, remedy);
  return std::nullopt;
}

void append_trailing(Lexer& lexer, ReadResult result, ParameterList& trailing, Statement& statement) {
  if (trailing.empty() || lexer.peek().kind != TokenKind::End) return;
  if (result == ReadResult::Good && statement.row->arguments.parameters) {
    append_parameters(statement.parameters, std::move(trailing), lexer.reporter());
  } else if (result != ReadResult::Broken) {  // A broken statement has been reported.
    lexer.reporter().error(trailing.front().where, "no statement to take the parameters behind Include",
                           "they belong to the last statement of the included file");
  }
  trailing.clear();
}

}  // namespace whit
