#include "core/session/memory.h"

#include <tbb/task_arena.h>

#include <algorithm>

#include "core/plugin/memory_limit.h"

namespace whit {
namespace {

/// What the program takes later whatever it renders, as it was measured (docs/memory.md): the ray tracer's and the
/// threads' libraries, tables, stacks.
constexpr double kLater = 4 << 20;

}  // namespace

MemoryPlan plan_memory(const PlannedWorld& world, const MemoryRequest& request) {
  MemoryPlan memory;
  const double has = request.resident > 0 ? request.resident : static_cast<double>(resident_memory());
  memory.add_from(MemoryStep::Materials, MemoryUse::Program, has + kLater);
  const int threads = request.film.threads > 0 ? request.film.threads : tbb::this_task_arena::max_concurrency();
  plan_scene_memory(world.bound, world.plan, threads, static_cast<double>(request.texture_bytes), memory);
  plan_film_memory(world.bound, request.film, memory);
  return memory;
}

void fit_textures(MemoryPlan& memory, uint64_t limit) {
  const double most = static_cast<double>(limit), cap = memory.texture_cap();
  if (memory.total() <= most) return;
  double others = 0;
  for (const MemoryStep step :
       {MemoryStep::Rendering, MemoryStep::Finishing, MemoryStep::Writing, MemoryStep::Denoising})
    others = std::max(others, memory.total(step) - memory.of(MemoryUse::Textures, step));
  const double left = std::min(cap, most - others);
  if (left < memory.least_texture_cap()) return;
  memory.cap_textures(left);
}

}  // namespace whit
