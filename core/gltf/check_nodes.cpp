// Scenes, nodes and skins: that nodes make trees, and what hangs on them exists.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/gltf/check_parts.h"

namespace whit::gltf {
namespace {

using Need = Item::Need;

class NodeCheck {
 public:
  explicit NodeCheck(CheckContext& c) : c_(c), parents_(c.counts.nodes.count, -1), children_(c.counts.nodes.count) {
    c.node_mesh.assign(c.counts.nodes.count, -1);
  }

  void check() {
    c_.root.objects("nodes", [&](const Item& node, size_t i) { check_node(node, i); });
    check_trees();
    c_.root.index("scene", c_.counts.scenes);
    c_.root.objects("scenes", [&](const Item& scene, size_t) {
      for (const int root : scene.indices("nodes", c_.counts.nodes)) {
        if (parents_[static_cast<size_t>(root)] < 0) continue;
        scene.error_at("nodes", fmt::format("has node {}, which is a child of node {}", root,
                                            parents_[static_cast<size_t>(root)]));
      }
    });
    c_.root.objects("skins", [&](const Item& skin, size_t) { check_skin(skin); });
  }

 private:
  void check_node(const Item& node, size_t i) {
    const int mesh = node.index("mesh", c_.counts.meshes);
    c_.node_mesh[i] = mesh;
    node.index("camera", c_.counts.cameras);
    node.index("skin", c_.counts.skins);
    check_place(node);
    const size_t weights = node.any_numbers("weights", kCoordinate).size();
    const size_t targets = mesh < 0 ? 0 : c_.mesh_targets[static_cast<size_t>(mesh)];
    if (node.has("weights") && weights != targets)
      node.error_at("weights", fmt::format("has {} numbers for {} morph targets", weights, targets));
    children_[i] = node.indices("children", c_.counts.nodes);
    for (const int child : children_[i]) {
      int& parent = parents_[static_cast<size_t>(child)];
      if (parent >= 0)
        node.error_at("children", fmt::format("has node {}, which is a child of node {} already", child, parent));
      else parent = static_cast<int>(i);
    }
    node.object("extensions", [&](const Item& extensions) {
      extensions.object("KHR_lights_punctual",
                        [&](const Item& e) { e.index("light", c_.counts.lights, Need::Required); });
      extensions.object("EXT_mesh_gpu_instancing", [&](const Item& e) { check_instances(e); });
    });
  }

  void check_place(const Item& node) {
    const std::vector<double> matrix = node.numbers("matrix", 16, kCoordinate);
    const bool also = node.has("translation") || node.has("rotation") || node.has("scale");
    if (node.has("matrix") && also)
      node.problems().excused(node.place("matrix"), "is there beside translation, rotation or scale",
                              "they are ignored");
    constexpr double kTolerance = 1e-5;
    for (const size_t i : {3u, 7u, 11u, 15u}) {
      if (matrix.empty() || std::abs(matrix[i] - (i == 15 ? 1 : 0)) <= kTolerance) continue;
      node.error_at("matrix", "is not that of a rotation, a scale and a translation: its last row is not 0 0 0 1");
      break;
    }
    node.numbers("translation", 3, kCoordinate), node.numbers("scale", 3, kCoordinate);
    const std::vector<double> q = node.numbers("rotation", 4);
    if (!q.empty() && std::all_of(q.begin(), q.end(), [](double x) { return x == 0; }))
      node.error_at("rotation", "is the quaternion 0, which is no rotation");
  }

  void check_instances(const Item& instancing) {
    uint64_t count = 0;
    instancing.object("attributes", [&](const Item& attributes) {
      const std::pair<const char*, const Wanted*> kinds[] = {
          {"TRANSLATION", &floats_of(3)}, {"ROTATION", &fractions_of(4)}, {"SCALE", &floats_of(3)}};
      for (const auto& [name, wanted] : kinds) {
        const int accessor = check_accessor(c_, attributes, name, *wanted);
        if (accessor < 0) continue;
        const uint64_t n = c_.buffers.accessors[static_cast<size_t>(accessor)].count;
        if (count == 0) count = n;
        if (n != count) attributes.error_at(name, fmt::format("has {} elements, and the others {}", n, count));
      }
    });
  }

  /// No node is its own ancestor, and none lies too deep. Nodes with two parents have been reported.
  void check_trees() {
    enum : uint8_t { kNew, kOpen, kDone };
    std::vector<uint8_t> state(parents_.size(), kNew);
    std::vector<int> depth(parents_.size(), 0);
    for (size_t start = 0; start < parents_.size(); ++start) {
      // Up to a root, or to what is known.
      std::vector<size_t> way;
      size_t at = start;
      while (state[at] == kNew) {
        state[at] = kOpen;
        way.push_back(at);
        if (parents_[at] < 0) break;
        at = static_cast<size_t>(parents_[at]);
      }
      if (parents_[at] >= 0 && state[at] == kOpen && std::find(way.begin(), way.end(), at) != way.end()) {
        c_.root.problems().error(fmt::format("/nodes/{}", at), "is its own ancestor");
      }
      for (auto i = way.rbegin(); i != way.rend(); ++i) {
        state[*i] = kDone;
        depth[*i] = parents_[*i] < 0 ? 1 : depth[static_cast<size_t>(parents_[*i])] + 1;
        if (depth[*i] == kMostDepth + 1)
          c_.root.problems().error(fmt::format("/nodes/{}", *i), fmt::format("lies deeper than {} nodes", kMostDepth));
      }
    }
  }

  void check_skin(const Item& skin) {
    const size_t joints = skin.indices("joints", c_.counts.nodes, Need::Required).size();
    if (joints == 0 && skin.has("joints")) skin.error_at("joints", "is empty");
    skin.index("skeleton", c_.counts.nodes);
    const int matrices = check_accessor(c_, skin, "inverseBindMatrices", floats_of(4, 4));
    if (matrices < 0) return;
    const uint64_t count = c_.buffers.accessors[static_cast<size_t>(matrices)].count;
    if (count < joints)
      skin.error_at("inverseBindMatrices", fmt::format("has {} matrices for {} joints", count, joints));
  }

  CheckContext& c_;
  std::vector<int> parents_;
  std::vector<std::vector<int>> children_;
};

}  // namespace

void check_nodes(CheckContext& c) { NodeCheck(c).check(); }

}  // namespace whit::gltf
