// A primitive of a model as what a Shape has attached.
#pragma once

#include <memory>
#include <utility>

#include "core/base/attachment.h"
#include "core/gltf/primitive.h"
#include "core/plugin/memory_need.h"

namespace whit::gltf {

/// Reads the primitive when asked; keeps the model.
class AttachedPrimitive final : public MeshSource, public NeedsMemory {
 public:
  AttachedPrimitive(std::shared_ptr<const Model> model, const Primitive& primitive, Pose pose, const MeshNeeds& needs)
      : model_(std::move(model)), primitive_(primitive), pose_(std::move(pose)), needs_(needs) {}
  std::string read(MeshData& out) const override;
  std::string identity() const override;
  MemoryNeed memory_need(const MeshAttributes& attributes) const override;

 private:
  const std::shared_ptr<const Model> model_;
  const Primitive& primitive_;  ///< In the model.
  const Pose pose_;
  const MeshNeeds needs_;
};

/// What a material (-1: the default) asks of the meshes that wear it; where they wear another, or this one with parameters
/// of the scene's (`other`), whatever that may ask for.
MeshNeeds needs_of(const Model& model, int material, bool other);

}  // namespace whit::gltf
