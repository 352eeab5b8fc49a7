#include "core/author/names.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <utility>

#include "core/base/file_names.h"

namespace whit::author {
namespace {

bool is(const MentionAt& a, const File& file, size_t mention) { return a.file == &file && a.mention == mention; }

/// Definitions that a use ties together: sets of them, each with a first one.
class Groups {
 public:
  explicit Groups(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[static_cast<size_t>(i)] != i) i = parent_[static_cast<size_t>(i)];
    return i;
  }
  void join(int a, int b) {
    if (a >= 0 && b >= 0) parent_[static_cast<size_t>(find(a))] = find(b);
  }

 private:
  std::vector<int> parent_;
};

void keep_once(std::vector<MentionAt>& mentions) {
  const auto before = [](const MentionAt& a, const MentionAt& b) {
    return a.file != b.file ? a.file->path < b.file->path : a.mention < b.mention;
  };
  std::sort(mentions.begin(), mentions.end(), before);
  const auto same = [](const MentionAt& a, const MentionAt& b) { return is(a, *b.file, b.mention); };
  mentions.erase(std::unique(mentions.begin(), mentions.end(), same), mentions.end());
}

/// Ties together what one use means, and media of one name, of which the last one holds everywhere.
Groups tied(const Scope& scope) {
  const std::vector<MentionAt>& all = scope.definitions();
  Groups groups(all.size());
  for (const Use& use : scope.uses()) groups.join(use.definition, use.other);
  // A file that is included twice has each of its definitions twice.
  std::map<std::pair<const File*, size_t>, int> seen;
  std::map<std::string, int> media;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const MentionAt& at = all[static_cast<size_t>(i)];
    groups.join(i, seen.try_emplace({at.file, at.mention}, i).first->second);
    if (at.get().kind == NameKind::Medium) groups.join(i, media.try_emplace(at.get().name, i).first->second);
  }
  return groups;
}

}  // namespace

Span inside(const Mention& m) { return {m.at.begin + 1, std::max(m.at.begin + 1, m.at.end - 1)}; }

std::optional<Symbol> symbol_at(Workspace& workspace, File& file, uint64_t offset) {
  const Mention* mention = file.index.mention_at(offset);
  if (!mention || mention->kind == NameKind::Include || mention->kind == NameKind::Asset) return std::nullopt;
  const auto index = static_cast<size_t>(mention - file.index.mentions().data());
  const Scope scope = whole_scope(workspace, *workspace.main_of(file));
  Groups groups = tied(scope);
  Symbol out{mention->kind, mention->name, {}, {}};
  std::vector<int> wanted;
  for (size_t i = 0; i < scope.definitions().size(); ++i) {
    if (is(scope.definitions()[i], file, index)) wanted.push_back(groups.find(static_cast<int>(i)));
  }
  for (const Use& use : scope.uses()) {
    if (is(use.at, file, index) && use.definition >= 0) wanted.push_back(groups.find(use.definition));
  }
  const auto is_wanted = [&](int definition) {
    return definition >= 0 && std::find(wanted.begin(), wanted.end(), groups.find(definition)) != wanted.end();
  };
  for (size_t i = 0; i < scope.definitions().size(); ++i) {
    if (is_wanted(static_cast<int>(i))) out.definitions.push_back(scope.definitions()[i]);
  }
  for (const Use& use : scope.uses()) {
    // Where nothing defines it, all uses of the name go together.
    const bool stray = wanted.empty() && use.definition < 0 && use.at.get().kind == mention->kind &&
                       use.at.get().name == mention->name;
    if (stray || is_wanted(use.definition)) out.uses.push_back(use.at);
  }
  keep_once(out.definitions);
  keep_once(out.uses);
  return out;
}

std::vector<SpanAt> definition_at(Workspace& workspace, File& file, uint64_t offset) {
  const Mention* mention = file.index.mention_at(offset);
  std::vector<SpanAt> out;
  if (!mention) return out;
  if (mention->kind == NameKind::Include || mention->kind == NameKind::Asset) {
    // A mesh or a picture has no text to go to.
    const std::string path = workspace.resolve(*workspace.main_of(file), mention->name);
    if (mention->kind == NameKind::Include) {
      if (File* included = workspace.find(path)) out.push_back({included, {0, 0}});
    }
    return out;
  }
  if (const auto symbol = symbol_at(workspace, file, offset)) {
    for (const MentionAt& d : symbol->definitions) out.push_back({d.file, d.get().at});
  }
  return out;
}

std::vector<SpanAt> references_at(Workspace& workspace, File& file, uint64_t offset, bool with_definitions) {
  std::vector<SpanAt> out;
  const Mention* mention = file.index.mention_at(offset);
  if (mention && (mention->kind == NameKind::Include || mention->kind == NameKind::Asset)) {
    // All that name the same file.
    File* main = workspace.main_of(file);
    const std::string path = canonical_path(workspace.resolve(*main, mention->name));
    for (File* f : workspace.files_of(*main)) {
      for (const Mention& m : f->index.mentions()) {
        const bool names_file = m.kind == NameKind::Include || m.kind == NameKind::Asset;
        if (names_file && canonical_path(workspace.resolve(*main, m.name)) == path) out.push_back({f, m.at});
      }
    }
    return out;
  }
  if (const auto symbol = symbol_at(workspace, file, offset)) {
    for (const MentionAt& d : symbol->definitions) {
      if (with_definitions) out.push_back({d.file, d.get().at});
    }
    for (const MentionAt& u : symbol->uses) out.push_back({u.file, u.get().at});
  }
  return out;
}

bool is_taken(Workspace& workspace, File& file, NameKind kind, const std::string& name) {
  const auto texture = [](NameKind k) {
    return k == NameKind::FloatTexture || k == NameKind::ColourTexture || k == NameKind::AnyTexture;
  };
  // These two are there without a statement that makes them.
  if (kind == NameKind::CoordinateSystem && (name == "world" || name == "camera")) return true;
  const std::vector<File*> files = workspace.files_of(*workspace.main_of(file));
  return std::any_of(files.begin(), files.end(), [&](const File* f) {
    const std::vector<Mention>& all = f->index.mentions();
    return std::any_of(all.begin(), all.end(), [&](const Mention& m) {
      return m.name == name && (m.kind == kind || (texture(m.kind) && texture(kind)));
    });
  });
}

std::string why_no_name(const std::string& name) {
  if (name.empty()) return "a name has at least one character";
  if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    return "a name is on one line, without control characters";
  return {};
}

std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace whit::author
