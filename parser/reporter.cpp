#include "parser/reporter.h"

namespace whit {

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
  const auto [said, first] = foreign_.try_emplace(
      version, Diagnostic{severity, ErrorClass::Scene, where, "this is a " + version + " file: " + what,
                          remedy.empty() ? reads : remedy + "; " + reads});
  if (severity == Severity::Error) said->second.severity = severity;
}

void Reporter::finish() {
  for (const auto& [version, diagnostic] : foreign_) out_.add(diagnostic);
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
