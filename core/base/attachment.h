// What a statement has beside its parameters where no text made it: a mesh or a picture inside of a model's file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace whit {

struct MeshData;

/// The base of what can be attached; Plugin::attach() gets it.
class Attachment {
 public:
  Attachment() = default;
  virtual ~Attachment() = default;
  Attachment(const Attachment&) = delete;
  Attachment& operator=(const Attachment&) = delete;
};

/// A mesh that is read when the scene is built, if it is live at all. Thread-safe.
class MeshSource : public Attachment {
 public:
  /// Fills in `out`, in object space; no value of it is NaN or infinite, and all indices are valid. Returns "", or why
  /// there is none, with the file and the place in it: "model.glb: /meshes/3/primitives/0: ...".
  virtual std::string read(MeshData& out) const = 0;

  /// Equal for sources whose meshes are the same, as long as one of them lives; "" where that is not known.
  virtual std::string identity() const { return {}; }
};

/// An encoded picture in memory (PNG, JPEG, WebP, ...).
class PictureBytes : public Attachment {
 public:
  std::string name;                   ///< For messages: "model.glb: /images/3".
  std::span<const uint8_t> bytes;     ///< The file that it would be.
  std::shared_ptr<const void> owner;  ///< Keeps them where they are.
};

}  // namespace whit
