#include "parser/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parser/lexer.h"
#include "parser/transforms.h"

namespace whit {

namespace {

/// "did you mean" among the names of some maps; nothing once there are so many problems that none is shown any more.
template <class... Maps>
Remedy suggest(const Reporter& reporter, const std::string& name, const Maps&... maps) {
  // Scopes can hold very many names; the search for a near one must not dominate a file full of mistakes.
  constexpr size_t kMost = 2000;
  std::vector<std::string> names;
  const auto add = [&names](const auto& map) {
    for (const auto& [key, value] : map)
      if (names.size() < kMost) names.push_back(key);
  };
  if (reporter.crowded()) return {};
  (add(maps), ...);
  // A hash table has no order; the answer should not depend on that.
  std::sort(names.begin(), names.end());
  return suggestion(name, names);
}

/// What a name stands for: the index of a thing, nothing, or a named material that could not be made.
constexpr int kNoName = -1, kNotMade = -2;

constexpr const char* block_name(int kind) {
  constexpr const char* kNames[] = {"Attribute", "Transform", "Object"};
  return kNames[kind];
}

int look_up(const std::unordered_map<std::string, int>& names, const std::string& name) {
  const auto found = names.find(name);
  return found == names.end() ? kNoName : found->second;
}

Vec3d three(const Statement& s, size_t first) { return {s.numbers[first], s.numbers[first + 1], s.numbers[first + 2]}; }

}  // namespace

SceneBuilder::SceneBuilder(const Sources& sources, Reporter& reporter, std::string folder, const ModelReader* models)
    : sources_(sources), reporter_(reporter), models_(models) {
  options_.folder = std::move(folder);
}

void SceneBuilder::apply(Statement& statement) {
  if (!allowed(statement)) return;
  if (object_has_gaps_ && matters_to_object_alone(*statement.row)) return;
  // An Include's parameters wait for the statement they belong to: textures may be defined before it.
  if (statement.row->handler != &SceneBuilder::include) resolve_textures(statement.parameters);
  (this->*statement.row->handler)(statement);
}

bool SceneBuilder::allowed(const Statement& s) {
  const std::string name(s.row->name);
  if (in_world_ && s.row->block == Block::Options) {
    reporter_.error(s.where, name + " is not allowed inside the world block",
                    s.row->handler == &SceneBuilder::begin_world ? "end the world before with WorldEnd"
                                                                 : "move it before WorldBegin");
    return false;
  }
  if (!in_world_ && s.row->block == Block::World) {
    // Where WorldBegin is missing every statement behind it would be an error; the first says it all.
    const bool end = s.row->handler == &SceneBuilder::end_world;
    if (!world_missing_reported_)
      reporter_.error(s.where, end ? "WorldEnd without WorldBegin" : name + " outside the world block",
                      end ? "" : "it must stand between WorldBegin and WorldEnd; is WorldBegin missing?");
    world_missing_reported_ = true;
    return false;
  }
  return true;
}

/// Whether a statement inside an object definition says something of the shapes there and of nothing else.
bool SceneBuilder::matters_to_object_alone(const StatementRow& row) {
  using B = SceneBuilder;
  constexpr decltype(StatementRow::handler) kThose[] = {
      &B::texture, &B::material, &B::make_named_material, &B::named_material, &B::area_light_source, &B::shape};
  return std::find(std::begin(kThose), std::end(kThose), row.handler) != std::end(kThose);
}

void SceneBuilder::leave_unread(std::string path, SourcePos where) {
  scene().unread_files.push_back({std::move(path), where, current_object_});
  object_has_gaps_ = true;
}

std::optional<SceneBuilder::IncludeRequest> SceneBuilder::take_include() {
  return std::exchange(include_, std::nullopt);
}

void SceneBuilder::finish(uint32_t main_file) {
  if (in_world_) {
    const std::string open = "WorldBegin without WorldEnd: the file ends inside the world block";
    if (reporter_.is_foreign("pbrt-v4")) {
      reporter_.foreign(scenes_.back().world_begin, "pbrt-v4", Severity::Error, open);  // There is no WorldEnd there.
    } else {
      reporter_.error(scenes_.back().world_begin, open, "add WorldEnd at the end");
    }
    close_world("the end of the file");
  } else if (scenes_.empty() && !world_missing_reported_) {
    reporter_.error({main_file, 0}, "no WorldBegin: there is nothing to render",
                    "a scene stands between WorldBegin and WorldEnd");
  }
}

// ---------------------------------------------------------------------------------------------- transforms

void SceneBuilder::change_ctm(const Statement& s, const Mat4d& m, bool concatenate) {
  TransformPair changed = transforms_.ctm;
  if (transforms_.start_active) changed.start = concatenate ? m * transforms_.ctm.start : m;
  if (transforms_.end_active) changed.end = concatenate ? m * transforms_.ctm.end : m;
  const bool regular = is_regular(changed.start) && (!changed.animated() || is_regular(changed.end));
  if (!regular && !in_world_) {
    reporter_.error(s.where, std::string(s.row->name) + " makes a matrix that cannot be inverted",
                    "nothing may be scaled to zero or infinity");
    return;
  }
  // In the world it is no mistake until something stands there.
  if (regular) {
    changed.singular = -1;
  } else if (changed.singular < 0) {
    changed.singular = static_cast<int>(scene().singular.size());
    scene().singular.push_back({std::string(s.row->name), s.where});
  }
  transforms_.ctm = changed;
}

void SceneBuilder::identity(Statement& s) { change_ctm(s, Mat4d(), false); }
void SceneBuilder::translate(Statement& s) { change_ctm(s, translation(three(s, 0)), true); }
void SceneBuilder::scale(Statement& s) { change_ctm(s, scaling(three(s, 0)), true); }
void SceneBuilder::transform(Statement& s) { change_ctm(s, matrix_of_numbers(s.numbers), false); }
void SceneBuilder::concat_transform(Statement& s) { change_ctm(s, matrix_of_numbers(s.numbers), true); }

void SceneBuilder::rotate(Statement& s) {
  const Vec3d axis = three(s, 1);
  if (axis == Vec3d(0)) {
    reporter_.error(s.arguments_at, "Rotate about an axis of length zero",
                    "give the angle in degrees and then the three components of the axis");
    return;
  }
  change_ctm(s, rotation(s.numbers[0], axis), true);
}

void SceneBuilder::look_at(Statement& s) {
  const std::optional<Mat4d> m = looking_at(three(s, 0), three(s, 3), three(s, 6));
  if (m) {
    change_ctm(s, *m, true);
  } else if (three(s, 0) == three(s, 3)) {
    reporter_.error(s.where, "LookAt: the eye and the point looked at coincide");
  } else {
    reporter_.error(s.where, "LookAt: the up vector is zero or parallel to the direction of view");
  }
}

void SceneBuilder::coordinate_system(Statement& s) {
  auto& described = scene().coordinate_systems;
  coordinate_systems_[s.names[0]] = {transforms_.ctm, static_cast<int>(described.size())};
  described.push_back({s.names[0], s.where});
}

void SceneBuilder::coord_sys_transform(Statement& s) {
  const auto found = coordinate_systems_.find(s.names[0]);
  if (found != coordinate_systems_.end()) {
    // Both times, whatever ActiveTransform says: pbrt does the same.
    transforms_.ctm = found->second.ctm;
    if (const int i = found->second.described; i >= 0) scene().coordinate_systems[static_cast<size_t>(i)].used = true;
    return;
  }
  if (object_has_gaps_) return;  // It may be defined there.
  Remedy remedy = suggest(reporter_, s.names[0], coordinate_systems_);
  if (remedy.text.empty() && !scene().unread_files.empty())
    remedy = "files included in objects that are never placed are not read; is it defined in one of them?";
  reporter_.warning(s.names_at[0],
                    "no coordinate system named " + in_quotes(s.names[0]) + ": CoordSysTransform is ignored", remedy);
}

void SceneBuilder::active_transform(Statement& s) {
  if (s.word != "All" && s.word != "StartTime" && s.word != "EndTime") {
    reporter_.error(s.arguments_at, "ActiveTransform cannot be " + in_quotes(s.word),
                    "write All, StartTime or EndTime");
    return;
  }
  transforms_.start_active = s.word != "EndTime";
  transforms_.end_active = s.word != "StartTime";
}

void SceneBuilder::transform_times(Statement& s) {
  options_.time_start = s.numbers[0];
  options_.time_end = s.numbers[1];
}

int SceneBuilder::intern(const TransformPair& pair) {
  TransformList& known = scene().transforms;
  if (known.size() == 0) known.add({});
  const auto same = [&](const TransformPair& other) { return other.start == pair.start && other.end == pair.end; };
  if (same(known[0])) return 0;
  if (!same(known[known.size() - 1])) known.add(pair);
  const int index = static_cast<int>(known.size() - 1);
  if (pair.singular >= 0) scene().singular_transforms.emplace(index, pair.singular);
  return index;
}

/// The index of the CTM; with `warn_animated` only its start is used, as pbrt does for what cannot move.
int SceneBuilder::current_transform(const Statement& s, bool warn_animated) {
  if (!warn_animated || !transforms_.ctm.animated()) return intern(transforms_.ctm);
  reporter_.warning(s.where, std::string(s.row->name) + " cannot move", "only the transform at the start time is used");
  return intern({transforms_.ctm.start, transforms_.ctm.start, transforms_.ctm.singular});
}

// ------------------------------------------------------------------------------------------------- options

/// The statement as an entity whose plugin is the string at `name_index`.
Entity SceneBuilder::entity(Statement& s, size_t name_index) {
  return {s.names[name_index], s.where, s.names_at[name_index], std::move(s.parameters)};
}

void SceneBuilder::accelerator(Statement& s) { options_.accelerator = entity(s); }
void SceneBuilder::film(Statement& s) { options_.film = entity(s); }
void SceneBuilder::pixel_filter(Statement& s) { options_.filter = entity(s); }
void SceneBuilder::integrator(Statement& s) { options_.integrator = entity(s); }
void SceneBuilder::sampler(Statement& s) { options_.sampler = entity(s); }

void SceneBuilder::camera(Statement& s) {
  options_.camera = entity(s);
  camera_transform_ = transforms_.ctm;
  // Gauss-Jordan, because Imath's faster inverse gives up on tiny determinants.
  coordinate_systems_["camera"] = {{transforms_.ctm.start.gjInverse(), transforms_.ctm.end.gjInverse()}};
}

/// Makes the string parameter "type" of a MakeNamed... statement its plugin.
bool SceneBuilder::take_type(Statement& s, Entity& out) {
  out = entity(s);
  const auto is_type = [](const Parameter& p) {
    return p.type == ParamType::String && p.name == "type" && !p.strings().empty();
  };
  const auto found = std::find_if(out.params.begin(), out.params.end(), is_type);
  if (found == out.params.end()) {
    reporter_.excused(s.where,
                      std::string(s.row->name) + " " + in_quotes(s.names[0]) + " has no parameter \"string type\"",
                      "\"string type\" says what kind it is; without it nothing is made, as in pbrt-v3");
    return false;
  }
  out.plugin = found->strings().front();
  out.plugin_at = value_position(sources_, *found, 0);
  out.params.erase(found);
  return true;
}

void SceneBuilder::make_named_medium(Statement& s) {
  MediumDescription medium;
  medium.name = s.names[0];
  // Without a type there is no medium, as in pbrt-v3; its name is known, or every use of it would be one more message.
  if (!take_type(s, medium)) medium.plugin.clear();
  scene().media.push_back(std::move(medium));
}

void SceneBuilder::medium_interface(Statement& s) {
  // No name is no medium.
  for (size_t i = 0; i < s.names.size(); ++i)
    if (!s.names[i].empty()) scene().media_uses.push_back({s.names[i], s.names_at[i]});
}

/// Finds the media that MediumInterface names. As pbrt-v3 does, at the end: a medium may be made behind its use.
void SceneBuilder::resolve_media() {
  std::unordered_map<std::string, int> media;
  for (const MediumDescription& medium : scene().media)
    media[medium.name] = static_cast<int>(&medium - scene().media.data());
  for (MediumUse& use : scene().media_uses) {
    use.medium = look_up(media, use.name);
    if (use.medium >= 0) continue;
    if (!scene().unread_files.empty()) needs_unread_ = true;
    const Remedy meant = suggest(reporter_, use.name, media);
    reporter_.excused(
        use.where, "no medium named " + in_quotes(use.name),
        {"there is none here, as in pbrt-v3" + (meant.text.empty() ? "" : "; " + meant.text), meant.slip});
  }
}

void SceneBuilder::include(Statement& s) {
  include_ = IncludeRequest{s.names[0], s.names_at[0], std::move(s.parameters)};
}

// -------------------------------------------------------------------------------------------------- blocks

void SceneBuilder::begin_world(Statement& s) {
  scenes_.push_back(options_);
  // What is said behind WorldEnd starts from pbrt's defaults, as the first world did.
  options_ = SceneDescription();
  options_.folder = scenes_.back().folder;
  in_world_ = true;
  world_missing_reported_ = false;
  SceneDescription& world = scenes_.back();
  world.world_begin = s.where;
  world.transforms = {};
  world.camera_transform = intern(std::exchange(camera_transform_, TransformPair()));
  MaterialDescription matte;
  matte.plugin = "matte";
  world.materials.push_back(std::move(matte));
  transforms_.ctm = TransformPair();
  transforms_.start_active = transforms_.end_active = true;
  coordinate_systems_["world"] = {transforms_.ctm};
}

void SceneBuilder::end_world(Statement&) { close_world("WorldEnd"); }

void SceneBuilder::close_world(const std::string& before) {
  report_open_blocks(before);
  resolve_media();
  transforms_ = TransformState();
  state_ = GraphicsState();
  saved_transforms_.clear();
  saved_graphics_.clear();
  definitions_.clear();
  for (Names* names : {&float_textures_, &spectrum_textures_, &named_materials_, &objects_}) names->clear();
  coordinate_systems_.clear();
  block_ = last_block_ = 0;
  current_object_ = warned_area_light_ = -1;
  nested_objects_ = 0;
  object_has_gaps_ = in_world_ = false;
}

void SceneBuilder::save_transforms(BlockBegin begin) { saved_transforms_.push_back({begin, transforms_}); }
void SceneBuilder::save_graphics(BlockBegin begin) {
  saved_graphics_.push_back({begin, state_, definitions_.size(), block_});
  block_ = ++last_block_;
}

void SceneBuilder::return_transforms(BlockKind kind, SourcePos end) {
  if (saved_transforms_.empty()) {
    report_unmatched(crossed_transforms_, kind, end);
    return;
  }
  const SavedTransforms& saved = saved_transforms_.back();
  // Only TransformBegin has no part in the other stack, which sees to what AttributeBegin and ObjectBegin are to each other.
  if ((kind == BlockKind::Transform) != (saved.begin.kind == BlockKind::Transform))
    note_crossing(crossed_transforms_, kind, end, saved.begin);
  transforms_ = saved.state;
  saved_transforms_.pop_back();
}

void SceneBuilder::return_graphics(BlockKind kind, SourcePos end) {
  if (saved_graphics_.empty()) {
    report_unmatched(crossed_graphics_, kind, end);
    return;
  }
  const SavedGraphics& saved = saved_graphics_.back();
  if (kind != saved.begin.kind) note_crossing(crossed_graphics_, kind, end, saved.begin);
  state_ = saved.state;
  block_ = saved.block;
  for (; definitions_.size() > saved.definitions; definitions_.pop_back()) {
    Definition& undone = definitions_.back();
    if (undone.before == kNoName) {
      undone.names->erase(undone.name);
    } else {
      (*undone.names)[undone.name] = undone.before;
    }
  }
  saved_graphics_.pop_back();
  return_transforms(kind, end);
}

bool SceneBuilder::alike(const Crossings& open, BlockKind a, BlockKind b) const {
  // Of transforms AttributeBegin and ObjectBegin remember the same.
  constexpr BlockKind transform = BlockKind::Transform;
  return &open == &crossed_transforms_ ? (a == transform) == (b == transform) : a == b;
}

/// An end took what another kind of block had saved. That is a warning once the end of that block has come and taken
/// what was left: the two blocks cross. Until then it may also be that one of the two has no end, or no begin.
void SceneBuilder::note_crossing(Crossings& open, BlockKind kind, SourcePos end, const BlockBegin& took) {
  if (object_has_gaps_) needs_unread_ = true;
  const auto half = std::find_if(open.begin(), open.end(), [&](const Crossing& c) {
    return alike(open, c.took.kind, kind) && alike(open, c.kind, took.kind);
  });
  if (half == open.end()) {
    open.push_back({kind, end, took});
    return;
  }
  const std::string first = block_name(static_cast<int>(half->kind)),
                    second = block_name(static_cast<int>(half->took.kind));
  reporter_.excused(half->where,
                    first + "End inside the block of " + second + "Begin, which crosses that of " + first + "Begin",
                    "as in pbrt-v3, the first end closes the block of " + sources_.location(half->took.where) +
                        ", the second that of " + sources_.location(took.where),
                    end);
  open.erase(half);
}

/// An end with nothing to return to. Where an end of another kind took what this one needs, that one is the mistake.
void SceneBuilder::report_unmatched(Crossings& open, BlockKind kind, SourcePos end) {
  if (object_has_gaps_) needs_unread_ = true;
  Crossing surplus{kind, end, {}};
  const auto taken =
      std::find_if(open.begin(), open.end(), [&](const Crossing& c) { return alike(open, c.took.kind, kind); });
  if (taken != open.end()) {
    surplus = *taken;
    open.erase(taken);
  }
  SourcePos inside = surplus.took.where;
  if (!inside.known() && !saved_transforms_.empty()) inside = saved_transforms_.back().begin.where;
  report_end_without_begin(surplus.kind, surplus.where, inside);
}

void SceneBuilder::report_end_without_begin(BlockKind kind, SourcePos end, SourcePos innermost) {
  const std::string name = block_name(static_cast<int>(kind));
  reporter_.error(end, name + "End without " + name + "Begin",
                  innermost.known() ? "the innermost open block began at " + sources_.location(innermost) : "");
}

/// Reports every block that has no end when the world ends.
void SceneBuilder::report_open_blocks(const std::string& before) {
  if (object_has_gaps_) needs_unread_ = true;  // Its end may stand there.
  const auto warn = [&](const BlockBegin& begin, const std::string& remedy) {
    reporter_.warning(begin.where, std::string(block_name(static_cast<int>(begin.kind))) + "Begin is never closed",
                      remedy);
  };
  const auto assumed = [&](BlockKind kind) {
    return std::string(block_name(static_cast<int>(kind))) + "End is assumed before " + before;
  };
  for (; !saved_graphics_.empty(); saved_graphics_.pop_back()) {
    const BlockBegin& begin = saved_graphics_.back().begin;
    // Where an end of this kind took what another block had saved, that other block is the one without an end.
    const auto other = std::find_if(crossed_graphics_.begin(), crossed_graphics_.end(),
                                    [&](const Crossing& c) { return c.kind == begin.kind; });
    if (other == crossed_graphics_.end()) {
      warn(begin, assumed(begin.kind));
    } else {
      warn(other->took, "as in pbrt-v3, it is closed by the " + std::string(block_name(static_cast<int>(other->kind))) +
                            "End at " + sources_.location(other->where));
      crossed_graphics_.erase(other);
    }
  }
  for (const Crossing& c : crossed_graphics_) warn(c.took, assumed(c.took.kind));
  for (; !saved_transforms_.empty(); saved_transforms_.pop_back()) {
    const BlockBegin& begin = saved_transforms_.back().begin;
    if (begin.kind == BlockKind::Transform) warn(begin, assumed(begin.kind));
  }
  for (const Crossing& c : crossed_transforms_) {
    if (c.kind == BlockKind::Transform) {
      report_end_without_begin(c.kind, c.where, c.took.where);
    } else {
      warn(c.took, assumed(c.took.kind));
    }
  }
  crossed_graphics_.clear();
  crossed_transforms_.clear();
}

void SceneBuilder::begin_attribute(Statement& s) {
  save_transforms({BlockKind::Attribute, s.where});
  save_graphics({BlockKind::Attribute, s.where});
}
void SceneBuilder::end_attribute(Statement& s) { return_graphics(BlockKind::Attribute, s.where); }
void SceneBuilder::begin_transform(Statement& s) { save_transforms({BlockKind::Transform, s.where}); }
void SceneBuilder::end_transform(Statement& s) { return_transforms(BlockKind::Transform, s.where); }

void SceneBuilder::begin_object(Statement& s) {
  save_transforms({BlockKind::Object, s.where});
  save_graphics({BlockKind::Object, s.where});
  if (current_object_ >= 0) {
    ++nested_objects_;
    const SourcePos outer = scene().objects[static_cast<size_t>(current_object_)].where;
    reporter_.error(s.where, "ObjectBegin inside an object definition",
                    "the definition around it began at " + sources_.location(outer));
    return;
  }
  current_object_ = static_cast<int>(scene().objects.size());
  scene().objects.push_back({s.names[0], s.where});
  // Objects are known in the whole world, in whatever block they are defined.
  objects_[s.names[0]] = current_object_;
}

void SceneBuilder::end_object(Statement& s) {
  if (current_object_ < 0) {
    report_end_without_begin(BlockKind::Object, s.where,
                             saved_transforms_.empty() ? SourcePos() : saved_transforms_.back().begin.where);
    return;
  }
  return_graphics(BlockKind::Object, s.where);
  if (nested_objects_ > 0) {
    --nested_objects_;
    return;
  }
  current_object_ = -1;
  object_has_gaps_ = false;
}

void SceneBuilder::object_instance(Statement& s) {
  if (current_object_ >= 0) {
    reporter_.error(s.where, "ObjectInstance inside an object definition", "an object holds shapes only");
    return;
  }
  const int object = look_up(objects_, s.names[0]);
  if (object < 0) {
    reporter_.error(s.names_at[0], "no object named " + in_quotes(s.names[0]),
                    suggest(reporter_, s.names[0], objects_));
    return;
  }
  scene().instances.push_back({object, current_transform(s, false), s.where});
}

// -------------------------------------------------------------------------------------- what the world holds

void SceneBuilder::reverse_orientation(Statement&) { state_.reverse_orientation = !state_.reverse_orientation; }

/// Gives a name a meaning until the end of the innermost AttributeBegin or ObjectBegin.
void SceneBuilder::define(Names& names, const std::string& name, int index) {
  const auto [slot, fresh] = names.try_emplace(name, index);
  if (!saved_graphics_.empty()) definitions_.push_back({&names, name, fresh ? kNoName : slot->second});
  slot->second = index;
}

void SceneBuilder::resolve_textures(ParameterList& list) {
  for (Parameter& parameter : list) {
    auto* references = std::get_if<std::vector<TextureRef>>(&parameter.values);
    for (size_t i = 0; references && i < references->size(); ++i) {
      TextureRef& reference = (*references)[i];
      reference.float_texture = look_up(float_textures_, reference.name);
      reference.spectrum_texture = look_up(spectrum_textures_, reference.name);
      if (reference.float_texture >= 0 || reference.spectrum_texture >= 0) continue;
      // An error when the statement is bound, unless nothing uses it.
      scene().unknown_textures.try_emplace(reference.name,
                                           suggest(reporter_, reference.name, float_textures_, spectrum_textures_));
    }
  }
}

void SceneBuilder::texture(Statement& s) {
  const std::string& type = s.names[1];
  if (type != "float" && type != "spectrum" && type != "color") {
    reporter_.error(s.names_at[1], "a texture cannot be of type " + in_quotes(type),
                    "its type is \"float\" or \"spectrum\"");
    return;
  }
  TextureDescription out;
  out.name = s.names[0];
  out.spectrum = type != "float";
  out.block = block_;
  out.transform = current_transform(s, true);
  out.picture = take_attachment<PictureBytes>(s.parameters);
  static_cast<Entity&>(out) = entity(s, 2);
  const int index = static_cast<int>(scene().textures.size());
  define(out.spectrum ? spectrum_textures_ : float_textures_, out.name, index);
  scene().textures.push_back(std::move(out));
}

void SceneBuilder::add_material(Entity made, std::string name) {
  MaterialDescription out;
  static_cast<Entity&>(out) = std::move(made);
  out.name = std::move(name);
  out.block = block_;
  for (const Parameter& parameter : out.params) {
    for (size_t i = 0; i < parameter.strings().size(); ++i) {
      const std::string& value = parameter.strings()[i];
      const int index = look_up(named_materials_, value);
      const bool asked_for = out.plugin == "mix" && parameter.name.starts_with("namedmaterial");
      // As in pbrt-v3, matte stands in for a material that a mix names and that is not there.
      if (index >= 0 || asked_for) out.named.emplace_back(value, std::max(index, 0));
      if (index == kNoName && asked_for)
        warn_no_material(value, value_position(sources_, parameter, i), "matte stands in for it");
    }
  }
  scene().materials.push_back(std::move(out));
}

void SceneBuilder::material(Statement& s) {
  add_material(entity(s), "");
  state_.material = static_cast<int>(scene().materials.size() - 1);
}

void SceneBuilder::make_named_material(Statement& s) {
  const std::string name = s.names[0];
  Entity made;
  if (!take_type(s, made)) {
    define(named_materials_, name, kNotMade);
    return;
  }
  if (look_up(named_materials_, name) >= 0)
    reporter_.warning(s.names_at[0], "named material " + in_quotes(name) + " is defined again",
                      "the new one is used from here on", "redefined-material");
  add_material(std::move(made), name);
  define(named_materials_, name, static_cast<int>(scene().materials.size() - 1));
}

void SceneBuilder::named_material(Statement& s) {
  const int index = look_up(named_materials_, s.names[0]);
  if (index >= 0) state_.material = index;
  // One that could not be made has been reported as such.
  if (index == kNoName) warn_no_material(s.names[0], s.names_at[0], "the current material stays");
}

void SceneBuilder::warn_no_material(const std::string& name, SourcePos where, const std::string& instead) {
  if (!scene().unread_files.empty()) needs_unread_ = true;
  const Remedy meant = suggest(reporter_, name, named_materials_);
  reporter_.excused(
      where, "no material named " + in_quotes(name),
      {instead + ", as in pbrt-v3; MakeNamedMaterial must come before" + (meant.text.empty() ? "" : "; " + meant.text),
       meant.slip});
}

void SceneBuilder::light_source(Statement& s) {
  LightDescription out;
  out.transform = current_transform(s, true);
  static_cast<Entity&>(out) = entity(s);
  scene().lights.push_back(std::move(out));
}

void SceneBuilder::area_light_source(Statement& s) {
  // An empty name turns the area light off again.
  state_.area_light = s.names[0].empty() ? -1 : static_cast<int>(scene().area_lights.size());
  if (!s.names[0].empty()) scene().area_lights.push_back(entity(s));
}

/// What a statement of a model's text names as attached, in place of the parameter that names it.
template <class T>
std::shared_ptr<const T> SceneBuilder::take_attachment(ParameterList& list) {
  if (!models_ || !in_model_) return nullptr;
  for (auto p = list.begin(); p != list.end(); ++p) {
    if (p->name != ModelReader::kAttached || p->strings().size() != 1) continue;
    auto found = std::dynamic_pointer_cast<const T>(models_->attachment(p->strings().front()));
    list.erase(p);
    return found;
  }
  return nullptr;
}

void SceneBuilder::shape(Statement& s) {
  ShapeDescription out;
  out.mesh = take_attachment<MeshSource>(s.parameters);
  if (models_ && s.names[0] == "gltf" && !out.mesh) {
    places_model_ = true;
    return;
  }
  out.transform = current_transform(s, false);
  out.material = state_.material;
  out.area_light = state_.area_light;
  out.object = current_object_;
  out.reverse_orientation = state_.reverse_orientation;
  static_cast<Entity&>(out) = entity(s);
  if (out.object >= 0 && out.area_light >= 0 && out.area_light != warned_area_light_) {
    warned_area_light_ = out.area_light;
    reporter_.warning(out.where, "area light inside an object definition",
                      "it glows; paths alone may meet it by chance");
  }
  scene().shapes.push_back(std::move(out));
}

}  // namespace whit
