// Parameters that say nothing: each plugin knows its own (Plugin::ineffective()).

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "core/check/findings.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class Checker {
 public:
  explicit Checker(Findings& found) : found_(found) {}

  template <class T>
  void check(const Entity& entity, const Bound<T>& bound) {
    if (!bound.plugin || bound.replaced || entity.params.empty()) return;
    const auto given = [&](const char* name) {
      const auto at = std::find_if(entity.params.begin(), entity.params.end(),
                                   [&](const Parameter& p) { return p.name == name && !p.is_empty(); });
      return at == entity.params.end() ? nullptr : &*at;
    };
    for (const Ineffective& one : static_cast<const Plugin&>(*bound.plugin).ineffective()) {
      const Parameter* const p = given(one.parameter);
      if (!p || (one.unless && given(one.unless))) continue;
      found_.add("ineffective-parameter", p->where, '"' + p->name + "\" of " + entity.plugin + " has no effect",
                 one.why);
    }
  }

  template <class T, class Statements>
  void check_all(const Statements& statements, const std::vector<Bound<T>>& bound) {
    for (size_t i = 0; i < statements.size() && i < bound.size(); ++i) check(statements[i], bound[i]);
  }

 private:
  Findings& found_;
};

}  // namespace

void check_parameters(const CheckedWorld& world, Findings& found) {
  const SceneDescription& d = world.description;
  const BoundScene& bound = world.bound;
  Checker checker(found);
  checker.check(d.camera, bound.camera);
  checker.check(d.film, bound.film);
  checker.check(d.filter, bound.filter);
  checker.check(d.sampler, bound.sampler);
  checker.check(d.integrator, bound.integrator);
  checker.check_all(d.textures, bound.textures);
  // A material that shapes override in part is another for each of them: what has no effect there may have one here.
  std::set<int> overridden;
  for (size_t i = 0; i < d.shapes.size(); ++i)
    if (bound.shape_material[i] != d.shapes[i].material) overridden.insert(d.shapes[i].material);
  for (size_t i = 0; i < d.materials.size() && i < bound.materials.size(); ++i)
    if (overridden.count(static_cast<int>(i)) == 0) checker.check(d.materials[i], bound.materials[i]);
  checker.check_all(d.lights, bound.lights);
  checker.check_all(d.area_lights, bound.area_lights);
  checker.check_all(d.shapes, bound.shapes);
}

}  // namespace whit
