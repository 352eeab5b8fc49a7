#include "core/gltf/accessor.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "core/gltf/buffers.h"
#include "core/gltf/numbers.h"

namespace whit::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of buffers are little-endian");

const Accessor& at(const Model& model, int accessor) { return model.buffers->accessors[static_cast<size_t>(accessor)]; }

template <class T>
T load(const uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Calls body with a value of the C++ type that stands for the component.
template <class Body>
auto with_type(Component c, const Body& body) {
  switch (c) {
    case Component::Int8: return body(int8_t{});
    case Component::Uint8: return body(uint8_t{});
    case Component::Int16: return body(int16_t{});
    case Component::Uint16: return body(uint16_t{});
    case Component::Uint32: return body(uint32_t{});
    case Component::Float: break;
  }
  return body(float{});
}

/// Signed integers stand for [-1, 1], the least of them too.
template <class Out, class In>
Out converted(In value, bool normalized) {
  if constexpr (std::is_integral_v<In> && std::is_floating_point_v<Out>) {
    if (normalized)
      return std::max(static_cast<Out>(value) / static_cast<Out>(std::numeric_limits<In>::max()), Out{-1});
  }
  return static_cast<Out>(value);
}

/// `count` elements of kWidth numbers, `stride` bytes apart.
template <class In, int kWidth, class Out>
void gather(const uint8_t* from, size_t stride, size_t count, bool normalized, Out* out) {
  for (size_t i = 0; i < count; ++i, from += stride, out += kWidth)
    for (int k = 0; k < kWidth; ++k)
      out[k] = converted<Out>(load<In>(from + static_cast<size_t>(k) * sizeof(In)), normalized);
}

/// Elements as they lie in a view. `out` has room for all of their numbers.
template <class Out>
void decode(const Accessor& a, const uint8_t* from, size_t stride, size_t count, Out* out) {
  const bool as_they_are = (std::is_same_v<Out, float> && a.component == Component::Float) ||
                           (std::is_same_v<Out, uint32_t> && a.component == Component::Uint32);
  if (as_they_are && a.columns == 1 && stride == a.element_size()) {
    std::memcpy(out, from, count * stride);
    return;
  }
  with_type(a.component, [&](auto zero) {
    using In = decltype(zero);
    if (a.columns == 1) {
      switch (a.rows) {
        case 1: return gather<In, 1>(from, stride, count, a.normalized, out);
        case 2: return gather<In, 2>(from, stride, count, a.normalized, out);
        case 3: return gather<In, 3>(from, stride, count, a.normalized, out);
        default: return gather<In, 4>(from, stride, count, a.normalized, out);
      }
    }
    for (size_t i = 0; i < count; ++i)
      for (int column = 0; column < a.columns; ++column)
        for (int row = 0; row < a.rows; ++row)
          *out++ = converted<Out>(load<In>(from + i * stride + static_cast<size_t>(column) * a.column_size() +
                                           static_cast<size_t>(row) * sizeof(In)),
                                  a.normalized);
  });
}

uint32_t sparse_index(const Sparse& s, std::span<const uint8_t> indices, size_t stride, size_t i) {
  return with_type(s.index_type, [&](auto zero) {
    return static_cast<uint32_t>(load<decltype(zero)>(indices.data() + s.index_offset + i * stride));
  });
}

template <class Out>
std::string decode_sparse(const Buffers& buffers, const Accessor& a, Out* out) {
  const Sparse& s = *a.sparse;
  std::span<const uint8_t> in_file, values;
  if (std::string error = buffers.view(s.index_view, in_file); !error.empty()) return error;
  // Copied, so that what is checked is what is used, whoever writes to the file meanwhile.
  const std::vector<uint8_t> indices(in_file.begin(), in_file.end());
  if (std::string error = buffers.view(s.value_view, values); !error.empty()) return error;
  if (std::string error = sparse_problem(a, s, indices); !error.empty()) return "/sparse/indices: " + error;
  const size_t width = static_cast<size_t>(a.numbers());
  std::vector<Out> replaced(s.count * width);
  const size_t value_stride = buffers.views[static_cast<size_t>(s.value_view)].stride;
  decode(a, values.data() + s.value_offset, value_stride != 0 ? value_stride : a.element_size(), s.count,
         replaced.data());
  const size_t stride = size_of(s.index_type);
  for (size_t i = 0; i < s.count; ++i)
    std::copy_n(replaced.data() + i * width, width, out + sparse_index(s, indices, stride, i) * width);
  return {};
}

template <class Out>
std::string read(const Buffers& buffers, int accessor, std::vector<Out>& out) {
  const Accessor& a = buffers.accessors[static_cast<size_t>(accessor)];
  std::span<const uint8_t> bytes;
  if (a.view >= 0) {
    if (std::string error = buffers.view(a.view, bytes); !error.empty()) return error;
  }
  out.resize(a.count * static_cast<size_t>(a.numbers()));
  if (a.view < 0) {
    std::fill(out.begin(), out.end(), Out{});
  } else {
    const size_t stride = buffers.views[static_cast<size_t>(a.view)].stride;
    decode(a, bytes.data() + a.offset, stride != 0 ? stride : a.element_size(), a.count, out.data());
  }
  if (!a.sparse) return {};
  const std::string error = decode_sparse(buffers, a, out.data());
  return error.empty() ? "" : fmt::format("/accessors/{}{}", accessor, error);
}

/// The first number that is not finite, or -1. Most arrays have none: whole blocks are tried first.
ptrdiff_t first_not_finite(const std::vector<float>& numbers) {
  constexpr size_t kBlock = 4096;
  for (size_t begin = 0; begin < numbers.size(); begin += kBlock) {
    const size_t end = std::min(begin + kBlock, numbers.size());
    uint32_t bad = 0;
    for (size_t i = begin; i < end; ++i)
      bad |= (std::bit_cast<uint32_t>(numbers[i]) & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
    for (size_t i = begin; bad != 0 && i < end; ++i)
      if (!std::isfinite(numbers[i])) return static_cast<ptrdiff_t>(i);
  }
  return -1;
}

}  // namespace

size_t element_count(const Model& model, int accessor) { return at(model, accessor).count; }
int components_of(const Model& model, int accessor) { return at(model, accessor).numbers(); }

std::string sparse_problem(const Accessor& a, const Sparse& s, std::span<const uint8_t> indices) {
  const size_t stride = size_of(s.index_type);
  // Who has no bytes has been told why.
  if (indices.size() < s.index_offset + s.count * stride) return indices.empty() ? "" : "end early";
  for (size_t i = 0, last = 0; i < s.count; ++i) {
    const uint32_t index = sparse_index(s, indices, stride, i);
    if (i > 0 && index <= last) return fmt::format("must increase, and {} follows {}", index, last);
    if (index >= a.count) return fmt::format("{} is not below the accessor's count of {}", index, a.count);
    last = index;
  }
  return {};
}

std::string read_any_numbers(const Model& model, int accessor, std::vector<double>& out) {
  return read(*model.buffers, accessor, out);
}

std::string not_finite(int accessor, const std::vector<float>& numbers, int width) {
  const ptrdiff_t bad = first_not_finite(numbers);
  if (bad < 0) return {};
  return fmt::format("/accessors/{}: element {} is not finite", accessor, bad / width);
}

std::string read_floats(const Buffers& buffers, int accessor, std::vector<float>& out) {
  const std::string error = read(buffers, accessor, out);
  return error.empty() ? not_finite(accessor, out, buffers.accessors[static_cast<size_t>(accessor)].numbers()) : error;
}

std::string read_floats(const Model& model, int accessor, std::vector<float>& out) {
  return read_floats(*model.buffers, accessor, out);
}

std::string read_integers(const Model& model, int accessor, std::vector<uint32_t>& out) {
  return read(*model.buffers, accessor, out);
}

}  // namespace whit::gltf
