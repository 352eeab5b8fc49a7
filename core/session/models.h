// Models in scenes, and as scenes.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/file_state.h"
#include "core/gltf/describe.h"
#include "parser/models.h"

namespace whit {

/// Whether a file is a glTF model: by its first bytes, or by its name where it is text.
bool is_model_file(const std::string& path);

/// The name of the text that stands for a model (Sources::name()), and whether a name is of such a text.
std::string name_of_model_text(const std::string& model);
bool is_model_text(const std::string& name);

/// Reads the models of a scene file, each once. What is read refers to its own memory and outlives this.
class ModelStore final : public ModelReader {
 public:
  explicit ModelStore(bool allow_outside = false) : options_{allow_outside} {}

  void begin() override;
  std::optional<ModelStatements> read(const ModelRequest& request, Diagnostics& said) override;
  std::shared_ptr<const Attachment> attachment(const std::string& name) const override;

  /// For another reading of the scene: forgets the models of which a file has changed since, those with errors, and those
  /// that the last reading did not ask for. False when there were any. Attachments that were handed out stay what they are.
  bool refresh();

  /// A whole scene that shows a model; nothing after errors.
  std::optional<gltf::Description> scene_of(const std::string& path, const gltf::Selection& selection,
                                            Diagnostics& said);

  /// The files that were asked for, whether they could be read or not.
  std::vector<std::string> paths() const;
  /// What people may want to know of the models that were read: "car.glb: occlusion maps are not used".
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Loaded {
    std::shared_ptr<const gltf::Model> model;  ///< Null when there is an error.
    Diagnostics said;
    bool reported = false;  ///< Since begin().
    bool used = true;       ///< Since refresh().
    std::map<std::string, FileState> files;
  };
  std::shared_ptr<const gltf::Model> load(const std::string& path, const std::string& shown, SourcePos where,
                                          Diagnostics& said);
  void note(const std::string& shown, const gltf::Description& description);

  gltf::LoadOptions options_;
  std::map<std::string, Loaded> loaded_;
  std::map<std::string, std::shared_ptr<const Attachment>> attachments_;
  std::vector<std::string> notes_;
  int placed_ = 0;
};

}  // namespace whit
