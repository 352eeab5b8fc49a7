// libFuzzer entry: any bytes are read as a table of wavelengths and values, and turned into a colour.
#include <cmath>

#include "core/base/spectrum.h"
#include "tests/fuzz/shared/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using whit::fuzz::require;
  static whit::fuzz::MemoryFile file;
  file.set(data, size);
  const whit::SpdFile read = whit::read_spd_file(file.path());
  require(read.readable);
  if (!read.error.empty()) return 0;
  require(!read.pairs.empty() && read.pairs.size() % 2 == 0);
  for (const double v : read.pairs) require(std::isfinite(v));
  whit::rgb_from_samples(read.pairs);
  return 0;
}
