#include "core/render/ray_queue.h"

#include <algorithm>

namespace whit {

RayQueue::RayQueue(int depth, const CarriedByRays& carried) {
  Rays like = with_all_fields<Rays>();
  if (!carried.differentials) like.differentials = {};
  if (!carried.time) like.time = nullptr;
  if (!carried.densities) like.pdf = nullptr, like.from = {};
  if (!carried.eta2) like.eta2 = nullptr;
  if (!carried.via) like.via = nullptr;
  like.depth = depth;
  rays_ = like;
}

void RayQueue::reserve(int capacity) {
  if (capacity <= capacity_) return;
  capacity = std::max((capacity + 15) & ~15, 2 * capacity_);
  auto storage = std::make_unique<Arena>(size_t{1} << 16);
  const Rays grown = allocate_like(rays_, capacity, *storage);
  if (rays_.n > 0) copy_lanes(rays_, rays_.n, grown);
  rays_ = grown;
  storage_ = std::move(storage);
  capacity_ = capacity;
}

Rays RayQueue::append(int n) {
  reserve(rays_.n + n);
  Rays added = from_lane(rays_, rays_.n);
  added.n = n;
  rays_.n += n;
  return added;
}

}  // namespace whit
