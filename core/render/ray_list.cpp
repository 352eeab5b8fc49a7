#include "core/render/ray_list.h"

#include <algorithm>
#include <cstring>

namespace whit {

void RayList::reserve(int capacity) {
  if (capacity <= capacity_) return;
  capacity = std::max((capacity + 15) & ~15, 2 * capacity_);
  const int fields = kFields + (with_differentials_ ? kDifferentialFields : 0);
  std::vector<float> grown(static_cast<size_t>(fields) * static_cast<size_t>(capacity) + 16);
  const auto base = [](std::vector<float>& s) {
    return reinterpret_cast<float*>((reinterpret_cast<uintptr_t>(s.data()) + 63) & ~uintptr_t{63});
  };
  for (int f = 0; f < fields && n > 0; ++f) {
    std::memcpy(base(grown) + static_cast<ptrdiff_t>(f) * capacity,
                base(storage_) + static_cast<ptrdiff_t>(f) * capacity_, sizeof(float) * static_cast<size_t>(n));
  }
  storage_ = std::move(grown);
  capacity_ = capacity;
  float* next = base(storage_);
  const auto take = [&]() {
    float* p = next;
    next += capacity;
    return p;
  };
  const auto vec = [&]() {
    float *x = take(), *y = take(), *z = take();
    return Vec3Lanes{x, y, z};
  };
  o = vec(), d = vec();
  const Vec3Lanes t = vec();
  throughput = {t.x, t.y, t.z};
  slot = reinterpret_cast<int32_t*>(take());
  stream = reinterpret_cast<uint32_t*>(take());
  if (with_differentials_) rx_o = vec(), rx_d = vec(), ry_o = vec(), ry_d = vec();
}

}  // namespace whit
