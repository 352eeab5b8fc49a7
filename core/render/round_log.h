// What happens to the rays of one sample, in words: for finding out where a pixel comes from.
#pragma once

#include <functional>
#include <string>

#include "core/plugin/light.h"
#include "core/render/round.h"

namespace whit {

/// Describes rounds to a text, a line for each thing that happens; points, distances and directions in world space.
class RoundLog {
 public:
  /// "scene.pbrt:12:3" for a statement.
  using Place = std::function<std::string(SourcePos)>;

  RoundLog(const Scene& scene, Place place) : scene_(scene), place_(std::move(place)) {}

  const std::string& text() const { return text_; }

  void rays(const Round& r);
  void surfaces(const Round& r);
  void escaped(const Round& r, int ray, const RGB& radiance);
  void emitted(const Round& r, int point, const RGB& radiance);
  void light(const Round& r, const SceneLight& light, const LightSamples& samples, const RGBLanes& contribution);
  void shadow(const Round& r, int point, bool blocked);
  void spawned(const Round& r, int point, bool reflected, const Vec3f& wi, const RGB& weight);

 private:
  void line(std::string text) { text_ += std::move(text) + '\n'; }
  Vec3d to_world(const Vec3f& p) const;
  std::string hit(const Round& r, int ray) const;
  void lobes(const Round& r, int point);
  std::string point_name(const Round& r, int point) const;

  const Scene& scene_;
  Place place_;
  std::string text_;
};

}  // namespace whit
