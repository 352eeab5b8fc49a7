#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/gltf/accessor.h"
#include "core/gltf/numbers.h"
#include "core/gltf/primitive_parts.h"

namespace whit::gltf {
namespace {

/// Strips and fans as lists, by the specification's section 3.7.2.1.
std::vector<uint32_t> as_list(Primitive::Mode mode, std::vector<uint32_t> corners) {
  if (mode == Primitive::Mode::Triangles) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<uint32_t> out;
  if (corners.size() < 3) return out;
  out.reserve((corners.size() - 2) * 3);
  for (size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == Primitive::Mode::Strip)
      out.insert(out.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    else out.insert(out.end(), {corners[i + 1], corners[i + 2], corners[0]});
  }
  return out;
}

}  // namespace

std::string PrimitiveSource::open() {
  if (!primitive_.draco) return {};
  std::span<const uint8_t> bytes;
  std::string error = model_.buffers->view(primitive_.draco->view, bytes);
  if (!error.empty()) return model_.at(error);
  draco_ = std::make_unique<DracoMesh>();
  const uint64_t most = primitive_.indices >= 0 ? element_count(model_, primitive_.indices) : uint64_t{1} << 25;
  // A copy, which stays the same while it is decoded.
  const std::vector<uint8_t> encoded(bytes.begin(), bytes.end());
  error = draco_->decode(encoded, most);
  return error.empty() ? "" : at("/extensions/KHR_draco_mesh_compression: " + error);
}

int PrimitiveSource::draco_attribute(int accessor) const {
  if (!draco_) return -1;
  for (const auto& [a, attribute] : primitive_.draco->attributes)
    if (a == accessor) return attribute;
  return -1;
}

std::string PrimitiveSource::check_count(int accessor, size_t found, size_t vertices) const {
  if (found == vertices) return {};
  return model_.at(
      fmt::format("/accessors/{}: has {} elements, and the primitive {} vertices", accessor, found, vertices));
}

std::string PrimitiveSource::positions(std::vector<double>& out) const {
  const int accessor = primitive_.attributes.position;
  if (const int attribute = draco_attribute(accessor); attribute >= 0) {
    std::vector<float> floats;
    const std::string error = draco_->read(attribute, model_.buffers->accessors[static_cast<size_t>(accessor)], floats);
    out.assign(floats.begin(), floats.end());
    return error.empty() ? "" : at("/attributes/POSITION: " + error);
  }
  const std::string error = read_any_numbers(model_, accessor, out);
  return error.empty() ? "" : model_.at(error);
}

std::string PrimitiveSource::triangles(size_t vertices, std::vector<uint32_t>& out) const {
  std::vector<uint32_t> corners;
  if (draco_) {
    corners = draco_->indices();
  } else if (primitive_.indices >= 0) {
    const std::string error = read_integers(model_, primitive_.indices, corners);
    if (!error.empty()) return model_.at(error);
  } else {
    corners.resize(vertices);
    std::iota(corners.begin(), corners.end(), 0u);
  }
  uint32_t most = 0;
  for (const uint32_t corner : corners) most = std::max(most, corner);
  if (!corners.empty() && most >= vertices) {
    const auto bad = std::find_if(corners.begin(), corners.end(), [&](uint32_t corner) { return corner >= vertices; });
    return at(
        fmt::format("/indices: number {} is {}, and there are {} vertices", bad - corners.begin(), *bad, vertices));
  }
  // What Draco decodes is a list, whatever the mode says.
  out = as_list(draco_ ? Primitive::Mode::Triangles : primitive_.mode, std::move(corners));
  return {};
}

std::string PrimitiveSource::floats(int accessor, size_t vertices, std::vector<float>& out) const {
  out.clear();
  if (accessor < 0) return {};
  const auto width = static_cast<size_t>(components_of(model_, accessor));
  std::string error;
  if (const int attribute = draco_attribute(accessor); attribute >= 0) {
    error = draco_->read(attribute, model_.buffers->accessors[static_cast<size_t>(accessor)], out);
    if (!error.empty()) return at("/extensions/KHR_draco_mesh_compression: " + error);
    error = not_finite(accessor, out, static_cast<int>(width));
  } else {
    error = read_floats(model_, accessor, out);
  }
  return error.empty() ? check_count(accessor, out.size() / width, vertices) : model_.at(error);
}

std::string PrimitiveSource::integers(int accessor, size_t vertices, std::vector<uint32_t>& out) const {
  if (draco_attribute(accessor) < 0) {
    const std::string error = read_integers(model_, accessor, out);
    return error.empty()
               ? check_count(accessor, out.size() / static_cast<size_t>(components_of(model_, accessor)), vertices)
               : model_.at(error);
  }
  std::vector<float> numbers;
  const std::string error = floats(accessor, vertices, numbers);
  // Joints have at most 16 bits, which floats hold.
  for (const float number : numbers) out.push_back(number > 0 ? static_cast<uint32_t>(std::min(number, 65535.0f)) : 0u);
  return error;
}

}  // namespace whit::gltf
