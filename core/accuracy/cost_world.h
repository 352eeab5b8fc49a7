// A world of the file, as it stands or with a knob turned, ready to be rendered with any seed and number of samples.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/cost_clock.h"
#include "core/image/denoiser.h"
#include "core/render/film_render.h"
#include "core/session/output.h"
#include "core/session/overrides.h"

namespace whit {

/// How a world differs from what the file says. The flags are those of `whit render` that do the same.
struct CostVariant {
  std::string knob, value;  ///< As CostSetting has them; the name of an effect in `value` where an effect is left out.
  std::string flags;        ///< "--sampler random".
  Overrides overrides{};
  EffectSet off{};
  bool robust = true;
  std::shared_ptr<const Denoiser> denoiser{};  ///< Its picture in the place of the render's.
};

/// Names a place in the scene, for AOVs that stand for statements.
StatementPlace statement_place(const Sources& sources);

struct CostWorld {
  const SceneDescription* description = nullptr;  ///< The file's, which the rest refers to.
  BuiltWorld built;
  OutputPlan output;  ///< Of the picture as the plain command writes it, into a folder that is gone.
  RenderOptions options;
  std::shared_ptr<const Denoiser> denoiser;  ///< CostVariant::denoiser.
  Diagnostics said;
  Elapsed fixed;                ///< Of a render with any number of samples: building, first looks, writing.
  Elapsed per_sample;           ///< For all pixels, by a render of one.
  int own_samples = 0;          ///< Per pixel, that the scene asks for.
  int64_t invalid_samples = 0;  ///< Of one for each pixel: those that are no numbers, and are left out.
  bool usable = false;
  bool too_slow = false;  ///< Not even one sample came to its end in time.

  const Scene& scene() const { return *built.scene; }
};

/// Pictures of each level, of seeds of their own: fewer where they are large, for those of all levels are kept.
int replicates_of(Vec2i resolution);

/// Plans, builds and renders one sample twice: what the first takes more is what is done at first sight. A world is not
/// built, which is an error in `said`, where there is not the memory for it and what will be rendered of it: `pairs`
/// pictures of it and of another world each; 0 for levels.
CostWorld open_world(ParsedFile& file, size_t world, const CostVariant& variant, const CostRequest& request, int pairs,
                     CostClock& clock);

/// Several pictures of one world, each of a seed of its own, that grow.
class SeededFilms {
 public:
  SeededFilms(CostWorld& world, uint32_t first_seed, int count);
  int size() const { return static_cast<int>(films_.size()); }

  /// Gives a film so many samples per pixel, as the sampler rounds them: by adding to it where the sampler goes on, else
  /// anew. False when it was stopped; the film is then of no use.
  bool grow(int film, int samples);
  Picture picture(int film) const { return films_[static_cast<size_t>(film)].render->picture(); }
  /// What its samples took.
  Elapsed spent(int film) const;

 private:
  struct Film {
    uint32_t seed;
    std::unique_ptr<FilmRender> render;
    double wall = 0;
  };
  CostWorld& world_;
  std::vector<Film> films_;
};

}  // namespace whit
