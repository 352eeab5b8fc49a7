#include "core/check/check.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "core/check/allowances.h"
#include "core/check/findings.h"
#include "core/check/names.h"
#include "core/session/models.h"
#include "core/session/output.h"

namespace whit {
namespace {

/// What only building a scene finds: files that cannot be read, geometry that is not what it should be; and, where
/// nothing is wrong, what rays tell.
Diagnostics check_built(PlannedWorld planned, const std::string& path, bool sound, Findings& sink) {
  Diagnostics found;
  if (planned.bound.film.plugin) {
    OutputRequest request;
    request.scene_path = path;
    found.append(plan_output(request, planned.bound.film).said);
  }
  BuildOptions options;
  options.keep_going = true;
  options.only_check = !sound;
  const BuiltWorld built = build_world(std::move(planned), options);
  found.append(built.said);
  built.textures->read_all();
  found.append(built.textures->errors());
  if (!sound || found.has_errors() || !built.scene) return found;
  check_view(*built.scene, sink);
  check_emitters(*built.scene, sink);
  check_normals(*built.scene, sink);
  check_textures(*built.scene, sink);
  return found;
}

/// Whether a diagnostic is wanted, but for what the file allows.
bool is_wanted(const Diagnostic& d, const CheckOptions& options) {
  const auto names = [&d](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), d.name) != list.end();
  };
  if (d.severity == Severity::Error) return true;
  if (names(options.allowed)) return false;
  const FindingKind* kind = find_finding_kind(d.name);
  return !kind || kind->by_default || names(options.asked_for);
}

/// Findings at places of which something worse has been said are left out: that explains them. So are those in text that
/// stands for a model, which nobody has written.
void add_unexplained(const Diagnostics& findings, const Sources& sources, Diagnostics& all) {
  using Place = std::pair<uint32_t, uint64_t>;
  std::vector<Place> said;
  for (const Diagnostic& d : all.all()) said.emplace_back(d.where.file, d.where.offset);
  std::sort(said.begin(), said.end());
  for (const Diagnostic& d : findings.all()) {
    const bool explained = std::binary_search(said.begin(), said.end(), Place(d.where.file, d.where.offset));
    if ((!explained || !d.where.known()) && !is_model_text(sources.name(d.where.file))) all.add(d);
  }
}

}  // namespace

Diagnostics check_file(const ParsedFile& file, const std::string& path, const CheckOptions& options) {
  Diagnostics findings;
  Findings sink(findings, options.asked_for);
  // Where parsing failed, statements are missing: what looks unused may be used there.
  const bool parsed = !file.said.has_errors();
  Diagnostics all = all_problems(file, [&](PlannedWorld planned) {
    const CheckedWorld world{*file.sources, *planned.bound.description, planned.bound, planned.plan};
    const bool sound = parsed && !planned.said.has_errors();
    check_parameters(world, sink);
    if (parsed) check_definitions(world, sink);
    if (sound) check_lights(world, sink), check_instances(world, sink);
    const bool build = options.build && !(options.give_up && options.give_up());
    return build ? check_built(std::move(planned), path, sound, sink) : Diagnostics();
  });
  add_unexplained(findings, *file.sources, all);

  const Allowances allowances(*file.sources);
  all.append(allowances.said());
  std::vector<Diagnostic> ordered = all.all();
  std::stable_sort(ordered.begin(), ordered.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.where.file, a.where.offset) < std::tie(b.where.file, b.where.offset);
  });
  // Names of another version are no slips in it.
  const bool foreign =
      std::any_of(ordered.begin(), ordered.end(), [](const Diagnostic& d) { return d.name == "other-version"; });
  Diagnostics out;
  for (Diagnostic& d : ordered) {
    if (foreign) d.slip = {};
    if (d.excused) d.severity = Severity::Error;
    if (d.name.empty()) d.name = general_name(d);
    if (is_wanted(d, options) && (d.severity == Severity::Error || !allowances.allows(d.name, d.where)))
      out.add(std::move(d));
  }
  return out;
}

}  // namespace whit
