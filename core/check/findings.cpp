#include "core/check/findings.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace whit {

const std::vector<FindingKind>& finding_kinds() {
  static const std::vector<FindingKind> table = {
      {"unused-texture", "A texture that nothing refers to."},
      {"unused-material", "A named material that no shape and no other material refers to."},
      {"unused-object", "An object that is never placed."},
      {"unused-medium", "A medium that no MediumInterface names."},
      {"unused-coordinate-system", "A coordinate system that nothing goes back to."},
      {"redefined-texture", "A texture that another of its name takes the place of before anything used it."},
      {"redefined-material", "A named material whose name is given to another one.", Severity::Warning, true, true},
      {"redefined-object", "An object whose name is given to another one."},
      {"redefined-coordinate-system", "A coordinate system that is set again before anything went back to it."},
      {"ineffective-parameter", "A parameter that says nothing beside the others of its statement."},
      {"black-light", "A light or emission that is black, and so gives no light."},
      {"useless-light", "A light whose light nothing in the scene scatters, or an emission that no shape has."},
      {"unreached-light", "A light that shines where nothing is."},
      {"covered-emitter", "A surface that emits on one side, which something lies close in front of."},
      {"camera-inside", "A camera inside of a closed shape: all it sees are back sides."},
      {"empty-view", "A camera that sees nothing at all."},
      {"outside-view", "A shape outside of the view: it matters to mirrors and shadows alone.", Severity::Note, false},
      {"fine-texture", "A picture with far more texels than the view shows of it.", Severity::Note},
      {"coarse-texture", "A picture of whose texels each covers many pixels of the view.", Severity::Note},
      {"normals-against-winding", "A mesh whose normals point to the other side than the order of its corners says."},
      {"singular-instance", "An object that is placed flat: its transform cannot be inverted."},
      {"mirrored-instance", "An object that is placed mirrored, which turns its writing and its handedness around.",
       Severity::Note},
      {"not-simulated", "Something that the scene asks for and that is not simulated, as participating media.",
       Severity::Warning, true, true},
  };
  return table;
}

const FindingKind* find_finding_kind(std::string_view name) {
  const auto& all = finding_kinds();
  const auto found = std::find_if(all.begin(), all.end(), [&](const FindingKind& k) { return name == k.name; });
  return found == all.end() ? nullptr : &*found;
}

bool Findings::wants(std::string_view name) const {
  const FindingKind* kind = find_finding_kind(name);
  return (kind && kind->by_default) || std::find(asked_for_.begin(), asked_for_.end(), name) != asked_for_.end();
}

void Findings::add(const char* name, SourcePos where, std::string message, std::string remedy, SourcePos other) {
  const FindingKind* kind = find_finding_kind(name);
  if (!kind) throw std::logic_error(std::string("no kind of finding is called ") + name);
  Diagnostic d{kind->severity, ErrorClass::Scene, where, std::move(message), std::move(remedy), other};
  d.name = name;
  out_.add(std::move(d));
}

}  // namespace whit
