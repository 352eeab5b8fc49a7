// The file that a checkpoint is: what it is of, the sums of a film, a checksum. It appears complete or not at all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/mapped_file.h"
#include "core/render/film_render.h"
#include "core/session/render_identity.h"

namespace whit {

/// How the picture was asked for: enough to ask for it again.
struct RenderCommand {
  std::string folder;              ///< In which the command ran.
  std::string scene;               ///< As it named the scene.
  std::vector<std::string> words;  ///< Of its arguments, those that the picture depends on, the scene among them.
};

/// What stands before the sums.
struct CheckpointHead {
  bool complete = false;  ///< The render has ended.
  RenderIdentity identity;
  RenderCommand command;
  FilmPart part;

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);
};

/// A checkpoint that is there.
struct CheckpointFile {
  explicit CheckpointFile(const std::string& path);
  bool is_checkpoint() const;

  const MappedFile file;
  CheckpointHead head;
  std::string_view state;  ///< FilmRender::save()
  std::string problem;     ///< "" where it is one and whole.
};

/// Writes one in the place of what was there; why it could not, or "".
std::string write_checkpoint(const std::string& path, const CheckpointHead& head, const FilmRender& film);

}  // namespace whit
