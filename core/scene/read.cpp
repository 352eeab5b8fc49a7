#include "core/scene/read.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace whit {
namespace {

/// Reads plugins that are live and have not been read, on all threads. Returns which of them could not be.
template <class T>
std::vector<uint8_t> read_all(std::vector<Bound<T>>& all, const std::vector<uint8_t>& live, std::vector<uint8_t>& done,
                              Diagnostics& diagnostics) {
  std::vector<uint8_t> failed(all.size());
  done.resize(all.size());
  std::vector<size_t> unread;
  for (size_t i = 0; i < all.size(); ++i) {
    if (live[i] && !done[i] && all[i].plugin) unread.push_back(i);
  }
  std::vector<Diagnostics> said(unread.size());
  tbb::parallel_for(size_t{0}, unread.size(), [&](size_t k) {
    const size_t i = unread[k];
    all[i].plugin = after_reading(std::move(all[i].plugin), said[k], all[i].where);
    done[i] = 1, failed[i] = !all[i].plugin;
  });
  for (const Diagnostics& d : said) diagnostics.append(d);
  return failed;
}

bool any(const std::vector<uint8_t>& flags) {
  return std::any_of(flags.begin(), flags.end(), [](uint8_t flag) { return flag != 0; });
}

}  // namespace

void drop_users(BoundScene& scene, std::vector<uint8_t> failed) {
  const auto uses_failed = [&](const std::vector<TextureUse>& uses) {
    return std::any_of(uses.begin(), uses.end(),
                       [&](const TextureUse& u) { return failed[static_cast<size_t>(u.texture)]; });
  };
  // What is made of something stands behind it.
  for (size_t i = 0; i < scene.textures.size(); ++i) {
    auto& texture = scene.textures[i];
    if (!texture.plugin || !uses_failed(texture.textures)) continue;
    texture.plugin.reset();
    failed[i] = 1;
  }
  for (auto& material : scene.materials) {
    const auto is_gone = [&](int member) { return !scene.materials[static_cast<size_t>(member)].plugin; };
    const bool lacks_member = std::any_of(material.materials.begin(), material.materials.end(), is_gone);
    if (lacks_member || uses_failed(material.textures)) material.plugin.reset();
  }
  for (auto& light : scene.area_lights) {
    if (uses_failed(light.textures)) light.plugin.reset();
  }
  for (auto& shape : scene.shapes) {
    if (uses_failed(shape.textures)) shape.plugin.reset();
  }
}

void read_live(BoundScene& scene, EffectPlan& plan, Diagnostics& diagnostics) {
  std::vector<uint8_t> textures_done, materials_done;
  for (;;) {
    const std::vector<uint8_t> textures = read_all(scene.textures, plan.texture_live, textures_done, diagnostics);
    const std::vector<uint8_t> materials = read_all(scene.materials, plan.material_live, materials_done, diagnostics);
    if (!any(textures) && !any(materials)) return;
    drop_users(scene, textures);
    plan = plan_effects(scene, {plan.off_by_hand, plan.everything_on});
  }
}

}  // namespace whit
