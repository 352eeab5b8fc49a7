// libFuzzer entry: any text is a scene, which is parsed, planned, measured, built and rendered, 4 x 4 pixels of one
// sample. Every number of the picture must be one.
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "core/image/oiio/module.h"
#include "core/session/memory.h"
#include "core/session/models.h"
#include "core/session/session.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/scene_entries.h"
#include "tests/fuzz/shared/scene_limits.h"

namespace {

using whit::fuzz::require;

/// Names in a scene are looked for in the folder of its files and nowhere else: no path leaves it without one of these.
std::string without_paths(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '/' || c == '\\'; }, '_');
  return text;
}

void render(whit::SceneDescription world, const whit::Sources& sources) {
  whit::fuzz::limit(world);
  whit::PlannedWorld planned = whit::plan_world(world, sources);
  const bool has_errors = planned.said.has_errors();
  require(whit::plan_memory(planned, {.film = {.threads = 1}, .texture_bytes = size_t{64} << 20}).total() > 0);
  const whit::BuiltWorld built =
      whit::build_world(std::move(planned), {.samples_per_pixel = 1, .keep_going = true}, size_t{64} << 20);
  require(built.scene || has_errors || built.said.has_errors());
  if (!built.scene) return;
  const whit::RenderedWorld rendered = whit::render_world(built, {.threads = 1});
  for (const float v : rendered.result.picture.rgb) require(std::isfinite(v));
}

}  // namespace

/// As in pictures_fuzz.cpp.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  whit::oiio();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  whit::Sources sources;
  whit::ModelStore models;
  whit::ParseResult parsed = whit::parse_text(sources, "fuzz", without_paths(whit::fuzz::text_of(data, size)),
                                              WHIT_SOURCE_DIR "/tests/fuzz/corpus/files", {.models = &models});
  if (parsed.scenes.size() > 4) parsed.scenes.resize(4);
  for (whit::SceneDescription& world : parsed.scenes) render(std::move(world), sources);
  return 0;
}
