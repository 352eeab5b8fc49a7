#include "core/check/names.h"

#include <algorithm>

#include "core/check/findings.h"

namespace whit {

const char* severity_name(Severity severity) {
  switch (severity) {
    case Severity::Error: return "error";
    case Severity::Warning: return "warning";
    case Severity::Note: break;
  }
  return "note";
}

const char* general_name(const Diagnostic& d) {
  if (d.severity != Severity::Error) return "warning";
  return d.error_class == ErrorClass::File ? "file" : "mistake";
}

const std::vector<NamedWarning>& named_warnings() {
  static const std::vector<NamedWarning> table = {
      {"unknown-parameter", "A parameter that a plugin does not have; it is ignored."},
      {"wrong-type", "A parameter of another type than the plugin's; it is ignored, as in pbrt-v3."},
      {"other-version", "A file of another version of pbrt, of which not all is understood."},
      {"no-lights", "A scene without any light, whose picture is black."},
      {"warning", "Any other warning of a render."},
  };
  return table;
}

std::vector<std::string> names_that_can_be_allowed() {
  std::vector<std::string> names;
  for (const FindingKind& kind : finding_kinds()) names.emplace_back(kind.name);
  for (const NamedWarning& warning : named_warnings()) names.emplace_back(warning.name);
  return names;
}

std::string problem_of_allowing(const std::string& name) {
  if (name == "mistake" || name == "file") return "mistakes cannot be allowed";
  const std::vector<std::string> names = names_that_can_be_allowed();
  if (std::find(names.begin(), names.end(), name) != names.end()) return {};
  return "no finding is called \"" + name + '"';
}

}  // namespace whit
