// Morph targets, then skins.
#include <fmt/format.h>

#include <cmath>

#include "core/gltf/primitive_parts.h"

namespace whit::gltf {
namespace {

Vec3d vector_at(const auto& values, size_t i) {
  return {double{values[i]}, double{values[i + 1]}, double{values[i + 2]}};
}

template <class T>
void store(const Vec3d& v, std::vector<T>& values, size_t i) {
  for (size_t k = 0; k < 3; ++k) values[i + k] = static_cast<T>(v[static_cast<int>(k)]);
}

/// Sums and matrices change lengths. What weights without measure made infinite is no direction.
Vec3d unit(const Vec3d& v) {
  const Vec3d out = v.normalized();
  return std::isfinite(out.x + out.y + out.z) ? out : Vec3d(0.0);
}

void make_unit(std::vector<float>& values, size_t width) {
  for (size_t i = 0; i + 2 < values.size(); i += width) store(unit(vector_at(values, i)), values, i);
}

std::string morph(const PrimitiveSource& source, const Primitive& primitive, const Pose& pose, PosedArrays& arrays) {
  const size_t vertices = arrays.positions.size() / 3;
  bool turned = false;
  for (size_t t = 0; t < primitive.targets.size() && t < pose.weights.size(); ++t) {
    const double weight = pose.weights[t];
    if (weight == 0) continue;
    const auto add = [&](int accessor, auto& to, size_t width) -> std::string {
      if (accessor < 0 || to.empty()) return {};
      std::vector<float> delta;
      if (std::string error = source.floats(accessor, vertices, delta); !error.empty()) return error;
      for (size_t i = 0; i < vertices; ++i)
        store(vector_at(to, i * width) + vector_at(delta, i * 3) * weight, to, i * width);
      return {};
    };
    const MorphTarget& target = primitive.targets[t];
    std::string error = add(target.position, arrays.positions, 3);
    if (error.empty()) error = add(target.normal, arrays.normals, 3);
    if (error.empty()) error = add(target.tangent, arrays.tangents, 4);
    if (!error.empty()) return error;
    turned = turned || target.normal >= 0 || target.tangent >= 0;
  }
  if (turned) make_unit(arrays.normals, 3), make_unit(arrays.tangents, 4);
  return {};
}

/// The joints of all vertices and their weights, set by set of four.
struct Influences {
  std::vector<std::vector<uint32_t>> joints;
  std::vector<std::vector<float>> weights;
};

std::string read_influences(const PrimitiveSource& source, const Attributes& attributes, size_t vertices, size_t joints,
                            Influences& out) {
  const size_t sets = std::min(attributes.joints.size(), attributes.weights.size());
  out.joints.resize(sets), out.weights.resize(sets);
  for (size_t s = 0; s < sets; ++s) {
    std::string error = source.integers(attributes.joints[s], vertices, out.joints[s]);
    if (error.empty()) error = source.floats(attributes.weights[s], vertices, out.weights[s]);
    if (!error.empty()) return error;
    for (size_t i = 0; i < out.joints[s].size(); ++i) {
      if (out.joints[s][i] < joints) continue;
      // Exporters write anything where the weight is 0.
      if (out.weights[s][i] == 0) out.joints[s][i] = 0;
      else
        return source.at(fmt::format("/attributes/JOINTS_{}: vertex {} names joint {}, and the skin has {}", s, i / 4,
                                     out.joints[s][i], joints));
    }
  }
  return {};
}

Mat4d blended(const Influences& influences, const std::vector<Mat4d>& joints, size_t vertex) {
  double sum = 0;
  for (const auto& weights : influences.weights)
    for (size_t k = 0; k < 4; ++k) sum += double{weights[vertex * 4 + k]};
  // Without weights a vertex follows its first joint.
  if (!(sum > 0)) return joints[influences.joints[0][vertex * 4]];
  Mat4d m(0.0);
  for (size_t s = 0; s < influences.weights.size(); ++s) {
    for (size_t k = 0; k < 4; ++k) {
      const double weight = double{influences.weights[s][vertex * 4 + k]} / sum;
      if (weight != 0) m += joints[influences.joints[s][vertex * 4 + k]] * weight;
    }
  }
  return m;
}

/// A normal under the inverse transpose of the linear part, which its cofactors are but for a factor.
Vec3d transform_normal(const Mat4d& m, const Vec3d& n) {
  const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
  const Vec3d out = y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z;
  return unit(swaps_handedness(m) ? -out : out);
}

}  // namespace

std::string pose_arrays(const PrimitiveSource& source, const Primitive& primitive, const Pose& pose,
                        PosedArrays& arrays) {
  if (std::string error = morph(source, primitive, pose, arrays); !error.empty()) return error;
  if (pose.joints.empty() || primitive.attributes.joints.empty()) return {};
  const size_t vertices = arrays.positions.size() / 3;
  Influences influences;
  std::string error = read_influences(source, primitive.attributes, vertices, pose.joints.size(), influences);
  if (!error.empty()) return error;
  for (size_t i = 0; i < vertices; ++i) {
    const Mat4d m = blended(influences, pose.joints, i);
    store(transform_point(m, vector_at(arrays.positions, i * 3)), arrays.positions, i * 3);
    if (!arrays.normals.empty()) store(transform_normal(m, vector_at(arrays.normals, i * 3)), arrays.normals, i * 3);
    if (!arrays.tangents.empty())
      store(unit(transform_vector(m, vector_at(arrays.tangents, i * 4))), arrays.tangents, i * 4);
  }
  return {};
}

}  // namespace whit::gltf
