// A parsed scene: what the statements of a .pbrt file ask for, as plain data in file order.
//
// Transforms are accumulated, scopes are resolved, names of textures, materials and objects are turned
// into indices. Nothing is instantiated and no plugin name or parameter is checked yet (core/scene does).
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/attachment.h"
#include "core/base/diagnostics.h"
#include "core/base/parameter.h"
#include "core/base/vec.h"

namespace whit {

/// An object-to-world (or world-to-camera) matrix at the start and the end of the transform times.
struct TransformPair {
  Mat4d start, end;
  int singular = -1;  ///< While parsing: index into SceneDescription::singular where it cannot be inverted.
  bool animated() const { return start != end; }
};

/// The transforms of a scene. Those that do not move, which is nearly all, take one matrix.
class TransformList {
 public:
  size_t size() const { return entries_.size(); }
  TransformPair operator[](size_t i) const { return {matrices_[entries_[i].start], matrices_[entries_[i].end]}; }
  void add(const TransformPair& pair) {
    const auto start = static_cast<uint32_t>(matrices_.size());
    matrices_.push_back(pair.start);
    if (pair.animated()) matrices_.push_back(pair.end);
    entries_.push_back({start, static_cast<uint32_t>(matrices_.size() - 1)});
  }

 private:
  struct Entry {
    uint32_t start, end;  // indices into matrices_
  };
  std::vector<Mat4d> matrices_;
  std::vector<Entry> entries_;
};

/// A statement that names a plugin: `Shape "sphere" "float radius" 1`.
struct Entity {
  std::string plugin;   ///< "sphere"; "" when the file gives none.
  SourcePos where;      ///< The directive.
  SourcePos plugin_at;  ///< The plugin's name.
  ParameterList params;
};

struct TextureDescription : Entity {
  std::string name;
  bool spectrum = false;                        ///< "spectrum"/"color" texture, else "float".
  std::shared_ptr<const PictureBytes> picture;  ///< Instead of a file, where a model brought it.
  int transform = 0;                            ///< CTM (texture to world) at the statement.
  int block = 0;  ///< Where the name is known: the innermost block, numbered; 0 is the world.
};

struct MaterialDescription : Entity {
  std::string name;  ///< Of MakeNamedMaterial; "" for Material.
  int block = 0;     ///< Of a named one: as TextureDescription::block.
  /// Named materials known at this statement, by parameters of type string that a mix material uses:
  /// (name, index) of every named material in scope whose name occurs as a string value here. 0, the default matte,
  /// stands in for those that a mix names and that are not there.
  std::vector<std::pair<std::string, int>> named;
};

struct MediumDescription : Entity {  ///< Without a plugin it has no type, and is no medium.
  std::string name;
};

struct LightDescription : Entity {
  int transform = 0;
};

struct ShapeDescription : Entity {
  int transform = 0;
  int material = 0;     ///< Index into materials (0 is the default matte).
  int area_light = -1;  ///< Index into area_lights.
  int object = -1;      ///< Index into objects when inside ObjectBegin/End, -1 for the world.
  bool reverse_orientation = false;
  std::shared_ptr<const MeshSource> mesh;  ///< Of a shape that a model brought.
};

struct ObjectDescription {
  std::string name;
  SourcePos where;
};

struct InstanceDescription {
  int object = 0;
  int transform = 0;
  SourcePos where;
};

/// A CoordinateSystem, which is known until the world ends.
struct CoordinateSystemDescription {
  std::string name;
  SourcePos where;
  bool used = false;  ///< Some CoordSysTransform goes back to it.
};

/// A statement that made a matrix which cannot be inverted.
struct SingularTransform {
  std::string statement;  ///< "Scale".
  SourcePos where;
};

/// A file included in the definition of an object that is never placed. Nothing of it is in the description: not its
/// shapes, and neither the lights, coordinate systems and media of the whole world that it may define. Nor is what stands
/// behind it in the object and matters to the object alone, for that may build on the file.
struct UnreadFile {
  std::string path;  ///< As it would have been opened.
  SourcePos where;   ///< The string with the path.
  int object = 0;    ///< Index into objects.
};

/// A MediumInterface that names a medium.
struct MediumUse {
  std::string name;
  SourcePos where;  ///< The name.
  int medium = -1;  ///< Index into media; -1 when the world has none of that name.
};

/// One WorldBegin/End block with the options in force. Options the file does not name have plugin "".
struct SceneDescription {
  Entity camera, film, filter, sampler, integrator, accelerator;
  int camera_transform = 0;  ///< World to camera, the CTM at the Camera statement.
  double time_start = 0, time_end = 1;

  TransformList transforms;  ///< [0] is the identity; others deduplicated against the last used.
  std::vector<SingularTransform> singular;
  std::map<int, int> singular_transforms;  ///< Transforms that cannot be inverted, and who made each so.
  bool is_singular(int transform) const { return singular_transforms.count(transform) > 0; }
  std::vector<TextureDescription> textures;
  /// Names that were used where no texture had them, and what each may have been meant to be.
  std::map<std::string, Remedy> unknown_textures;
  std::vector<MaterialDescription> materials;  ///< [0] is pbrt's default: matte with no parameters.
  std::vector<LightDescription> lights;
  std::vector<Entity> area_lights;
  std::vector<ShapeDescription> shapes;
  std::vector<ObjectDescription> objects;
  std::vector<InstanceDescription> instances;
  std::vector<UnreadFile> unread_files;
  std::vector<MediumDescription> media;  ///< MakeNamedMedium: parsed, not simulated.
  std::vector<MediumUse> media_uses;
  std::vector<CoordinateSystemDescription> coordinate_systems;
  /// The statement of the first medium that the scene puts somewhere; nowhere when there is none.
  SourcePos first_medium() const {
    for (const MediumUse& use : media_uses)
      if (use.medium >= 0 && !media[static_cast<size_t>(use.medium)].plugin.empty())
        return media[static_cast<size_t>(use.medium)].where;
    return {};
  }
  bool has_media() const { return first_medium().known(); }

  std::string folder;  ///< Folder of the main file, absolute: relative asset paths resolve against it.
  SourcePos world_begin;
};

}  // namespace whit
