// JSON changed value by value, so that it stays JSON; glTF models and messages of editors around it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/fuzz/shared/fuzz.h"

namespace whit::fuzz {

/// A value anywhere in it lost, doubled, exchanged for another of it, or made an odd one.
void mutate_json(nlohmann::json& root, Dice& dice);

/// For LLVMFuzzerCustomMutator, of a .gltf or .glb file: the JSON or the buffer is changed, and the lengths around them
/// are right.
size_t mutate_model(uint8_t* data, size_t size, size_t max_size, unsigned seed);

/// The same of a stream of messages of the language server protocol: messages lost, doubled, moved and changed, with headers
/// that are right, and scenes in them changed as scenes (scene_mutator.h).
size_t mutate_messages(uint8_t* data, size_t size, size_t max_size, unsigned seed);

}  // namespace whit::fuzz
