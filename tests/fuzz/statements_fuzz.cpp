// libFuzzer entry: any bytes are parsed as a scene, and every message about it is put into words.
#include "parser/parse.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/scene_mutator.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  // Includes resolve below a file, so that none can be opened, but for absolute paths to regular files.
  const std::string nowhere = "/dev/null/nowhere";
  whit::Sources sources;
  const whit::ParseResult result = whit::parse_text(sources, "fuzz", whit::fuzz::text_of(data, size), nowhere);
  for (const whit::Diagnostic& d : result.diagnostics.all()) sources.render_diagnostic(d, size % 2 == 0);
  whit::fuzz::require(result.diagnostics.has_errors() || !result.scenes.empty());
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  return whit::fuzz::mutate_scene(data, size, max_size, seed);
}

extern "C" size_t LLVMFuzzerCustomCrossOver(const uint8_t* a, size_t a_size, const uint8_t* b, size_t b_size,
                                            uint8_t* out, size_t max_size, unsigned seed) {
  return whit::fuzz::cross_scenes({a, a_size}, {b, b_size}, out, max_size, seed);
}
