// libFuzzer entry: any bytes are read as a tabulated BSDF. What is read must be a table that can be interpolated and
// sampled without a look outside of it, whatever its coefficients.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/lobe/eval.h"
#include "core/lobe/fourier.h"
#include "tests/fuzz/shared/fuzz.h"

namespace {

using whit::fuzz::require;

void check(const whit::FourierTable& t) {
  const size_t pairs = t.mu.size() * t.mu.size();
  require(t.channels == 1 || t.channels == 3);
  require(t.first.size() == pairs && t.order.size() == pairs && t.mean.size() == pairs && t.integrals.size() == pairs);
  for (size_t k = 0; k < pairs; ++k) {
    require(t.first[k] >= 0 && t.order[k] >= 0 && t.order[k] <= t.max_order);
    require(static_cast<size_t>(t.first[k]) + static_cast<size_t>(t.order[k]) * static_cast<size_t>(t.channels) <=
            t.a.size());
  }
}

whit::Vec3f direction(float cosine, float phi) {
  const float r = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return {r * std::cos(phi), r * std::sin(phi), cosine};
}

constexpr float kCosines[] = {1, 0.7f, 0.3f, 1e-6f, -1e-6f, -0.5f, -1};

/// A surface z = 0 with the table as its only lobe, seen from some directions.
void use(const whit::FourierTable& table) {
  constexpr int kCount = std::size(kCosines);
  static whit::Arena arena;
  const whit::ArenaScope scope(arena);
  whit::ShadingBatch s;
  s.n = kCount, s.arena = &arena;
  s.wo = arena.vec3(kCount), s.ng = arena.vec3(kCount), s.ns = arena.vec3(kCount), s.dpdu = arena.vec3(kCount);
  const whit::Vec3Lanes wi = arena.vec3(kCount);
  const whit::RGBLanes f = arena.rgb(kCount), weight = arena.rgb(kCount);
  float* const numbers = arena.floats(kCount);
  float* const pdf = arena.floats(kCount);
  float* const ones = arena.floats(kCount);
  for (int i = 0; i < kCount; ++i) {
    s.ng.set(i, {0, 0, 1}), s.ns.set(i, {0, 0, 1}), s.dpdu.set(i, {1, 0, 0});
    s.wo.set(i, direction(kCosines[i], 1)), wi.set(i, direction(kCosines[kCount - 1 - i], 2));
    numbers[i] = 0.14f * static_cast<float>(i), ones[i] = 1;
  }
  whit::LobeSet set(arena);
  whit::Lobe lobe;
  lobe.type = whit::LobeType::Fourier, lobe.weight = {ones, ones, ones};
  lobe.a = lobe.b = lobe.eta = ones, lobe.table = &table;
  set.add(lobe);
  const whit::LobeFrame frame = whit::prepare_frame(set, s);
  whit::eval_lobes(set, s, frame, wi, f, pdf);
  whit::sample_lobes(set, s, frame, numbers, numbers, numbers, whit::LobeKinds::All, {wi, weight, pdf});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  whit::FourierTable table;
  if (!whit::parse_fourier_table({reinterpret_cast<const char*>(data), size}, table).empty()) return 0;
  check(table);
  use(table);
  return 0;
}

/// Most changes make the counts of the header disagree with the file's length, which is refused at once: mostly the
/// tables behind it are changed, whose length stays.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  constexpr size_t kHeader = 64;
  whit::fuzz::Dice dice(seed);
  if (size <= kHeader || dice.one_in(4)) return LLVMFuzzerMutate(data, size, max_size);
  return kHeader + LLVMFuzzerMutate(data + kHeader, size - kHeader, size - kHeader);
}
