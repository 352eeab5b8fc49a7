// Filters of one dimension, of many rows at once or of many numbers of a row.
#pragma once

#include <cstddef>
#include <vector>

namespace whit {

/// A filter from -radius to radius, by its weights from 0 on: those below 0 are the same, or the same with the other sign.
template <class T>
struct HalfKernel {
  bool odd = false;
  std::vector<T> weights;
  int radius() const { return static_cast<int>(weights.size()) - 1; }
};

namespace detail {

// In blocks, whose sums stay in registers.
template <class T>
inline constexpr size_t kConvolveBlock = 256 / sizeof(T);

template <bool odd, class T>
inline void convolve_block(const HalfKernel<T>& kernel, const T* const* from, size_t x0, size_t size, T* out) {
  T sums[kConvolveBlock<T>];
  const T* middle = from[0] + x0;
  const T w0 = kernel.weights[0];
  for (size_t x = 0; x < size; ++x) sums[x] = w0 * middle[x];
  for (int k = 1; k <= kernel.radius(); ++k) {
    const T *before = from[-k] + x0, *after = from[k] + x0;
    const T w = kernel.weights[static_cast<size_t>(k)];
#pragma omp simd
    for (size_t x = 0; x < size; ++x) sums[x] += w * (odd ? after[x] - before[x] : after[x] + before[x]);
  }
  for (size_t x = 0; x < size; ++x) out[x0 + x] = sums[x];
}

template <bool odd, class T>
void convolve_blocks(const HalfKernel<T>& kernel, const T* const* from, size_t size, T* out) {
  size_t x = 0;
  for (; x + kConvolveBlock<T> <= size; x += kConvolveBlock<T>)
    convolve_block<odd>(kernel, from, x, kConvolveBlock<T>, out);
  if (x < size) convolve_block<odd>(kernel, from, x, size - x, out);
}

}  // namespace detail

/// out[x] = sum over k of weight(k) from[k][x], for x below `size`. from[0] is the middle one: there are `radius` pointers on
/// either side of it.
template <class T>
void convolve(const HalfKernel<T>& kernel, const T* const* from, size_t size, T* out) {
  if (kernel.odd) detail::convolve_blocks<true>(kernel, from, size, out);
  else detail::convolve_blocks<false>(kernel, from, size, out);
}

}  // namespace whit
