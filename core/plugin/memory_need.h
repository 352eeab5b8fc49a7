// How much memory a plugin is going to take, told before anything of it is read or made: by counts of its parameters and by
// headers of its files.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/mesh_attributes.h"

namespace whit {

/// What is needed. Zeros for what a plugin has not, and for files that cannot be read: that is for others to say.
struct MemoryNeed {
  // A mesh, as MeshShape::build_mesh() makes it.
  uint64_t vertices = 0, triangles = 0;
  uint64_t floats = 0;        ///< Of each vertex, beside where it is: 3 of a normal, 2 of surface parameters ...
  uint64_t mapped = 0;        ///< Bytes of a file that stays mapped, those that it is read from.
  bool owns_vertices = true;  ///< False where these stay in the description.

  // Curves, as CurveShape::build_curves() makes them.
  uint64_t segments = 0;
  uint64_t pieces = 1;  ///< That each is traced in.
  bool ribbon = false;

  // Pictures.
  uint64_t texels = 0;     ///< Bytes of all levels of an image texture, which its cache may hold.
  std::string picture{};   ///< Equal for those that share them.
  uint64_t light_map = 0;  ///< Bytes that a map of light takes for good.

  uint64_t table = 0;   ///< Bytes that a material keeps of a file of its own.
  uint64_t making = 0;  ///< Bytes beside all that, at most, while it is read or made.
};

/// What plugins are beside what they are, and attachments of theirs, that may take much.
class NeedsMemory {
 public:
  virtual ~NeedsMemory() = default;
  /// After binding, which is before Plugin::read(). Of meshes what `attributes` asks for.
  virtual MemoryNeed memory_need(const MeshAttributes& attributes) const = 0;
};

}  // namespace whit
