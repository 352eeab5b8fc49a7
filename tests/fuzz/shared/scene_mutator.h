// Scenes changed statement by statement and token by token: what comes of it mostly parses, and much of it can be rendered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace whit::fuzz {

/// For LLVMFuzzerCustomMutator: one to four changes of statements, parameters, names and numbers by what the parser and the
/// plugins declare; now and then of bytes.
size_t mutate_scene(uint8_t* data, size_t size, size_t max_size, unsigned seed);

/// For LLVMFuzzerCustomCrossOver: statements of two scenes in the order that they have there.
size_t cross_scenes(std::span<const uint8_t> a, std::span<const uint8_t> b, uint8_t* out, size_t max_size,
                    unsigned seed);

}  // namespace whit::fuzz
