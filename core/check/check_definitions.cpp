// What is defined and not used, or defined twice.

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/check/findings.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

std::string quoted(const std::string& name) { return '"' + name + '"'; }

/// Which statements refer to which: not whether the picture needs them, so that of a chain of things that nothing needs
/// only the first is found.
class References {
 public:
  explicit References(const SceneDescription& d)
      : textures_(d.textures.size()), materials_(d.materials.size()), description_(d) {
    for (const Entity* e : {&d.camera, &d.film, &d.filter, &d.sampler, &d.integrator, &d.accelerator}) add("", *e);
    for (const TextureDescription& t : d.textures) add(t.spectrum ? "spectrum texture" : "float texture", t);
    for (const MaterialDescription& m : d.materials) {
      add("material", m);
      for (const auto& [name, index] : m.named) materials_[static_cast<size_t>(index)] = true;
    }
    for (const LightDescription& l : d.lights) add("light", l);
    for (const Entity& a : d.area_lights) add("area light", a);
    for (const ShapeDescription& s : d.shapes) {
      if (!s.params.empty()) add_shape(s);
      materials_[static_cast<size_t>(s.material)] = true;
    }
  }

  bool texture(size_t i) const { return textures_[i]; }
  bool material(size_t i) const { return materials_[i]; }

 private:
  void add(const char* category, const Entity& entity) {
    const PluginInfo* info = nullptr;
    for (const Parameter& p : entity.params) {
      if (p.type != ParamType::Texture) continue;
      if (!info && *category) info = find_plugin(category, entity.plugin);
      add(p, info);
    }
  }
  void add_shape(const ShapeDescription& shape) {
    for (const Parameter& p : shape.params) {
      if (p.type != ParamType::Texture) continue;
      const PluginInfo* info = find_plugin("shape", shape.plugin);
      if (!info || !info->find_param(p.name))
        info = find_plugin("material", description_.materials[static_cast<size_t>(shape.material)].plugin);
      add(p, info);
    }
  }
  /// Of a float and a colour texture of one name the parameter wants the one or the other.
  void add(const Parameter& p, const PluginInfo* info) {
    const ParamSpec* spec = info ? info->find_param(p.name) : nullptr;
    const auto accepts = [&](ParamType type) {
      return std::find(spec->accepts.begin(), spec->accepts.end(), type) != spec->accepts.end();
    };
    for (const TextureRef& ref : p.textures()) {
      const bool both = ref.float_texture >= 0 && ref.spectrum_texture >= 0;
      if (ref.float_texture >= 0 && (!both || !spec || accepts(ParamType::Float)))
        textures_[static_cast<size_t>(ref.float_texture)] = true;
      if (ref.spectrum_texture >= 0 && (!both || !spec || accepts(ParamType::Rgb)))
        textures_[static_cast<size_t>(ref.spectrum_texture)] = true;
    }
  }

  std::vector<bool> textures_, materials_;
  const SceneDescription& description_;
};

/// For each of a list of definitions the next one that takes its name over, -1 where there is none. `key` gives what must
/// be equal.
template <class All, class Key>
std::vector<int> successors(const All& all, const Key& key) {
  std::vector<int> next(all.size(), -1);
  std::map<decltype(key(all.front())), int> last;
  for (size_t i = 0; i < all.size(); ++i) {
    const auto [slot, fresh] = last.try_emplace(key(all[i]), static_cast<int>(i));
    if (fresh) continue;
    next[static_cast<size_t>(slot->second)] = static_cast<int>(i);
    slot->second = static_cast<int>(i);
  }
  return next;
}

void check_textures_used(const SceneDescription& d, const References& used, Findings& found) {
  const std::vector<int> next =
      successors(d.textures, [](const TextureDescription& t) { return std::tuple(t.name, t.spectrum, t.block); });
  for (size_t i = 0; i < d.textures.size(); ++i) {
    const TextureDescription& t = d.textures[i];
    if (used.texture(i)) continue;
    if (next[i] < 0) {
      found.add("unused-texture", t.where, "texture " + quoted(t.name) + " is not used");
    } else {
      found.add("redefined-texture", t.where, "texture " + quoted(t.name) + " is defined again before anything used it",
                "the later one is used from there on", d.textures[static_cast<size_t>(next[i])].where);
    }
  }
}

void check_objects_used(const SceneDescription& d, Findings& found) {
  std::vector<bool> placed(d.objects.size());
  for (const InstanceDescription& i : d.instances) placed[static_cast<size_t>(i.object)] = true;
  const std::vector<int> next = successors(d.objects, [](const ObjectDescription& o) { return o.name; });
  for (size_t i = 0; i < d.objects.size(); ++i) {
    const ObjectDescription& object = d.objects[i];
    if (next[i] >= 0) {
      found.add("redefined-object", d.objects[static_cast<size_t>(next[i])].where,
                "object " + quoted(object.name) + " is defined again",
                placed[i] ? "what was placed before is the first one, what is placed from here on the second"
                          : "the first one was never placed",
                object.where);
    } else if (!placed[i]) {
      found.add("unused-object", object.where, "object " + quoted(object.name) + " is never placed");
    }
  }
}

void check_media_used(const SceneDescription& d, Findings& found) {
  std::vector<bool> used(d.media.size());
  for (const MediumUse& use : d.media_uses)
    if (use.medium >= 0) used[static_cast<size_t>(use.medium)] = true;
  for (size_t i = 0; i < d.media.size(); ++i) {
    if (!used[i]) found.add("unused-medium", d.media[i].where, "medium " + quoted(d.media[i].name) + " is not used");
  }
}

void check_systems_used(const SceneDescription& d, Findings& found) {
  const auto& all = d.coordinate_systems;
  const std::vector<int> next = successors(all, [](const CoordinateSystemDescription& c) { return c.name; });
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].used) continue;
    if (next[i] < 0) {
      found.add("unused-coordinate-system", all[i].where, "coordinate system " + quoted(all[i].name) + " is not used");
    } else {
      found.add("redefined-coordinate-system", all[i].where,
                "coordinate system " + quoted(all[i].name) + " is set again before anything went back to it", "",
                all[static_cast<size_t>(next[i])].where);
    }
  }
}

}  // namespace

void check_definitions(const CheckedWorld& world, Findings& found) {
  const SceneDescription& d = world.description;
  const References used(d);
  check_textures_used(d, used, found);
  for (size_t i = 1; i < d.materials.size(); ++i) {
    const MaterialDescription& m = d.materials[i];
    if (!m.name.empty() && !used.material(i))
      found.add("unused-material", m.where, "named material " + quoted(m.name) + " is not used");
  }
  check_objects_used(d, found);
  check_media_used(d, found);
  check_systems_used(d, found);
}

}  // namespace whit
