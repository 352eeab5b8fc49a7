#include "core/gltf/pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/gltf/accessor.h"

namespace whit::gltf {
namespace {

using Quaternion = std::array<double, 4>;  // x y z w

/// Scale, then rotation, then translation. A quaternion that is not quite a unit one is taken as its direction.
Mat4d matrix_of(const Vec3d& translation, const Quaternion& rotation, const Vec3d& scale) {
  const auto [x, y, z, w] = rotation;
  const double length2 = x * x + y * y + z * z + w * w, two = length2 > 0 ? 2 / length2 : 0;
  Mat4d m;
  m[0][0] = 1 - two * (y * y + z * z), m[0][1] = two * (x * y + z * w), m[0][2] = two * (x * z - y * w);
  m[1][0] = two * (x * y - z * w), m[1][1] = 1 - two * (x * x + z * z), m[1][2] = two * (y * z + x * w);
  m[2][0] = two * (x * z + y * w), m[2][1] = two * (y * z - x * w), m[2][2] = 1 - two * (x * x + y * y);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m[row][column] *= scale[row];
  }
  m[3][0] = translation.x, m[3][1] = translation.y, m[3][2] = translation.z;
  return m;
}

/// What animations change of a node.
struct LocalPose {
  Vec3d translation, scale;
  Quaternion rotation;
  std::vector<double> weights;
};

/// Which two keys a time is between, and how far on.
struct Between {
  size_t first = 0, second = 0;
  double share = 0, seconds = 0;  ///< Of the interval.
};

Between find_keys(const std::vector<float>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time,
                                      [](double t, float key) { return t < static_cast<double>(key); });
  if (after == times.begin()) return {};
  const auto first = static_cast<size_t>(after - times.begin() - 1);
  if (after == times.end()) return {first, first, 0, 0};
  const auto start = static_cast<double>(times[first]), seconds = static_cast<double>(*after) - start;
  return {first, first + 1, seconds > 0 ? (time - start) / seconds : 0, seconds};
}

/// The shorter way on the sphere of unit quaternions (Shoemake 1985); nearly equal ones on a line.
Quaternion slerp(Quaternion a, Quaternion b, double share) {
  double cosine = 0;
  for (size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
  const double sign = cosine < 0 ? -1 : 1, angle = std::acos(std::min(std::abs(cosine), 1.0)), sine = std::sin(angle);
  const double of_a = sine > 1e-6 ? std::sin((1 - share) * angle) / sine : 1 - share;
  const double of_b = (sine > 1e-6 ? std::sin(share * angle) / sine : share) * sign;
  for (size_t i = 0; i < 4; ++i) a[i] = of_a * a[i] + of_b * b[i];
  return a;
}

/// The numbers of a channel at a time, `count` of them, by the specification's appendix C.
std::vector<double> sample(const AnimationChannel& channel, const std::vector<float>& values, size_t count,
                           const Between& at) {
  using Interpolation = AnimationChannel::Interpolation;
  const bool cubic = channel.interpolation == Interpolation::CubicSpline;
  // A key of a cubic spline is a tangent that arrives, a value and a tangent that leaves.
  const size_t stride = cubic ? 3 * count : count, value = cubic ? count : 0;
  const auto number = [&](size_t key, size_t part, size_t i) {
    return static_cast<double>(values[key * stride + part + i]);
  };
  std::vector<double> out(count);
  if (channel.interpolation == Interpolation::Linear && channel.path == AnimationChannel::Path::Rotation) {
    const auto key = [&](size_t k) {
      return Quaternion{number(k, 0, 0), number(k, 0, 1), number(k, 0, 2), number(k, 0, 3)};
    };
    const Quaternion q = slerp(key(at.first), key(at.second), at.share);
    return {q.begin(), q.end()};
  }
  const double t = channel.interpolation == Interpolation::Step ? 0 : at.share, t2 = t * t, t3 = t2 * t;
  for (size_t i = 0; i < count; ++i) {
    const double from = number(at.first, value, i), to = number(at.second, value, i);
    out[i] = cubic ? (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * at.seconds * number(at.first, 2 * count, i) +
                         (3 * t2 - 2 * t3) * to + (t3 - t2) * at.seconds * number(at.second, 0, i)
                   : (1 - t) * from + t * to;
  }
  return out;
}

void set_property(LocalPose& pose, AnimationChannel::Path path, std::vector<double> v) {
  using Path = AnimationChannel::Path;
  switch (path) {
    case Path::Translation: pose.translation = {v[0], v[1], v[2]}; break;
    case Path::Scale: pose.scale = {v[0], v[1], v[2]}; break;
    case Path::Rotation: pose.rotation = {v[0], v[1], v[2], v[3]}; break;
    case Path::Weights: pose.weights = std::move(v); break;
  }
}

std::string animate(const Model& model, double time, std::vector<LocalPose>& poses) {
  using Path = AnimationChannel::Path;
  std::set<std::pair<int, Path>> moved;
  for (const Animation& animation : model.animations) {
    for (const AnimationChannel& channel : animation.channels) {
      if (channel.node < 0 || !moved.insert({channel.node, channel.path}).second) continue;
      LocalPose& pose = poses[static_cast<size_t>(channel.node)];
      const size_t count = channel.path == Path::Weights ? pose.weights.size() : channel.path == Path::Rotation ? 4 : 3;
      std::vector<float> times, values;
      if (std::string error = read_floats(model, channel.input, times); !error.empty()) return error;
      if (std::string error = read_floats(model, channel.output, values); !error.empty()) return error;
      const size_t parts = channel.interpolation == AnimationChannel::Interpolation::CubicSpline ? 3 : 1;
      if (times.empty() || count == 0 || values.size() < times.size() * count * parts) continue;
      set_property(pose, channel.path, sample(channel, values, count, find_keys(times, time)));
    }
  }
  return {};
}

size_t target_count(const Mesh& mesh) { return mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size(); }

LocalPose rest_pose(const Model& model, const Node& node) {
  LocalPose pose{node.translation, node.scale, node.rotation, node.weights};
  if (node.mesh < 0) return pose;
  const Mesh& mesh = model.meshes[static_cast<size_t>(node.mesh)];
  if (pose.weights.empty()) pose.weights = mesh.weights;
  pose.weights.resize(target_count(mesh));
  return pose;
}

}  // namespace

std::string pose_nodes(const Model& model, std::optional<double> time, PosedNodes& out) {
  std::vector<LocalPose> poses;
  for (const Node& node : model.nodes) poses.push_back(rest_pose(model, node));
  if (time) {
    if (std::string error = animate(model, *time, poses); !error.empty()) return error;
  }
  const size_t count = model.nodes.size();
  out.to_root.assign(count, Mat4d());
  out.weights.resize(count);
  std::vector<int> open;
  for (size_t i = 0; i < count; ++i) {
    if (model.nodes[i].parent < 0) open.push_back(static_cast<int>(i));
  }
  while (!open.empty()) {
    const auto i = static_cast<size_t>(open.back());
    open.pop_back();
    const Node& node = model.nodes[i];
    const Mat4d local = node.matrix ? *node.matrix : matrix_of(poses[i].translation, poses[i].rotation, poses[i].scale);
    out.to_root[i] = node.parent < 0 ? local : local * out.to_root[static_cast<size_t>(node.parent)];
    out.weights[i] = std::move(poses[i].weights);
    open.insert(open.end(), node.children.begin(), node.children.end());
  }
  return {};
}

bool is_placeable(const Mat4d& m) {
  const auto finite = [](const Mat4d& of) {
    return std::all_of(&of[0][0], &of[0][0] + 16, [](double x) { return std::isfinite(x); });
  };
  // Imath's inverse of what has none is the identity.
  const Mat4d inverse = m.gjInverse();
  return finite(m) && finite(inverse) && (inverse != Mat4d() || m == Mat4d());
}

bool is_bent(const Pose& pose) {
  return !pose.joints.empty() || std::any_of(pose.weights.begin(), pose.weights.end(), [](double w) { return w != 0; });
}

namespace {

/// Where a node's mesh is placed, and how it is bent before.
struct PlacedMesh {
  Mat4d to_root;  ///< Of a mesh with a skin the identity: its joints have placed it.
  Pose pose;
};

std::string place_mesh(const Model& model, const PosedNodes& posed, int index, PlacedMesh& out) {
  const Node& node = model.nodes[static_cast<size_t>(index)];
  out = {posed.to_root[static_cast<size_t>(index)], {posed.weights[static_cast<size_t>(index)], {}}};
  if (node.skin < 0) return {};
  const Skin& skin = model.skins[static_cast<size_t>(node.skin)];
  std::vector<float> inverse;
  if (skin.inverse_bind_matrices >= 0) {
    if (std::string error = read_floats(model, skin.inverse_bind_matrices, inverse); !error.empty()) return error;
  }
  for (size_t j = 0; j < skin.joints.size(); ++j) {
    Mat4d bind;
    for (size_t k = 0; k < 16 && 16 * j + 15 < inverse.size(); ++k) {
      bind[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = static_cast<double>(inverse[16 * j + k]);
    }
    out.pose.joints.push_back(bind * posed.to_root[static_cast<size_t>(skin.joints[j])]);
  }
  out.to_root = Mat4d();
  return {};
}

/// The matrices of EXT_mesh_gpu_instancing, each from the node's space to itself.
std::string read_instances(const Model& model, const GpuInstances& instances, std::vector<Mat4d>& out) {
  std::vector<float> translations, rotations, scales;
  for (const auto& [accessor, values] :
       {std::pair(instances.translation, &translations), std::pair(instances.rotation, &rotations),
        std::pair(instances.scale, &scales)}) {
    if (accessor < 0) continue;
    if (std::string error = read_floats(model, accessor, *values); !error.empty()) return error;
  }
  const size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
  const auto vector = [](const std::vector<float>& v, size_t i, const Vec3d& without) {
    return 3 * i + 2 < v.size() ? Vec3d(Vec3f(v[3 * i], v[3 * i + 1], v[3 * i + 2])) : without;
  };
  for (size_t i = 0; i < count; ++i) {
    Quaternion q{0, 0, 0, 1};
    for (size_t k = 0; k < 4 && 4 * i + 3 < rotations.size(); ++k) q[k] = static_cast<double>(rotations[4 * i + k]);
    out.push_back(matrix_of(vector(translations, i, {0, 0, 0}), q, vector(scales, i, {1, 1, 1})));
  }
  return {};
}

}  // namespace

std::string drawn_meshes(const Model& model, const ShownNodes& shown, std::vector<DrawnMesh>& out,
                         size_t& unplaceable) {
  constexpr size_t kMost = 1000000;
  size_t placements = 0;
  unplaceable = 0;
  for (const int index : shown.nodes) {
    const Node& node = model.nodes[static_cast<size_t>(index)];
    if (node.mesh < 0) continue;
    PlacedMesh placed;
    if (std::string error = place_mesh(model, shown.posed, index, placed); !error.empty()) return error;
    std::vector<Mat4d> instances;
    if (std::string error = read_instances(model, node.instances, instances); !error.empty()) return error;
    if (instances.empty()) instances.emplace_back();
    placements += instances.size();
    if (placements > kMost) return fmt::format("/nodes/{}: places meshes more than {} times in all", index, kMost);
    DrawnMesh drawn{index, node.mesh, std::move(placed.pose), {}};
    for (const Mat4d& instance : instances) {
      const Mat4d to_root = instance * placed.to_root;
      if (is_placeable(to_root)) drawn.to_root.push_back(to_root);
      else ++unplaceable;
    }
    out.push_back(std::move(drawn));
  }
  return {};
}

}  // namespace whit::gltf
