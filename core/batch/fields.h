// Structures of arrays name their arrays once, in fields(); allocating, moving along and picking lanes follow from that.
//
// A null array is one that nobody asked for: it stays null, and nothing is allocated or copied for it.
#pragma once

#include <cstring>
#include <tuple>
#include <type_traits>

#include "core/batch/arena.h"
#include "core/batch/lanes.h"

namespace whit {

namespace detail {

template <class T>
concept HasFields = requires {
  T::fields();
};

template <class T>
inline constexpr bool kIsArray = std::is_pointer_v<T>;

// An array, or a structure of arrays that is one of the fields: down to the plain pointers.
template <class Array, class F>
void visit(Array& a, const F& f);
template <class Array, class F>
void visit2(Array& a, const Array& b, const F& f);

}  // namespace detail

/// Calls f(pointer) for every array of s.
template <detail::HasFields T, class F>
void for_fields(T& s, const F& f) {
  std::apply([&](auto... field) { (detail::visit(s.*field, f), ...); }, T::fields());
}
/// Calls f(pointer of a, pointer of b) for every array.
template <detail::HasFields T, class F>
void for_fields(T& a, const T& b, const F& f) {
  std::apply([&](auto... field) { (detail::visit2(a.*field, b.*field, f), ...); }, T::fields());
}

namespace detail {

template <class Array, class F>
void visit(Array& a, const F& f) {
  if constexpr (kIsArray<Array>) {
    f(a);
  } else if constexpr (std::is_same_v<Array, Vec3Lanes>) {
    f(a.x), f(a.y), f(a.z);
  } else if constexpr (std::is_same_v<Array, RGBLanes>) {
    f(a.r), f(a.g), f(a.b);
  } else {
    for_fields(a, f);
  }
}

template <class Array, class F>
void visit2(Array& a, const Array& b, const F& f) {
  if constexpr (kIsArray<Array>) {
    f(a, b);
  } else if constexpr (std::is_same_v<Array, Vec3Lanes>) {
    f(a.x, b.x), f(a.y, b.y), f(a.z, b.z);
  } else if constexpr (std::is_same_v<Array, RGBLanes>) {
    f(a.r, b.r), f(a.g, b.g), f(a.b, b.b);
  } else {
    for_fields(a, b, f);
  }
}

}  // namespace detail

/// The lanes from `first` on, as a view.
template <detail::HasFields T>
T from_lane(T s, int first) {
  for_fields(s, [first](auto*& p) { p = p ? p + first : p; });
  return s;
}

/// What allocate_like() takes for a structure with all its arrays. They point to nothing of use.
template <detail::HasFields T>
T with_all_fields() {
  static float there;
  T s;
  for_fields(s, [](auto*& p) { p = reinterpret_cast<std::remove_reference_t<decltype(p)>>(&there); });
  return s;
}

/// Arrays of n lanes for what `like` has.
template <detail::HasFields T>
T allocate_like(const T& like, int n, Arena& arena) {
  T s = like;
  for_fields(s, [&](auto*& p) {
    if (p) p = arena.alloc<std::remove_cvref_t<decltype(*p)>>(n);
  });
  return s;
}

/// Copies n lanes.
template <detail::HasFields T>
void copy_lanes(const T& from, int n, const T& to) {
  T out = to;
  for_fields(out, from, [n](auto* t, const auto* f) {
    if (f) std::memcpy(t, f, static_cast<size_t>(n) * sizeof *f);
  });
}

/// The n lanes that `lanes` names, in that order, in arrays of their own.
template <detail::HasFields T>
T gathered(const T& from, const int32_t* lanes, int n, Arena& arena) {
  T out = allocate_like(from, n, arena);
  for_fields(out, from, [&](auto* to, const auto* values) {
    if (values) for_lanes(n, [&](int i) { to[i] = values[lanes[i]]; });
  });
  return out;
}

/// Bytes that a lane takes in the arrays that are there.
template <detail::HasFields T>
int lane_bytes(T s) {
  size_t bytes = 0;
  for_fields(s, [&bytes](const auto* p) { bytes += p ? sizeof *p : 0; });
  return static_cast<int>(bytes);
}

}  // namespace whit
