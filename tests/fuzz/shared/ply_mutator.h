// PLY files changed so that they mostly stay PLY files: libFuzzer's own mutator rarely leaves a header that can be read.
#pragma once

#include <cstddef>
#include <cstdint>

namespace whit::fuzz {

/// For LLVMFuzzerCustomMutator: a line of the header changed, numbers of the body, or a new file whose body has as many
/// numbers as its header says, in any format, order and type of properties.
size_t mutate_ply(uint8_t* data, size_t size, size_t max_size, unsigned seed);

}  // namespace whit::fuzz
