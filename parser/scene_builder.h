// The state machine behind the statements: graphics state and scopes in, SceneDescriptions out.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "parser/models.h"
#include "parser/reporter.h"
#include "parser/scene_description.h"
#include "parser/source.h"
#include "parser/statements.h"

namespace whit {

/// Applies statements one by one. The table in statements.cpp names a member function for each directive.
class SceneBuilder {
 public:
  /// `folder` is the absolute folder of the main file.
  SceneBuilder(const Sources& sources, Reporter& reporter, std::string folder, const ModelReader* models = nullptr);

  /// Does what a statement asks for, or reports why it cannot.
  void apply(Statement& statement);

  struct IncludeRequest {
    std::string path;          ///< As the file gives it.
    SourcePos where;           ///< The string with the path.
    ParameterList parameters;  ///< For the last statement of that file; texture names are unresolved.
  };
  /// The file the last statement wants read now, if it was an Include.
  std::optional<IncludeRequest> take_include();

  /// The statement that places a model, if the last one did and models are read. It made no shape.
  bool take_model() { return std::exchange(places_model_, false); }
  bool is_under_emission() const { return state_.area_light >= 0; }

  /// Whether the statements from here on are of a model's text, which may name what is attached.
  void set_in_model(bool in_model) { in_model_ = in_model; }

  /// The object whose definition is being read, null outside of one.
  const ObjectDescription* open_object() const {
    return current_object_ < 0 ? nullptr : &scenes_.back().objects[static_cast<size_t>(current_object_)];
  }

  /// How many worlds have begun.
  size_t worlds() const { return scenes_.size(); }

  /// Says that an Include in the open object, which is never placed, is not followed.
  void leave_unread(std::string path, SourcePos where);

  /// True when something looks wrong that may be right with what was left unread.
  bool needs_unread() const { return needs_unread_; }

  /// Reports what is missing at the end of the main file.
  void finish(uint32_t main_file);

  /// The scenes found, one for each WorldBegin.
  std::vector<SceneDescription> take_scenes() { return std::move(scenes_); }

  // One handler a directive.
  void identity(Statement& s);
  void translate(Statement& s);
  void scale(Statement& s);
  void rotate(Statement& s);
  void look_at(Statement& s);
  void transform(Statement& s);
  void concat_transform(Statement& s);
  void coordinate_system(Statement& s);
  void coord_sys_transform(Statement& s);
  void active_transform(Statement& s);
  void transform_times(Statement& s);
  void accelerator(Statement& s);
  void camera(Statement& s);
  void film(Statement& s);
  void pixel_filter(Statement& s);
  void integrator(Statement& s);
  void sampler(Statement& s);
  void make_named_medium(Statement& s);
  void medium_interface(Statement& s);
  void include(Statement& s);
  void begin_world(Statement& s);
  void end_world(Statement& s);
  void begin_attribute(Statement& s);
  void end_attribute(Statement& s);
  void begin_transform(Statement& s);
  void end_transform(Statement& s);
  void begin_object(Statement& s);
  void end_object(Statement& s);
  void object_instance(Statement& s);
  void reverse_orientation(Statement& s);
  void texture(Statement& s);
  void material(Statement& s);
  void make_named_material(Statement& s);
  void named_material(Statement& s);
  void light_source(Statement& s);
  void area_light_source(Statement& s);
  void shape(Statement& s);

 private:
  /// What TransformBegin saves.
  struct TransformState {
    TransformPair ctm;
    bool start_active = true, end_active = true;
  };

  /// What AttributeBegin saves beside the transforms, but for the names in scope.
  struct GraphicsState {
    bool reverse_orientation = false;
    int material = 0;
    int area_light = -1;
  };

  enum class BlockKind : uint8_t { Attribute, Transform, Object };

  struct BlockBegin {
    BlockKind kind;
    SourcePos where;
  };
  struct SavedTransforms {
    BlockBegin begin;
    TransformState state;
  };
  struct SavedGraphics {
    BlockBegin begin;
    GraphicsState state;
    size_t definitions;  ///< How many of definitions_ there were before.
    int block;           ///< Of the graphics state around it.
  };

  /// An end that took what the begin of another kind of block had saved, and what it had to do with.
  struct Crossing {
    BlockKind kind;  ///< Of the end.
    SourcePos where;
    BlockBegin took;
  };
  using Crossings = std::vector<Crossing>;

  using Names = std::unordered_map<std::string, int>;

  /// A name defined in an open block, and what it meant before (-1: nothing).
  struct Definition {
    Names* names;
    std::string name;
    int before;
  };

  bool allowed(const Statement& s);
  static bool matters_to_object_alone(const StatementRow& row);
  void change_ctm(const Statement& s, const Mat4d& m, bool concatenate);
  int current_transform(const Statement& s, bool warn_animated);
  int intern(const TransformPair& pair);
  Entity entity(Statement& s, size_t name_index = 0);
  bool take_type(Statement& s, Entity& out);
  void resolve_textures(ParameterList& list);
  template <class T>
  std::shared_ptr<const T> take_attachment(ParameterList& list);
  void add_material(Entity made, std::string name);
  void warn_no_material(const std::string& name, SourcePos where, const std::string& instead);
  void define(Names& names, const std::string& name, int index);
  void save_transforms(BlockBegin begin);
  void save_graphics(BlockBegin begin);
  void return_transforms(BlockKind kind, SourcePos end);
  void return_graphics(BlockKind kind, SourcePos end);
  bool alike(const Crossings& open, BlockKind a, BlockKind b) const;
  void note_crossing(Crossings& open, BlockKind kind, SourcePos end, const BlockBegin& took);
  void report_unmatched(Crossings& open, BlockKind kind, SourcePos end);
  void report_end_without_begin(BlockKind kind, SourcePos end, SourcePos innermost);
  void report_open_blocks(const std::string& before);
  void resolve_media();
  void close_world(const std::string& before);
  SceneDescription& scene() { return in_world_ ? scenes_.back() : options_; }

  const Sources& sources_;
  Reporter& reporter_;
  const ModelReader* const models_;

  bool in_world_ = false;
  bool world_missing_reported_ = false;
  SceneDescription options_;  ///< What was said before WorldBegin.
  TransformPair camera_transform_;
  std::vector<SceneDescription> scenes_;

  // Two stacks, as in pbrt-v3: AttributeBegin and ObjectBegin push on both, TransformBegin on the first alone, and an end
  // takes what lies on top, whichever kind of block put it there.
  TransformState transforms_;
  GraphicsState state_;
  std::vector<SavedTransforms> saved_transforms_;
  std::vector<SavedGraphics> saved_graphics_;
  Crossings crossed_transforms_, crossed_graphics_;  ///< Those whose other half is still to come.
  Names float_textures_, spectrum_textures_, named_materials_, objects_;
  std::vector<Definition> definitions_;
  struct CoordinateSystem {
    TransformPair ctm;
    int described = -1;  ///< Index into SceneDescription::coordinate_systems; -1 for "camera" and "world".
  };
  std::unordered_map<std::string, CoordinateSystem> coordinate_systems_;
  int block_ = 0, last_block_ = 0;  ///< TextureDescription::block, and the highest number so far.
  int current_object_ = -1;
  size_t nested_objects_ = 0;     ///< ObjectBegins in the object that were errors, and have yet to end.
  bool object_has_gaps_ = false;  ///< A file included in it was left unread.
  bool needs_unread_ = false;     ///< Something looks wrong that may be right with such files.
  int warned_area_light_ = -1;
  std::optional<IncludeRequest> include_;
  bool places_model_ = false;
  bool in_model_ = false;
};

}  // namespace whit
