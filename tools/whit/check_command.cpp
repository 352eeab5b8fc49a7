// `whit check`: every problem that a render would meet on its way to the first ray, and in the pictures it would read; and
// what the scene does that its author hardly meant.

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <set>
#include <utility>

#include "core/check/check.h"
#include "core/check/findings.h"
#include "core/check/names.h"
#include "tools/whit/check_files.h"
#include "tools/whit/check_fix.h"
#include "tools/whit/check_output.h"
#include "tools/whit/command_line.h"
#include "tools/whit/load.h"
#include "tools/whit/model_flags.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

struct CheckFlags {
  std::vector<std::string> scenes, allow, also;
  std::string format = "text";
  bool json = false, fix = false, strict = false, list = false, files = false;
  ModelFlags model;
};

int list_findings() {
  std::string out;
  const auto add = [&out](const char* name, const char* severity, const char* what) {
    out += fmt::format("{:<28} {:<18} {}\n", name, severity, what);
  };
  for (const FindingKind& k : finding_kinds())
    add(k.name, fmt::format("{}{}", severity_name(k.severity), k.by_default ? "" : ", with --also").c_str(), k.what);
  for (const NamedWarning& w : named_warnings()) add(w.name, "warning", w.what);
  std::cout << out << std::flush;
  return kDone;
}

/// For completion: what --also takes.
std::vector<std::string> optional_findings() {
  std::vector<std::string> names;
  for (const FindingKind& k : finding_kinds())
    if (!k.by_default) names.emplace_back(k.name);
  return names;
}

/// "" or what is wrong with the flags beside what the table of flags says.
std::string flag_problem(const CheckFlags& flags) {
  for (const auto& names : {flags.allow, flags.also}) {
    for (const std::string& name : names) {
      if (std::string problem = problem_of_allowing(name); !problem.empty()) {
        const std::string hint = did_you_mean(name, names_that_can_be_allowed());
        return problem + (hint.empty() ? "; `whit check --list` shows all" : "; " + hint);
      }
    }
  }
  for (const std::string& path : flags.scenes) {
    if (std::string problem = usage_problem(flags.model, path); !problem.empty()) return problem;
    if (flags.fix && path == "-") return "--fix needs a file";
    if (flags.files && (flags.fix || flags.format == "sarif")) return "--files lists names, and nothing else is done";
  }
  return {};
}

/// What people read: findings with their names, and what a render says too as it says it.
Diagnostics for_people(const Diagnostics& found) {
  Diagnostics out;
  for (Diagnostic d : found.all()) {
    const FindingKind* kind = find_finding_kind(d.name);
    if (kind && !kind->said_by_render) d.message += " [" + d.name + "]";
    out.add(std::move(d));
  }
  return out;
}

/// Whether the answer is no. Notes are for information.
bool is_bad(const Diagnostics& found) {
  return std::any_of(found.all().begin(), found.all().end(),
                     [](const Diagnostic& d) { return d.severity != Severity::Note; });
}

/// Reads the flags and looks at them. True when the command should go on, else `code` is what to exit with.
bool read_flags(const Arguments& args, CheckFlags& flags, int& code) {
  CommandLine command{
      "whit check",
      "Reports every problem of a scene without rendering, and what it does that its author hardly meant; what a "
      "render "
      "warns of and goes past as pbrt-v3 does is an error here. Exit code 1 when there is any error or warning.",
      {{"scenes", &flags.scenes, "Scene files or glTF models; standard input without any"},
       {"--json", &flags.json, "Print what was found as JSON, short for --format json"},
       {"--format",
        &flags.format,
        "How to print it: text on stderr, JSON or SARIF 2.1.0 on stdout",
        {.choices = {"text", "json", "sarif"}}},
       {"--allow",
        &flags.allow,
        "Leave findings of that name out; mistakes cannot be",
        {.repeats = true, .offers = names_that_can_be_allowed}},
       {"--also",
        &flags.also,
        "Look for what is not looked for by default",
        {.repeats = true, .offers = optional_findings}},
       {"--fix", &flags.fix, "Correct in the files what is beyond doubt: misspelt names"},
       {"--strict", &flags.strict, "Call everything an error, notes too"},
       {"--files", &flags.files, "List the files that a scene would read and write instead; with --json as JSON"},
       {"--list", &flags.list, "List what can be found, and exit"}}};
  add_model_flags(command, flags.model);
  if (!parse_arguments(command, args, code)) return false;
  if (flags.scenes.empty()) flags.scenes.push_back("-");
  if (flags.json) flags.format = "json";
  const std::string problem = flags.list ? "" : flag_problem(flags);
  if (problem.empty()) return true;
  say("whit check: " + problem);
  code = kUsage;
  return false;
}

/// One scene after another.
class Checking {
 public:
  explicit Checking(const CheckFlags& flags) : flags_(flags), read_(read_options(flags.model)) {
    read_.read_unplaced = true;
    // Files that are written must not be mapped meanwhile.
    read_.copy_files = flags.fix;
    wanted_.allowed = flags.allow, wanted_.asked_for = flags.also;
  }

  void fix(const std::string& path) {
    CheckOptions of_text = wanted_;
    of_text.build = false;
    const auto read = [&](const Fixer::Texts& texts) {
      ReadOptions with_texts = read_;
      with_texts.unsaved = texts;
      return read_scene(path, with_texts);
    };
    for (const std::string& problem :
         fixer_.fix(read, [&](const ParsedFile& f) { return check_file(f, path, of_text); }))
      unfixed_.insert(problem);
  }

  void check(const std::string& path) {
    ParsedFile file = read_scene(path, read_);
    Diagnostics found = check_file(file, path, wanted_);
    if (is_text()) found = for_people(found);
    if (flags_.strict) found = strict(found);
    bad_ = bad_ || is_bad(found);
    if (is_text()) {
      print_diagnostics(*file.sources, found);
    } else {
      all_.push_back({file.sources.get(), std::move(found)});
      sources_.push_back(std::move(file.sources));
    }
  }

  /// Prints what is for programs, and returns the exit code.
  int finish() const {
    for (const std::string& problem : unfixed_) say("whit check: " + problem);
    const int code = !unfixed_.empty() ? kFileError : bad_ ? kNo : kDone;
    if (is_text()) return code;
    std::cout << (flags_.format == "json" ? check_as_json(all_) : check_as_sarif(all_)) << '\n' << std::flush;
    if (std::cout) return code;
    say("whit check: cannot write to standard output");
    return kFileError;
  }

 private:
  bool is_text() const { return flags_.format == "text"; }

  const CheckFlags& flags_;
  ReadOptions read_;
  CheckOptions wanted_;
  Fixer fixer_;
  bool bad_ = false;
  std::set<std::string> unfixed_;
  std::vector<Checked> all_;
  std::vector<std::unique_ptr<Sources>> sources_;  ///< That these refer to.
};

}  // namespace

int check_command(const Arguments& args) {
  CheckFlags flags;
  int code = kDone;
  if (!read_flags(args, flags, code)) return code;
  if (flags.list) return list_findings();
  if (flags.files) {
    for (const std::string& path : flags.scenes)
      code = std::max(code, list_files(path, read_options(flags.model), flags.format == "json"));
    return code;
  }
  Checking checking(flags);
  for (const std::string& path : flags.scenes) {
    if (flags.fix) checking.fix(path);
    checking.check(path);
  }
  return checking.finish();
}

}  // namespace whit
