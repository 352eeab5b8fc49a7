// What the libraries say about a scene: problems with their place and remedy, collected and never printed here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace whit {

/// A place in a source file: which file, and the byte in it. Line and column are derived when a message
/// is shown (parser/source.h), so that keeping the place of every value costs eight bytes.
struct SourcePos {
  static constexpr uint32_t kNoFile = 0xffffffffu;
  uint32_t file = kNoFile;
  uint64_t offset = 0;
  bool known() const { return file != kNoFile; }
};

/// A note is information that may well be meant; only `whit check` has such.
enum class Severity : uint8_t { Warning, Error, Note };

/// Which exit code an error leads to: the scene is wrong (3), a file could not be read or written (4), or what was asked
/// for, apart from the scene, cannot be had (2).
enum class ErrorClass : uint8_t { Scene, File, Usage };

/// A slip of the pen: in the word or string at a diagnostic's place, `written` stands where `meant` should.
struct Slip {
  std::string written, meant;  ///< Both "" where no correction is beyond doubt.
  bool known() const { return !meant.empty(); }
};

/// What to do about a mistake: for people, and where that can be done without asking them, for programs.
struct Remedy {
  std::string text;
  Slip slip{};
  Remedy() = default;
  Remedy(std::string t) : text(std::move(t)) {}
  Remedy(const char* t) : text(t) {}
  Remedy(std::string t, Slip s) : text(std::move(t)), slip(std::move(s)) {}
};

struct Diagnostic {
  Severity severity = Severity::Error;
  ErrorClass error_class = ErrorClass::Scene;
  SourcePos where;
  std::string message;   ///< What is wrong, naming the thing: "sphere has no parameter \"raduis\"".
  std::string remedy{};  ///< What to do, or what was done instead: "did you mean \"radius\"?"; may be empty.
  SourcePos other{};     ///< A second place that it is about, where there is one.
  /// A mistake that pbrt-v3 renders past, and so do we with this warning; `whit check` calls it an error.
  bool excused = false;
  Slip slip{};  ///< What `whit check --fix` and editors can correct.
  /// Of a finding that can be silenced: "unused-texture". "" for what has no name of its own; `whit check` then gives one
  /// by the kind of the diagnostic.
  std::string name{};
};

/// An ordered collection of diagnostics. Not thread-safe: one per stage, merged by append().
class Diagnostics {
 public:
  void error(SourcePos where, std::string message, Remedy remedy = {}) {
    put({Severity::Error, ErrorClass::Scene, where, std::move(message)}, std::move(remedy));
  }
  void file_error(SourcePos where, std::string message, Remedy remedy = {}) {
    put({Severity::Error, ErrorClass::File, where, std::move(message)}, std::move(remedy));
  }
  void warning(SourcePos where, std::string message, Remedy remedy = {}, const char* name = "") {
    Diagnostic d{Severity::Warning, ErrorClass::Scene, where, std::move(message)};
    d.name = name;
    put(std::move(d), std::move(remedy));
  }
  /// A warning where a picture is made, an error where a file is checked: see Diagnostic::excused.
  void excused(SourcePos where, std::string message, Remedy remedy = {}) {
    put({Severity::Warning, ErrorClass::Scene, where, std::move(message), {}, {}, true}, std::move(remedy));
  }
  void add(Diagnostic d) { all_.push_back(std::move(d)); }
  void append(const Diagnostics& other) { all_.insert(all_.end(), other.all_.begin(), other.all_.end()); }

  const std::vector<Diagnostic>& all() const { return all_; }
  bool has_errors() const;

 private:
  void put(Diagnostic d, Remedy remedy) {
    d.remedy = std::move(remedy.text);
    d.slip = std::move(remedy.slip);
    add(std::move(d));
  }

  std::vector<Diagnostic> all_;
};

/// The candidate nearest to `name` by edit distance (case ignored at half cost), or "" when none is near
/// enough to be a likely slip (more than a third of the letters differ).
std::string nearest_name(const std::string& name, const std::vector<std::string>& candidates);

/// ", did you mean \"x\"?" style remedy text for a misspelt name, or "" when nothing is near.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates);

/// The same for what stands at a place in a scene file, which can then be corrected.
Remedy suggestion(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace whit
