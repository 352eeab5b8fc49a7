// What a film and its workers are going to take of memory, and the pictures that come of it.
#pragma once

#include <string>
#include <vector>

#include "core/render/render.h"
#include "core/scene/memory_plan.h"

namespace whit {

/// What a render is asked for, as far as memory depends on it.
struct FilmNeed {
  int threads = 0;                ///< 0: one per core.
  bool crop_given = false;        ///< As RenderOptions.
  double crop[4] = {0, 1, 0, 1};  ///< Likewise.
  bool quick = false;             ///< BuildOptions::quick
  bool blocks = false, adaptive = false;
  std::vector<std::string> aovs{};     ///< Names that there are.
  bool linear = true, display = true;  ///< Files that are written: of linear numbers, of numbers for displays.
  bool denoise = false;                ///< Beside the picture, one that a denoiser makes of it.
  int films = 1;                       ///< That grow side by side, each with sums of its own.
  double kept_pictures = 0;            ///< Of three floats a pixel, beside what is written, while there are films.
};

/// Adds that to a plan; nothing where film or filter are no good, for then no picture will be made.
void plan_film_memory(const BoundScene& bound, const FilmNeed& need, MemoryPlan& memory);

}  // namespace whit
