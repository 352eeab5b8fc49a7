// A shape that stands for a whole model, and what of the model it asks for.
#pragma once

#include <optional>
#include <string>

#include "core/plugin/shape.h"

namespace whit {

/// What a statement says of a model. Names may be numbers, from 0; "" is the model's own choice.
struct ModelChoice {
  FileName file;
  std::string scene, node;
  int variant = -1;           ///< Of its materials; -1: none.
  std::optional<float> time;  ///< Seconds of its animations; none: as it stands without them.
  bool materials = true;      ///< Its own; otherwise the current ones.
  bool lights = false;        ///< Its lights too.
};

/// Its statement is replaced by those that stand for the model when a scene is read (core/session/models.h).
class ModelShape : public MeshShape {
 public:
  virtual ModelChoice choice() const = 0;
};

}  // namespace whit
