#include "python/failure.h"

#include "core/check/names.h"
#include "core/plugin/memory_limit.h"

namespace whit::python {
namespace {

/// As the exit code of commands: a scene that is wrong comes first.
FailureKind kind_of(const Diagnostics& errors) {
  FailureKind kind = FailureKind::Usage;
  for (const Diagnostic& d : errors.all()) {
    if (d.severity != Severity::Error) continue;
    if (d.error_class == ErrorClass::Scene && d.name != kLimitHit) return FailureKind::Scene;
    if (d.name == kLimitHit) kind = FailureKind::Limit;
    else if (d.error_class == ErrorClass::File && kind != FailureKind::Limit) kind = FailureKind::File;
  }
  return kind;
}

}  // namespace

Said said_of(const Sources& sources, const Diagnostic& d) {
  const SourcePlace place = sources.place(d.where);
  return {severity_name(d.severity),
          d.name.empty() ? general_name(d) : d.name,
          d.message,
          d.remedy,
          d.where.known() ? sources.name(d.where.file) : "",
          place.line,
          place.column,
          sources.render_diagnostic(d, false)};
}

std::vector<Said> said_of(const Sources& sources, const Diagnostics& diagnostics) {
  std::vector<Said> all;
  for (const Diagnostic& d : diagnostics.all()) all.push_back(said_of(sources, d));
  return all;
}

Failure failure_of(const Sources& sources, const Diagnostics& errors, std::vector<Said> said) {
  std::string text;
  for (const Diagnostic& d : errors.all()) {
    if (d.severity == Severity::Error) text += d.where.known() ? sources.render_diagnostic(d, false) : d.message + "\n";
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return {kind_of(errors), text, std::move(said)};
}

}  // namespace whit::python
