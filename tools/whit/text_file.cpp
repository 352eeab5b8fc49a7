#include "tools/whit/text_file.h"

#include <fmt/format.h>

#include <cstdio>

#include "core/image/atomic_file.h"

namespace whit {
namespace {

std::string write_error(const std::string& path, const std::string& reason) {
  return reason.empty() ? "" : fmt::format("cannot write \"{}\": {}", path, reason);
}

}  // namespace

bool is_stdout(const std::string& path) { return path == "-"; }

std::string text_file_problem(const std::string& path) {
  return path.empty() || is_stdout(path) ? "" : write_error(path, AtomicFile(path).failure());
}

std::string write_text(const std::string& path, const std::string& text) {
  if (is_stdout(path)) {
    fmt::print("{}", text);
    return std::fflush(stdout) == 0 ? "" : "cannot write to standard output";
  }
  AtomicFile file(path);
  file.write_at(text.data(), text.size(), 0);
  return write_error(path, file.commit());
}

}  // namespace whit
