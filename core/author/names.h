// Where a name of a scene is given its meaning, where it is used, and how all of that is renamed.
#pragma once

#include <string>
#include <vector>

#include "core/author/scope.h"

namespace whit::author {

/// A span of a file.
struct SpanAt {
  File* file = nullptr;
  Span span;
};

/// A name and all that goes with it: definitions, which are several where one use may mean either, and uses.
struct Symbol {
  NameKind kind = NameKind::Material;
  std::string name;
  std::vector<MentionAt> definitions, uses;
};

/// The symbol under an offset; without a kind's definitions where nothing defines it. Null where there is no name.
std::optional<Symbol> symbol_at(Workspace& workspace, File& file, uint64_t offset);

/// Where a name, an Include or the file of a parameter leads.
std::vector<SpanAt> definition_at(Workspace& workspace, File& file, uint64_t offset);
std::vector<SpanAt> references_at(Workspace& workspace, File& file, uint64_t offset, bool with_definitions);

/// The text of a mention between its quotes.
Span inside(const Mention& mention);

/// Whether the scene of a file has this name already for something of a kind: what is renamed to it would mean that.
bool is_taken(Workspace& workspace, File& file, NameKind kind, const std::string& name);
/// Why a name cannot be called so, or "".
std::string why_no_name(const std::string& name);
/// A name as it stands between quotes.
std::string escaped(const std::string& name);

}  // namespace whit::author
