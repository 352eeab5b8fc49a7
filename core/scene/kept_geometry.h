// Meshes that stay built from one build of a scene to the next, for previews: a scene that changes here and there is
// then ready again as fast as what changed.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/accel/accel.h"
#include "core/base/mesh_attributes.h"
#include "core/base/render_space.h"
#include "core/scene/scene.h"

namespace whit {

/// A mesh in a space of its own, which does not depend on where it or the camera stands.
struct KeptMesh {
  std::shared_ptr<const Mesh> mesh;  ///< In `space`.
  std::shared_ptr<BuiltMesh> built;
  RenderSpace space;
  Box3d bounds;                                   ///< In object space.
  size_t degenerate = 0;                          ///< Triangles that were left out.
  Diagnostics said = {};                          ///< When it was read.
  std::shared_ptr<const MeshSource> source = {};  ///< Whose identity is in the key, which names it as long as it lives.
};

/// Given to builds one after another by BuildOptions::kept. Large meshes of those are instances, each of its own: the
/// picture is another build's but for rounding, except that surfaces of different meshes that lie in one another are not
/// looked for (core/scene/coincidence.h), and that triangles which are huge beside what is near them
/// (core/scene/huge.h) are floats if they were not found to be huge when their mesh was built.
class KeptGeometry {
 public:
  /// Smaller meshes are as soon built as kept.
  static constexpr size_t kLeast = 2000;

  const std::shared_ptr<AccelDevice>& device() const { return device_; }

  /// A build begins: what is not asked for until the next begins is forgotten then.
  void begin();

  /// What was kept under a key; null when nothing was. Thread-safe, as put() is.
  std::shared_ptr<const KeptMesh> find(const std::string& key);
  void put(const std::string& key, std::shared_ptr<const KeptMesh> mesh);

  /// Forgets all.
  void clear() { meshes_.clear(); }

  /// How many meshes the latest build found, and how many it had to build.
  int found() const { return found_; }
  int built() const { return built_; }

 private:
  struct Entry {
    std::shared_ptr<const KeptMesh> mesh;
    bool used = true;
  };
  std::shared_ptr<AccelDevice> device_ = make_accel_device();
  std::mutex mutex_;
  std::map<std::string, Entry> meshes_;
  int found_ = 0, built_ = 0;
};

/// Equal for shapes that have the same mesh in object space, by all that their statements say, and by size and time of
/// the files they name (relative to `folder`). "" where that cannot be known.
std::string mesh_key(const ShapeDescription& shape, const std::string& folder, const MeshAttributes& attributes);

}  // namespace whit
