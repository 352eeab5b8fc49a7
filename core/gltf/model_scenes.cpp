// Scenes and nodes, and what hangs on nodes but meshes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/gltf/model_parts.h"

namespace whit::gltf {
namespace {

Vec3d vector_of(const std::vector<double>& v, const Vec3d& otherwise) {
  return v.size() == 3 ? Vec3d(v[0], v[1], v[2]) : otherwise;
}

std::array<double, 4> unit_quaternion(const std::vector<double>& q) {
  if (q.size() != 4) return {0, 0, 0, 1};
  // Scaled first: the squares of what a double holds may be infinite.
  const double most = std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2]), std::abs(q[3])});
  double sum = 0;
  for (const double x : q) sum += (x / most) * (x / most);
  // One that is written in floats keeps its digits.
  if (most <= 1 && std::abs(sum * most * most - 1) < 1e-14) return {q[0], q[1], q[2], q[3]};
  const double length = std::sqrt(sum);
  return {q[0] / most / length, q[1] / most / length, q[2] / most / length, q[3] / most / length};
}

GpuInstances instances_of(const tinygltf::Node& from) {
  const tinygltf::Value* extension = member(from.extensions, "EXT_mesh_gpu_instancing");
  const tinygltf::Value* attributes = extension ? member(*extension, "attributes") : nullptr;
  if (!attributes) return {};
  return {integer(*attributes, "TRANSLATION", -1), integer(*attributes, "ROTATION", -1),
          integer(*attributes, "SCALE", -1)};
}

Node node_of(const tinygltf::Node& from) {
  Node to;
  to.name = from.name;
  to.children = from.children;
  to.mesh = from.mesh, to.camera = from.camera, to.skin = from.skin;
  if (const tinygltf::Value* light = member(from.extensions, "KHR_lights_punctual"))
    to.light = integer(*light, "light", -1);
  if (from.matrix.size() == 16) {
    // Column by column for column vectors is row by row for row vectors.
    Mat4d m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = from.matrix[static_cast<size_t>(i)];
    // Which it is but for rounding.
    for (int i = 0; i < 4; ++i) m[i][3] = i == 3 ? 1 : 0;
    to.matrix = m;
  }
  to.translation = vector_of(from.translation, to.translation);
  to.scale = vector_of(from.scale, to.scale);
  to.rotation = unit_quaternion(from.rotation);
  to.weights = from.weights;
  to.instances = instances_of(from);
  return to;
}

Animation animation_of(const tinygltf::Animation& from) {
  Animation to;
  to.name = from.name;
  for (const tinygltf::AnimationChannel& channel : from.channels) {
    using Path = AnimationChannel::Path;
    using Interpolation = AnimationChannel::Interpolation;
    // Channels of extensions have another path, or no node.
    static constexpr std::pair<const char*, Path> kPaths[] = {{"translation", Path::Translation},
                                                              {"rotation", Path::Rotation},
                                                              {"scale", Path::Scale},
                                                              {"weights", Path::Weights}};
    const auto path = std::find_if(std::begin(kPaths), std::end(kPaths),
                                   [&](const auto& p) { return channel.target_path == p.first; });
    if (path == std::end(kPaths) || channel.target_node < 0) continue;
    const tinygltf::AnimationSampler& sampler = from.samplers[static_cast<size_t>(channel.sampler)];
    const Interpolation how = sampler.interpolation == "STEP"          ? Interpolation::Step
                              : sampler.interpolation == "CUBICSPLINE" ? Interpolation::CubicSpline
                                                                       : Interpolation::Linear;
    to.channels.push_back({channel.target_node, path->second, how, sampler.input, sampler.output});
  }
  return to;
}

Camera camera_of(const tinygltf::Camera& from) {
  Camera to;
  to.name = from.name;
  to.perspective = from.type == "perspective";
  to.yfov = from.perspective.yfov, to.aspect = from.perspective.aspectRatio;
  to.xmag = from.orthographic.xmag, to.ymag = from.orthographic.ymag;
  return to;
}

Light light_of(const tinygltf::Light& from) {
  Light to;
  to.name = from.name;
  to.type = from.type == "directional" ? Light::Type::Directional
            : from.type == "spot"      ? Light::Type::Spot
                                       : Light::Type::Point;
  to.color = vector_of(from.color, to.color);
  to.intensity = from.intensity;
  to.inner_cone = from.spot.innerConeAngle, to.outer_cone = from.spot.outerConeAngle;
  to.has_range = from.range > 0;
  return to;
}

}  // namespace

void convert_scenes(const tinygltf::Model& from, Model& to) {
  to.default_scene = from.defaultScene;
  for (const tinygltf::Scene& scene : from.scenes) to.scenes.push_back({scene.name, scene.nodes});
  for (const tinygltf::Node& node : from.nodes) to.nodes.push_back(node_of(node));
  for (size_t i = 0; i < to.nodes.size(); ++i)
    for (const int child : to.nodes[i].children) to.nodes[static_cast<size_t>(child)].parent = static_cast<int>(i);
  for (const tinygltf::Skin& skin : from.skins) to.skins.push_back({skin.joints, skin.inverseBindMatrices});
  for (const tinygltf::Animation& animation : from.animations) to.animations.push_back(animation_of(animation));
  for (const tinygltf::Camera& camera : from.cameras) to.cameras.push_back(camera_of(camera));
  for (const tinygltf::Light& light : from.lights) to.lights.push_back(light_of(light));
}

}  // namespace whit::gltf
