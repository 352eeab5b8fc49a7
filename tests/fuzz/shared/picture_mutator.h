// PNG files changed so that their checksums and lengths are right again; other pictures as libFuzzer changes bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace whit::fuzz {

/// For LLVMFuzzerCustomMutator: of a PNG a chunk's data, name or place is changed, or what its pixels are packed from.
size_t mutate_picture(uint8_t* data, size_t size, size_t max_size, unsigned seed);

}  // namespace whit::fuzz
