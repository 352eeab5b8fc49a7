// What the parser has to ask of models, which it knows nothing of: statements as text that stand for a Shape "gltf", and
// the meshes and pictures that these have attached.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/attachment.h"
#include "core/base/diagnostics.h"
#include "core/base/parameter.h"

namespace whit {

/// A Shape statement that names a model.
struct ModelRequest {
  const ParameterList& parameters;  ///< Texture names are unresolved.
  SourcePos where;                  ///< The statement.
  const std::string& folder;        ///< That relative paths start from.
  bool in_object = false;           ///< In ObjectBegin, where no further object can begin.
  bool under_emission = false;      ///< An AreaLightSource is in force.
};

/// What stands for it.
struct ModelStatements {
  std::string name;          ///< Of the text, for messages.
  std::string text;          ///< Statements of a world. They leave the graphics state as it was.
  ParameterList for_shapes;  ///< Parameters of the request that each of their shapes gets.
};

class ModelReader {
 public:
  /// The parameter by which a Texture or Shape of such text, and of no other, names what it has attached.
  static constexpr const char* kAttached = "attached";

  virtual ~ModelReader() = default;

  /// Reading of a scene begins, or begins again: what is said of a model is said once from here on.
  virtual void begin() = 0;

  /// Nothing when the request is wrong, or the model cannot be read; then there is an error in `said`.
  virtual std::optional<ModelStatements> read(const ModelRequest& request, Diagnostics& said) = 0;

  /// What a statement of such text names; null when there is nothing of that name.
  virtual std::shared_ptr<const Attachment> attachment(const std::string& name) const = 0;
};

}  // namespace whit
