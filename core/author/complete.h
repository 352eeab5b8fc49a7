// What may be written at a place of a scene file.
#pragma once

#include <string>
#include <vector>

#include "core/author/workspace.h"

namespace whit::author {

struct Proposal {
  enum class Kind : uint8_t { Statement, Plugin, Parameter, Value, Name, File, Folder } kind = Kind::Statement;
  std::string label, detail, doc;
  std::string text;    ///< What is written: with places to fill in where `snippet` says so, as ${1:what}.
  std::string filter;  ///< What is compared with what has been typed.
  bool snippet = false;
  Span replaces;
};

std::vector<Proposal> complete(Workspace& workspace, File& file, uint64_t offset);

}  // namespace whit::author
