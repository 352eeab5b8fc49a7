// From a file to pictures: parse, plan, build, render and write (core/session/output.h), each step written once. Whoever
// renders (the command, the benchmark, tests, a program that has whit as a library) takes one step after another and
// decides in between what to do about what was said.
//
// A step returns what it made with all that was said of it and the time it took. It neither prints nor exits. Where
// `said` has errors, what was made is what is usable, and may be taken on; ErrorClass says what kind of error it is.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/stopwatch.h"
#include "core/gltf/describe.h"
#include "core/image/texture_store.h"
#include "core/render/render.h"
#include "core/scene/kept_geometry.h"
#include "core/scene/scene.h"
#include "parser/parse.h"

namespace whit {

class ModelStore;

/// A parsed file with its text, to which all that is made of it refers: it must outlive that.
struct ParsedFile {
  std::unique_ptr<Sources> sources = std::make_unique<Sources>();
  std::vector<SceneDescription> worlds;  ///< One for each WorldBegin.
  uint64_t bytes = 0;                    ///< Of text, included files counted each time.
  std::vector<std::string> models;       ///< The files of models that it shows.
  std::vector<std::string> notes;        ///< What people may want to know of how models are shown.
  Diagnostics said;
  Elapsed elapsed;
};
struct ReadOptions {
  bool read_unplaced = false;    ///< ParseOptions::read_unplaced.
  gltf::Selection model = {};    ///< Of a model's file that is read as a scene; of no other may anything be selected.
  bool allow_outside = false;    ///< Models may name files outside of their folder.
  ModelStore* models = nullptr;  ///< Has them from earlier readings; null: they are read for this one.
  bool copy_files = false;       ///< Sources::copy_files().
  /// Texts that stand for files, by path, as Sources::stand_in().
  std::vector<std::pair<std::string, std::string>> unsaved = {};
};
/// A .pbrt file, or a glTF model, of which a scene is made.
ParsedFile read_scene_file(const std::string& path, const ReadOptions& options = {});
/// Text that is no file, under the name that messages show; what it includes is looked for in the current folder.
ParsedFile read_scene_text(const std::string& name, std::string text, const ReadOptions& options = {});

/// One world of a file, its statements bound, and what the picture needs of them. Nothing is read yet.
struct PlannedWorld {
  BoundScene bound;
  EffectPlan plan;
  Diagnostics said;
  Elapsed elapsed;
};
PlannedWorld plan_world(const SceneDescription& world, const Sources& sources, const PlanOptions& options = {});

/// Everything wrong with a file: what parsing found, what planning its worlds finds in addition, and what `further`
/// finds in each. For files with mistakes, where nothing else will be done with the worlds.
Diagnostics all_problems(const ParsedFile& file, const std::function<Diagnostics(PlannedWorld)>& further = {});

/// A world that can be traced, as often as one likes.
struct BuiltWorld {
  std::shared_ptr<TextureStore> textures;
  std::unique_ptr<Scene> scene;  ///< Null when nothing can be rendered.
  bool keep_going = false;       ///< BuildOptions::keep_going, for render_world().
  Diagnostics said;
  Elapsed elapsed;
};
BuiltWorld build_world(PlannedWorld planned, const BuildOptions& options = {},
                       size_t texture_bytes = TextureStore::kDefaultMemory);

/// What stays from one reading and building of a scene to the next, for previews: models, large meshes, and decoded
/// textures, as long as their files stay what they are. One build at a time, and none while a picture is made of an
/// earlier one.
struct KeptParts {
  KeptParts();
  ~KeptParts();
  std::unique_ptr<ModelStore> models;
  KeptGeometry geometry;
  std::shared_ptr<TextureStore> textures;
};
/// read_scene_file() with them; `options.models` is set here.
ParsedFile reread_scene_file(const std::string& path, ReadOptions options, KeptParts& kept);
/// build_world() with them; `options.kept` is set here.
BuiltWorld rebuild_world(PlannedWorld planned, BuildOptions options, KeptParts& kept,
                         size_t texture_bytes = TextureStore::kDefaultMemory);

/// Another number of samples per pixel (as the sampler rounds it) and another seed, for what is rendered from now on: the
/// picture is that of a world that was built with them. Not while the world is being rendered.
Diagnostics set_samples(BuiltWorld& world, int samples_per_pixel, uint32_t seed);

/// Another place of the camera, and another size of the picture, likewise. What was built stays as it is: a camera that
/// goes very far from where it stood has the fewer digits there.
void set_camera(BuiltWorld& world, const Mat4d& world_to_camera);
Diagnostics set_resolution(BuiltWorld& world, Vec2i resolution);

/// A picture, with what was done for it. A texture that cannot be read ends the render early, unless the world was built
/// to keep going.
struct RenderedWorld {
  RenderResult result;
  Diagnostics said;
  Elapsed elapsed;
};
RenderedWorld render_world(const BuiltWorld& world, RenderOptions options = {});

}  // namespace whit
