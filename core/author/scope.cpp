#include "core/author/scope.h"

#include <algorithm>
#include <utility>

#include "parser/transforms.h"

namespace whit::author {
namespace {

int look_up(const std::unordered_map<std::string, int>& names, const std::string& name) {
  const auto found = names.find(name);
  return found == names.end() ? -1 : found->second;
}

/// What a statement does here, by its name.
enum class Does : uint8_t {
  Nothing,
  Transform,
  Activate,
  BeginAttribute,
  EndAttribute,
  BeginTransform,
  EndTransform,
  BeginWorld,
  EndWorld,
  Camera,
  SetSystem,
  TakeSystem,
  Material,
  NamedMaterial
};

Does what_does(const StatementRow* row) {
  static const std::vector<Does> table = [] {
    const std::pair<const char*, Does> rows[] = {
        {"Identity", Does::Transform},
        {"Translate", Does::Transform},
        {"Scale", Does::Transform},
        {"Rotate", Does::Transform},
        {"LookAt", Does::Transform},
        {"Transform", Does::Transform},
        {"ConcatTransform", Does::Transform},
        {"ActiveTransform", Does::Activate},
        {"AttributeBegin", Does::BeginAttribute},
        {"AttributeEnd", Does::EndAttribute},
        {"ObjectBegin", Does::BeginAttribute},
        {"ObjectEnd", Does::EndAttribute},
        {"TransformBegin", Does::BeginTransform},
        {"TransformEnd", Does::EndTransform},
        {"WorldBegin", Does::BeginWorld},
        {"WorldEnd", Does::EndWorld},
        {"Camera", Does::Camera},
        {"CoordinateSystem", Does::SetSystem},
        {"CoordSysTransform", Does::TakeSystem},
        {"Material", Does::Material},
        {"NamedMaterial", Does::NamedMaterial},
    };
    std::vector<Does> out(statements().size(), Does::Nothing);
    for (const auto& [name, does] : rows) out[static_cast<size_t>(find_statement(name) - statements().data())] = does;
    return out;
  }();
  return table[static_cast<size_t>(row - statements().data())];
}

/// The transforms that statements make, one after another.
class Accumulator {
 public:
  /// False where the statement makes no matrix.
  bool apply(const Statement& s, bool start, bool end) {
    start_ = start, end_ = end;
    const std::string_view name = s.row->name;
    if (name == "Identity") return change(Mat4d(), false);
    const std::optional<Mat4d> m = matrix_of_transform(name, s.numbers);
    return m && change(*m, name != "Transform");
  }
  void invert() { both_ = {both_.start.gjInverse(), both_.end.gjInverse()}; }
  const TransformPair& both() const { return both_; }

 private:
  bool change(const Mat4d& m, bool concatenate) {
    if (start_) both_.start = concatenate ? m * both_.start : m;
    if (end_) both_.end = concatenate ? m * both_.end : m;
    return true;
  }
  TransformPair both_;
  bool start_ = true, end_ = true;
};

}  // namespace

Scope::Names& Scope::names_of(NameKind kind) {
  switch (kind) {
    case NameKind::FloatTexture: return float_textures_;
    case NameKind::ColourTexture:
    case NameKind::AnyTexture: return colour_textures_;
    case NameKind::Material: return materials_;
    case NameKind::Object: return objects_;
    case NameKind::CoordinateSystem: return systems_;
    case NameKind::Medium:
    case NameKind::Include:
    case NameKind::Asset: break;
  }
  return media_;
}

std::vector<std::string> Scope::names(NameKind kind) const {
  std::vector<std::string> out;
  const auto add = [&out](const auto& names) {
    for (const auto& [name, index] : names) out.push_back(name);
  };
  if (kind == NameKind::CoordinateSystem) add(system_transforms_);
  else add(names_of(kind));
  if (kind == NameKind::AnyTexture) add(float_textures_);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

int Scope::find(NameKind kind, const std::string& name) const {
  const int found = look_up(names_of(kind), name);
  return found < 0 && kind == NameKind::AnyTexture ? look_up(float_textures_, name) : found;
}

void Scope::define(Names& names, const MentionAt& at, bool in_block) {
  const int index = static_cast<int>(definitions_.size());
  definitions_.push_back(at);
  const auto [slot, fresh] = names.try_emplace(at.get().name, index);
  if (in_block && !saved_.empty()) undo_.push_back({&names, at.get().name, fresh ? -1 : slot->second});
  slot->second = index;
}

void Scope::use(const MentionAt& at) {
  const Mention& m = at.get();
  Use out{at, look_up(names_of(m.kind), m.name)};
  if (m.kind == NameKind::AnyTexture) out.other = look_up(float_textures_, m.name);
  if (out.definition < 0) std::swap(out.definition, out.other);
  // Media are found when the world ends: they may be made behind their use.
  if (m.kind == NameKind::Medium) media_uses_.push_back(uses_.size());
  uses_.push_back(out);
}

void Scope::mention(const MentionAt& at) {
  const Mention& m = at.get();
  if (m.kind == NameKind::Include || m.kind == NameKind::Asset) return;
  if (!m.defines) {
    use(at);
    return;
  }
  const bool in_block =
      m.kind == NameKind::FloatTexture || m.kind == NameKind::ColourTexture || m.kind == NameKind::Material;
  define(names_of(m.kind), at, in_block);
}

void Scope::step(Step::Kind kind, ItemAt at) {
  steps_.push_back({transform_, kind, at, active_});
  transform_ = static_cast<int>(steps_.size()) - 1;
}

void Scope::begin_graphics() {
  save_transforms();
  saved_.push_back({state_, undo_.size()});
}

/// As the parser: an end takes what the last begin of any kind saved.
void Scope::end_graphics() {
  if (saved_.empty()) return;
  for (; undo_.size() > saved_.back().undo; undo_.pop_back()) {
    const Undo& u = undo_.back();
    if (u.before < 0) u.names->erase(u.name);
    else (*u.names)[u.name] = u.before;
  }
  state_ = saved_.back().state;
  saved_.pop_back();
  restore_transforms();
}

void Scope::restore_transforms() {
  if (saved_transforms_.empty()) return;
  transform_ = saved_transforms_.back().transform, active_ = saved_transforms_.back().active;
  saved_transforms_.pop_back();
}

void Scope::activate(const ItemAt& at) {
  Statement s;
  if (!read_at(at.file->text(), at.file->index.items()[at.item].at.begin, s)) return;
  active_ = {s.word != "EndTime", s.word != "StartTime"};
}

size_t Scope::first_mention(const File& file, const Item& item) {
  const std::vector<Mention>& all = file.index.mentions();
  const size_t next = std::min(next_mention_, all.size());
  const bool there = &file == last_file_ && (next == 0 || all[next - 1].at.begin < item.at.begin) &&
                     (next == all.size() || all[next].at.begin >= item.at.begin);
  last_file_ = &file;
  return there ? next : file.index.first_mention(item.at.begin);
}

void Scope::finish() {
  for (const size_t i : media_uses_) uses_[i].definition = look_up(media_, uses_[i].at.get().name);
  media_uses_.clear();
}

void Scope::end_world() {
  finish();
  for (Names* names : {&float_textures_, &colour_textures_, &materials_, &objects_, &systems_, &media_}) names->clear();
  system_transforms_.clear();
  blocks_.clear(), undo_.clear(), saved_.clear(), saved_transforms_.clear();
  state_ = State();
  transform_ = -1, active_ = {};
  in_world_ = false;
}

void Scope::apply(File& file, size_t item) {
  const Item& statement = file.index.items()[item];
  if (!statement.row) return;
  const Does does = what_does(statement.row);
  const bool begins = does == Does::BeginAttribute;
  if (begins) begin_graphics();
  if (statement.row->nesting > 0) blocks_.push_back(statement.row);
  if (statement.row->nesting < 0 && !blocks_.empty()) blocks_.pop_back();
  const std::vector<Mention>& mentions = file.index.mentions();
  const size_t first = first_mention(file, statement);
  for (next_mention_ = first; next_mention_ < mentions.size() && mentions[next_mention_].at.begin < statement.at.end;
       ++next_mention_)
    mention({&file, next_mention_});
  const bool named = first < mentions.size() && mentions[first].at.begin < statement.at.end;
  const ItemAt at{&file, item};
  switch (does) {
    case Does::Transform: step(Step::Kind::Statement, at); break;
    case Does::EndAttribute: end_graphics(); break;
    case Does::BeginTransform: save_transforms(); break;
    case Does::EndTransform: restore_transforms(); break;
    case Does::Activate: activate(at); break;
    case Does::BeginWorld:
      transform_ = -1, active_ = {};
      system_transforms_["world"] = -1;
      in_world_ = true;
      break;
    case Does::EndWorld: end_world(); break;
    case Does::Camera: {
      const int here = transform_;
      step(Step::Kind::Invert, at);
      system_transforms_["camera"] = std::exchange(transform_, here);
      break;
    }
    case Does::SetSystem:
      if (named) system_transforms_[mentions[first].name] = transform_;
      break;
    case Does::TakeSystem:
      if (const auto found = named ? system_transforms_.find(mentions[first].name) : system_transforms_.end();
          found != system_transforms_.end())
        transform_ = found->second;
      break;
    case Does::Material: state_.material = at; break;
    case Does::NamedMaterial:
      if (const int made = named ? find(NameKind::Material, mentions[first].name) : -1; made >= 0) {
        const MentionAt& definition = definitions_[static_cast<size_t>(made)];
        state_.material = ItemAt{definition.file, definition.file->index.item_at(definition.get().at.begin)};
      }
      break;
    case Does::BeginAttribute:
    case Does::Nothing: break;
  }
}

std::optional<TransformPair> Scope::transforms() const {
  std::vector<const Step*> steps;
  for (int i = transform_; i >= 0; i = steps_[static_cast<size_t>(i)].before)
    steps.push_back(&steps_[static_cast<size_t>(i)]);
  Accumulator all;
  Statement s;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    const ItemAt& at = (*step)->at;
    if ((*step)->kind == Step::Kind::Invert) all.invert();
    else if (!read_at(at.file->text(), at.file->index.items()[at.item].at.begin, s) ||
             !all.apply(s, (*step)->active.start, (*step)->active.end))
      return std::nullopt;
  }
  return all.both();
}

Scope scope_at(Workspace& workspace, File& main, const File& file, uint64_t offset) {
  Scope scope;
  workspace.walk(main, [&](File& in, size_t item) {
    if (&in == &file && in.index.items()[item].at.begin >= offset) return false;
    scope.apply(in, item);
    return true;
  });
  return scope;
}

Scope whole_scope(Workspace& workspace, File& main) {
  Scope scope;
  workspace.walk(main, [&](File& in, size_t item) {
    scope.apply(in, item);
    return true;
  });
  scope.finish();
  return scope;
}

}  // namespace whit::author
