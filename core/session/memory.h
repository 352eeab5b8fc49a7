// What rendering a planned world is going to take of memory, all in all, and what is done where there is not so much.
#pragma once

#include "core/image/texture_store.h"
#include "core/render/film_memory.h"
#include "core/session/session.h"

namespace whit {

struct MemoryRequest {
  FilmNeed film{};                                      ///< Of what is rendered, and written.
  size_t texture_bytes = TextureStore::kDefaultMemory;  ///< As build_world() is told.
  double resident = 0;  ///< What the process has but for what it gives back before; 0: all that it has.
};

/// The estimate: what the process has by now, and all that is still to come. Reads headers of files and nothing else.
MemoryPlan plan_memory(const PlannedWorld& world, const MemoryRequest& request);

/// Lowers the cap of decoded textures where the plan then keeps to `limit` bytes: that makes no picture another one. As far
/// as it must; not at all where it would not help.
void fit_textures(MemoryPlan& memory, uint64_t limit);

}  // namespace whit
