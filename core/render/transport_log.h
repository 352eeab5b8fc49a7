// What happens to the rays of one sample, in words: for finding out where a pixel comes from.
#pragma once

#include <functional>
#include <string>

#include "core/render/tracer.h"
#include "core/render/wrapper.h"

namespace whit {

/// Describes light transport to a text, a line for each thing that happens; points, distances and directions in world
/// space.
class TransportLog final : public TransportWrapper {
 public:
  /// "scene.pbrt:12:3" for a statement.
  using Place = std::function<std::string(SourcePos)>;

  /// Appends to `text`. Lights that reach nothing are told of, too.
  TransportLog(Tracer& tracer, Place place, std::string& text)
      : TransportWrapper(tracer), scene_(tracer.scene()), place_(std::move(place)), text_(text) {
    tracer.skip_dark = false;
  }

  Hits intersect(Rays& rays) override;
  Seen escaped(const Rays& rays, const Hits& hits, Heuristic h) override;
  Seen emitted(const Points& points, Heuristic h) override;
  void shade(Points& points) override;
  RGBLanes visible(const Points& points, const DirectSamples& samples, const RGBLanes& light) override;
  void send(const Points& points, const Onward& onward, const Onward& also) override;

 private:
  void line(std::string text) { text_ += std::move(text) + '\n'; }
  Vec3d to_world(const Vec3f& p) const;
  std::string hit(const Hits& hits, int ray) const;
  void surface(const Points& points, int point);
  void lobes(const Points& points, int point);
  void sent(const Points& points, const Onward& onward, int point);

  const Scene& scene_;
  Place place_;
  std::string& text_;
};

}  // namespace whit
