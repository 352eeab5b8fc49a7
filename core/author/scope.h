// What names stand for in a scene, and which transforms are in force, followed statement by statement as the parser does.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/author/workspace.h"
#include "parser/scene_description.h"

namespace whit::author {

/// A mention in a file.
struct MentionAt {
  File* file = nullptr;
  size_t mention = 0;  ///< Index into its FileIndex::mentions().
  const Mention& get() const { return file->index.mentions()[mention]; }
};

/// A use of a name, and what it stands for: one definition, for a parameter perhaps two, a float texture and a colour.
struct Use {
  MentionAt at;
  int definition = -1, other = -1;  ///< Indices into Scope::definitions(); -1 where there is none.
};

/// A statement in a file.
struct ItemAt {
  File* file = nullptr;
  size_t item = 0;
};

/// The state behind some statements of a scene.
class Scope {
 public:
  /// Goes on behind a statement.
  void apply(File& file, size_t item);
  /// Behind the last statement: what a name of the whole world stands for is known then.
  void finish();

  bool in_world() const { return in_world_; }
  /// The statements that have opened the blocks around here, the innermost last.
  const std::vector<const StatementRow*>& blocks() const { return blocks_; }
  const std::vector<MentionAt>& definitions() const { return definitions_; }
  const std::vector<Use>& uses() const { return uses_; }

  /// The names of a kind that are known here.
  std::vector<std::string> names(NameKind kind) const;
  /// What a name stands for here; -1 for nothing.
  int find(NameKind kind, const std::string& name) const;
  /// The statement of the material that shapes have here.
  const std::optional<ItemAt>& material() const { return state_.material; }
  /// The transforms in force, or nothing where a statement that makes them is wrong.
  std::optional<TransformPair> transforms() const;

 private:
  using Names = std::unordered_map<std::string, int>;
  /// Which of the two transforms statements change.
  struct Active {
    bool start = true, end = true;
  };
  /// Those in force between a begin and its end; a system of coordinates is the transforms alone.
  struct SavedTransforms {
    int transform = -1;
    Active active;
  };
  /// The transforms in force are those of a statement behind others.
  struct Step {
    int before = -1;
    enum class Kind : uint8_t { Statement, Invert } kind = Kind::Statement;
    ItemAt at;
    Active active;
  };
  struct State {
    std::optional<ItemAt> material;
  };
  struct Saved {
    State state;
    size_t undo = 0;
  };
  struct Undo {
    Names* names = nullptr;
    std::string name;
    int before = -1;
  };
  void define(Names& names, const MentionAt& at, bool in_block);
  void mention(const MentionAt& at);
  void use(const MentionAt& at);
  void step(Step::Kind kind, ItemAt at);
  void save_transforms() { saved_transforms_.push_back({transform_, active_}); }
  void restore_transforms();
  void activate(const ItemAt& at);
  void begin_graphics();
  void end_graphics();
  void end_world();
  size_t first_mention(const File& file, const Item& item);
  Names& names_of(NameKind kind);
  const Names& names_of(NameKind kind) const { return const_cast<Scope*>(this)->names_of(kind); }

  bool in_world_ = false;
  std::vector<const StatementRow*> blocks_;
  std::vector<MentionAt> definitions_;
  std::vector<Use> uses_;
  Names float_textures_, colour_textures_, materials_, objects_, systems_, media_;
  std::unordered_map<std::string, int> system_transforms_;
  std::vector<size_t> media_uses_;
  std::vector<Undo> undo_;
  std::vector<Saved> saved_;
  std::vector<SavedTransforms> saved_transforms_;
  State state_;
  std::vector<Step> steps_;
  int transform_ = -1;
  Active active_;
  const File* last_file_ = nullptr;  ///< Where the mentions of the next statement probably are.
  size_t next_mention_ = 0;
};

/// The state in front of an offset of a file, in the scene of `main`.
Scope scope_at(Workspace& workspace, File& main, const File& file, uint64_t offset);
/// The names of a whole scene.
Scope whole_scope(Workspace& workspace, File& main);

}  // namespace whit::author
