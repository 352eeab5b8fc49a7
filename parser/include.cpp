#include "parser/include.h"

#include <filesystem>
#include <system_error>

#include "core/base/path_hint.h"
#include "parser/parameters.h"

namespace whit {

bool check_is_scene(const Sources& sources, uint32_t file, Reporter& reporter) {
  const std::string_view text = sources.text(file);
  if (text.empty()) {
    reporter.error({file, 0}, "the file is empty: there is nothing to render");
    return false;
  }
  const std::string binary = why_not_text(text);
  if (!binary.empty()) reporter.error({file, 0}, "not a scene file: " + binary);
  return binary.empty();
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
  std::error_code failed;
  const bool is_folder = std::filesystem::is_directory(full, failed);
  if (is_folder) failed = std::make_error_code(std::errc::is_a_directory);
  if (failed) report_unopened(reporter, where, full, failed.message());
  return !failed;
}

std::optional<uint32_t> open_include(Sources& sources, Reporter& reporter, const std::string& folder,
                                     const std::string& path, SourcePos where,
                                     const std::function<bool(uint32_t)>& is_open) {
  const std::string full = join_path(folder, path);
  std::string problem;
  const std::optional<uint32_t> file = sources.open(full, problem);
  if (!file) {
    report_unopened(reporter, where, full, problem);
    return std::nullopt;
  }
  if (is_open(*file)) {
    reporter.error(where, "the file " + quoted_path(full) + " includes itself",
                   where.file == *file ? "" : "it is being read already, as the file that led here");
    return std::nullopt;
  }
  const std::string binary = why_not_text(sources.text(*file));
  if (binary.empty()) return file;
  reporter.error(where, quoted_path(full) + " is not a scene file: " + binary);
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
