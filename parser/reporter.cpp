#include "parser/reporter.h"

#include <algorithm>

namespace whit {
namespace {

/// Differences of another version that are listed.
constexpr size_t kMostForeign = 12;

}  // namespace

bool Reporter::admit(SourcePos where, Severity severity) {
  ++problems_;
  if (severity == Severity::Error) ++errors_;
  if (!where.known()) return true;
  if (files_.size() <= where.file) files_.resize(where.file + 1);
  Tally& tally = files_[where.file];
  const bool error = severity == Severity::Error;
  uint64_t& count = error ? tally.errors : tally.warnings;
  if (++count == kMost + 1) (error ? tally.first_dropped_error : tally.first_dropped_warning) = where;
  return count <= kMost;
}

void Reporter::foreign(SourcePos where, const std::string& version, Severity severity, const std::string& what,
                       const std::string& remedy) {
  ++problems_;
  if (severity == Severity::Error) ++errors_;
  const std::string reads = "whit reads pbrt-v3, and passes over what " + version + " alone has";
  const auto [slot, first] = foreign_.try_emplace(
      version, Foreign{Diagnostic{severity, ErrorClass::Scene, where, "this is a " + version + " file: " + what,
                                  remedy.empty() ? reads : remedy + "; " + reads},
                       {}});
  Foreign& known = slot->second;
  if (severity == Severity::Error) known.said.severity = severity;
  const std::string line = remedy.empty() ? what : what + ": " + remedy;
  if (!first && std::find(known.also.begin(), known.also.end(), line) == known.also.end() &&
      known.said.message.find(what) == std::string::npos && known.also.size() <= kMostForeign)
    known.also.push_back(line);
}

void Reporter::finish() {
  for (auto& [version, known] : foreign_) {
    for (size_t i = 0; i < known.also.size(); ++i)
      known.said.remedy += i == kMostForeign ? "\nand more" : "\n" + known.also[i];
    known.said.name = "other-version";
    out_.add(known.said);
  }
  foreign_.clear();
  for (const Tally& tally : files_) {
    if (tally.warnings > kMost)
      out_.warning(tally.first_dropped_warning,
                   "and " + std::to_string(tally.warnings - kMost) + " more warnings in this file, from here on");
    if (tally.errors > kMost)
      out_.error(tally.first_dropped_error,
                 "and " + std::to_string(tally.errors - kMost) + " more errors in this file, from here on");
  }
  files_.clear();
}

}  // namespace whit
