// The lights of a scene: those that statements make, and one for each emitting primitive of a shape.
#pragma once

#include <optional>
#include <span>

#include "core/scene/build_context.h"
#include "core/scene/emitter.h"

namespace whit {

/// A shape that emits. What is in an object can be seen, but not sampled.
struct LitShape {
  int index;  ///< Into Scene::shapes.
  bool in_world;
  bool sampled;  ///< As AreaLight::lights().
  Emission emission;
};

/// What a shape radiates, if anything; says what of it cannot be done.
std::optional<Emission> emission_of(const BuildContext& context, const ShapeDescription& description, bool is_curve,
                                    bool is_moving);

/// Prepares the live lights and lists them, and the emitters of `lit`, in `scene`.
void build_lights(const BuildContext& context, std::span<const LitShape> lit, Scene& scene);

/// Says what the shadow rays of each light end on, by asking what was built. Returns whether anything touches a light.
bool find_light_ends(const BuildContext& context, std::vector<SceneLight>& lights);

}  // namespace whit
