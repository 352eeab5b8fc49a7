// A model as the statements of a scene: what a Shape "gltf" stands for, what is rendered of a model's file, and what an
// import writes, which are the same but for where meshes and pictures are.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/attachment.h"
#include "core/gltf/model.h"

namespace whit::gltf {

/// What of a model is wanted. Names may be numbers, from 0; "" is the file's own choice.
struct Selection {
  std::string scene, node, variant, camera;
  std::optional<double> time;  ///< Seconds of the animations; else as the file has the nodes.
};

/// Where the meshes and pictures of statements are.
class Assets {
 public:
  virtual ~Assets() = default;
  /// What stands behind `Shape`: ` "gltf" "string attached" "3"`. `name` is what a file of it may be called.
  virtual std::string mesh(std::shared_ptr<const MeshSource> source, const std::string& name) = 0;
  /// The parameter that names a picture: ` "string filename" "wood.png"`.
  virtual std::string picture(const Image& image, const std::string& name) = 0;
};

/// Statements, and what people may want to know of how the model is shown: sentences, each named once.
struct Description {
  std::string text;
  std::vector<std::string> notes;
};

struct WorldOptions {
  Selection selection;
  bool materials = true;    ///< Else shapes wear the current one.
  bool overridden = false;  ///< Shapes get parameters of the scene's, which go before those of the materials.
  bool in_scene = false;    ///< The current transform is that of a scene: objects are not to have it twice.
  bool lights = false;
  bool objects = true;  ///< Meshes that are used more than once become objects; not where an object is open.
  std::string prefix;   ///< Before all names.
};

/// The statements of a world that place the model under the current transform; behind them the graphics state is
/// another. Errors of the selection and of numbers that have to be read go to `diagnostics`, at `where`; nothing is returned then.
std::optional<Description> describe_world(const std::shared_ptr<const Model>& model, const WorldOptions& options,
                                          Assets& assets, SourcePos where, Diagnostics& diagnostics);

/// A whole scene that shows the model: by its camera or one that frames it, in its lights or under a gradient sky.
std::optional<Description> describe_scene(const std::shared_ptr<const Model>& model, const Selection& selection,
                                          Assets& assets, Diagnostics& diagnostics);

}  // namespace whit::gltf
