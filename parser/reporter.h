// Problems found while parsing, capped per file so that a broken file cannot bury its first mistake.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/base/diagnostics.h"

namespace whit {

/// Passes diagnostics on to a Diagnostics, the first kMost errors and the first kMost warnings of each file.
class Reporter {
 public:
  static constexpr uint64_t kMost = 100;

  explicit Reporter(Diagnostics& out) : out_(out) {}

  void error(SourcePos where, std::string message, Remedy remedy = {}) {
    if (admit(where, Severity::Error)) out_.error(where, std::move(message), std::move(remedy));
  }
  void file_error(SourcePos where, std::string message, Remedy remedy = {}) {
    if (admit(where, Severity::Error)) out_.file_error(where, std::move(message), std::move(remedy));
  }
  void warning(SourcePos where, std::string message, Remedy remedy = {}, const char* name = "") {
    if (admit(where, Severity::Warning)) out_.warning(where, std::move(message), std::move(remedy), name);
  }

  /// A mistake that pbrt-v3 renders past: a warning, which `whit check` calls an error. `other` is a second place.
  void excused(SourcePos where, std::string message, Remedy remedy = {}, SourcePos other = {}) {
    if (!admit(where, Severity::Warning)) return;
    out_.add({Severity::Warning, ErrorClass::Scene, where, std::move(message), std::move(remedy.text), other, true,
              std::move(remedy.slip)});
  }

  /// What others have found.
  void pass(const Diagnostic& found) {
    if (admit(found.where, found.severity)) out_.add(found);
  }

  /// Takes down that the text is of another version of pbrt: finish() says so once, at the first place, with a list of
  /// what differs. `what` is what shows it; `remedy` what to write instead, if there is such a thing.
  void foreign(SourcePos where, const std::string& version, Severity severity, const std::string& what,
               const std::string& remedy = {});
  /// True when the text is known to be of that version.
  bool is_foreign(const std::string& version) const { return foreign_.count(version) != 0; }

  /// How many errors there were so far, those left out included.
  uint64_t errors() const { return errors_; }

  /// True when there are so many problems that one more is hardly shown and need not be explained.
  bool crowded() const { return problems_ > 2 * kMost; }

  /// Says once what other version of pbrt the text is of, and for every file how many problems were left out. Call at
  /// the end.
  void finish();

 private:
  struct Tally {
    uint64_t errors = 0, warnings = 0;
    SourcePos first_dropped_error, first_dropped_warning;
  };
  bool admit(SourcePos where, Severity severity);

  Diagnostics& out_;
  uint64_t errors_ = 0, problems_ = 0;
  std::vector<Tally> files_;
  /// What was said of one version, and what else of the text is of it, each once.
  struct Foreign {
    Diagnostic said;
    std::vector<std::string> also;
  };
  std::map<std::string, Foreign> foreign_;
};

}  // namespace whit
