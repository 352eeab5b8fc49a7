// The names of the objects a world will place, found by looking ahead in its text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "parser/source.h"

namespace whit {

/// A file, and the byte at which reading it goes on.
struct ReadingPlace {
  uint32_t file = 0;
  uint64_t offset = 0;
};

using InstanceNames = std::unordered_set<std::string>;

/// The names in all ObjectInstance statements from here to the WorldEnd. `open` are the files being read, the innermost
/// last; reading stands inside an object definition. Files included inside object definitions are taken to hold nothing
/// but parts of the object, and are not looked into: that they need not be read is the purpose.
/// Nothing when the text leaves a doubt: a file that cannot be opened, a string or list that is not closed, objects that
/// do not end where they should, no WorldEnd.
/// In text with mistakes of syntax the parser may pass over statements that count here, a WorldEnd for one. Where that, or
/// a file that is more than a part of its object, makes the answer wrong, parsing begins again and reads everything.
/// Takes time linear in the text, a small part of that for parsing it. Large files are released behind the look ahead.
std::optional<InstanceNames> names_of_instances(Sources& sources, const std::string& folder,
                                                const std::vector<ReadingPlace>& open);

}  // namespace whit
