// What stands instead of a scene's statements, whatever they say: another integrator, sampler or filter, another depth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/session/session.h"

namespace whit {

/// Each is of the flag beside it, by whose name messages call it. What is not given stays as the scene has it.
struct Overrides {
  std::string integrator;              ///< --integrator NAME
  std::string sampler;                 ///< --sampler NAME
  std::optional<int> max_depth;        ///< --maxdepth N, of the integrator in force.
  std::optional<double> rr_threshold;  ///< --rrthreshold X, of the integrator in force.
  std::string lights;                  ///< --lights all|tree, of the integrator in force.
  std::string texture_filter;          ///< --texture-filter ewa|trilinear|point, of all image textures.
};

/// What is wrong with them whatever the scene: names that nobody has; "" when nothing is.
std::string usage_problem(const Overrides& overrides);

/// Edits the statements of a world that is not planned yet: of the description the sampler, the integrator and the
/// textures alone. Another integrator takes those of the statement's parameters that it knows. Another sampler likewise,
/// and takes as many samples as the scene's own, as far as it can. The overrides must have no usage_problem(). Returns ""
/// or what this world has no place for, which is wrong usage too.
std::string override_world(SceneDescription& world, const Overrides& overrides);

/// The same for all worlds of a file, up to the first problem.
std::string override_worlds(ParsedFile& file, const Overrides& overrides);

/// Gives a world whose sampler has sets of a number of samples one that goes on, sobol, which has the same limit; but where
/// samples lie at places that were asked for. Returns the sampler that it had, "" where it stays.
std::string use_extending_sampler(SceneDescription& world);

/// A world under overrides until this ends, for variants of one file. What is planned and built meanwhile keeps them:
///   BuiltWorld built = [&] {
///     const ScopedOverrides scope(world, overrides);
///     return build_world(plan_world(world, sources));
///   }();
class ScopedOverrides {
 public:
  ScopedOverrides(SceneDescription& world, const Overrides& overrides);
  ~ScopedOverrides();
  ScopedOverrides(const ScopedOverrides&) = delete;
  ScopedOverrides& operator=(const ScopedOverrides&) = delete;

  /// "" or what the world has no place for, as override_world() says.
  const std::string& problem() const { return problem_; }

 private:
  SceneDescription& world_;
  Entity sampler_, integrator_;
  std::vector<TextureDescription> textures_;
  std::string problem_;
};

}  // namespace whit
