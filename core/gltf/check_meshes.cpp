#include <fmt/format.h>

#include "core/gltf/check_parts.h"

namespace whit::gltf {
namespace {

using Need = Item::Need;

class MeshCheck {
 public:
  MeshCheck(CheckContext& c, size_t mesh) : c_(c), targets_(c.mesh_targets[mesh]) {}

  void check(const Item& mesh) {
    if (!mesh.has("primitives")) mesh.error_at("primitives", "is missing");
    mesh.objects("primitives", [&](const Item& primitive, size_t i) { check_primitive(primitive, i); });
    const std::vector<double> weights = mesh.any_numbers("weights", kCoordinate);
    if (mesh.has("weights") && weights.size() != targets_) {
      mesh.error_at("weights", fmt::format("has {} numbers for {} morph targets", weights.size(), targets_));
    }
  }

 private:
  void check_primitive(const Item& primitive, size_t i) {
    primitive.integer("mode", 0, 6);
    primitive.index("material", c_.counts.materials);
    check_accessor(c_, primitive, "indices", wanted_of_indices());
    vertices_ = 0;
    if (!primitive.has("attributes")) primitive.error_at("attributes", "is missing");
    primitive.object("attributes", [&](const Item& attributes) { check_attributes(attributes); });
    size_t targets = 0;
    primitive.objects("targets", [&](const Item& target, size_t) {
      ++targets;
      target.members([&](const Item& member, const std::string& name) { check_attribute(member, name, true); });
    });
    if (i == 0) targets_ = targets;
    else if (targets != targets_)
      primitive.error_at("targets",
                         fmt::format("has {} morph targets, and the mesh's first primitive {}", targets, targets_));
    primitive.object("extensions", [&](const Item& extensions) {
      extensions.object("KHR_draco_mesh_compression", [&](const Item& draco) { check_draco(draco, primitive); });
      extensions.object("KHR_materials_variants", [&](const Item& variants) { check_variants(variants); });
    });
  }

  void check_attributes(const Item& attributes) {
    attributes.members([&](const Item& member, const std::string& name) { check_attribute(member, name, false); });
    for (int set = 0; set < 8; ++set) {
      const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
      if (attributes.has(joints.c_str()) == attributes.has(weights.c_str())) continue;
      attributes.error(fmt::format("has {}, and not the other of {} and {}",
                                   attributes.has(joints.c_str()) ? joints : weights, joints, weights));
    }
  }

  /// All of a primitive have as many elements.
  void check_attribute(const Item& member, const std::string& name, bool morph_target) {
    const Wanted* wanted = wanted_of(name, morph_target);
    const int accessor = wanted ? check_accessor(c_, member, *wanted) : member.as_index(c_.counts.accessors);
    if (accessor < 0) return;
    const Accessor& a = c_.buffers.accessors[static_cast<size_t>(accessor)];
    const uint64_t count = a.count;
    if (count == 0) return;
    check_alignment(member, a);
    if (vertices_ == 0) vertices_ = count;
    if (count != vertices_)
      member.error(fmt::format("names accessor {} of {} elements, and the primitive's others have {}", accessor, count,
                               vertices_));
  }

  /// Graphics cards want it so.
  void check_alignment(const Item& member, const Accessor& a) {
    if (a.view < 0 || c_.unaligned) return;
    const uint64_t stride = c_.buffers.views[static_cast<size_t>(a.view)].stride;
    if (a.offset % 4 == 0 && (stride != 0 ? stride : a.element_size()) % 4 == 0) return;
    c_.unaligned = true;
    member.problems().excused(member.place(),
                              "names an accessor whose elements do not begin at multiples of four bytes",
                              "it is read all the same");
  }

  void check_draco(const Item& draco, const Item& primitive) {
    draco.index("bufferView", c_.counts.views, Need::Required);
    if (!draco.has("attributes")) draco.error_at("attributes", "is missing");
    draco.object("attributes", [&](const Item& attributes) {
      attributes.members([&](const Item& id, const std::string& name) {
        id.as_integer(0, 0x7fffffff);
        const Json& plain = primitive.value().value("attributes", Json::object());
        if (!plain.contains(name))
          id.error(fmt::format("{} is not among the primitive's attributes", shown_text(name)));
      });
    });
    const auto mode = primitive.value().find("mode");
    if (mode != primitive.value().end() && *mode != 4 && *mode != 5)
      primitive.error_at("mode", "must be 4 or 5 of what is compressed by Draco");
  }

  void check_variants(const Item& variants) {
    variants.objects("mappings", [&](const Item& mapping, size_t) {
      mapping.index("material", c_.counts.materials, Need::Required);
      mapping.indices("variants", c_.counts.variants, Need::Required);
    });
  }

  CheckContext& c_;
  size_t& targets_;
  uint64_t vertices_ = 0;
};

}  // namespace

void check_meshes(CheckContext& c) {
  c.mesh_targets.resize(c.counts.meshes.count);
  c.root.objects("meshes", [&](const Item& mesh, size_t i) { MeshCheck(c, i).check(mesh); });
  c.root.object("extensions", [&](const Item& extensions) {
    extensions.object("KHR_materials_variants", [&](const Item& e) {
      e.objects("variants", [](const Item& variant, size_t) { variant.text("name", Need::Required); });
    });
  });
}

}  // namespace whit::gltf
