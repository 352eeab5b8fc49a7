// Numbers as half floats.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace whit {

/// The nearest ones. What is too large for them is the largest that is not infinite.
std::vector<uint16_t> halves_of(std::span<const float> numbers);
std::vector<float> floats_of(std::span<const uint16_t> halves);

}  // namespace whit
