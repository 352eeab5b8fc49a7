// The entry points of a libFuzzer target whose input is the text of a scene, beside the one of its own: to be included by the
// one source of such a target.
#pragma once

#include "tests/fuzz/shared/scene_mutator.h"

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  return whit::fuzz::mutate_scene(data, size, max_size, seed);
}

extern "C" size_t LLVMFuzzerCustomCrossOver(const uint8_t* a, size_t a_size, const uint8_t* b, size_t b_size,
                                            uint8_t* out, size_t max_size, unsigned seed) {
  return whit::fuzz::cross_scenes({a, a_size}, {b, b_size}, out, max_size, seed);
}
