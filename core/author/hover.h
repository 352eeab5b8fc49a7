// What there is to know of what stands at a place of a scene file, for people.
#pragma once

#include <optional>
#include <string>

#include "core/author/workspace.h"

namespace whit::author {

struct Hover {
  std::string markdown;
  Span at;
};
std::optional<Hover> hover(Workspace& workspace, File& file, uint64_t offset);

}  // namespace whit::author
