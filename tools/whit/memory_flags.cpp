#include "tools/whit/memory_flags.h"

#include <fmt/format.h>

#include "core/plugin/memory_limit.h"
#include "tools/whit/quantities.h"

namespace whit {

Flag memory_flag(MemoryFlags& flags) {
  return {"--max-memory", &flags.most,
          "Memory at most: 512M, 1G; what takes more is refused before (default: 90 % of what the machine has)"};
}

std::string usage_problem(const MemoryFlags& flags) {
  if (flags.most.empty() || size_of(flags.most) > 0) return {};
  return fmt::format("--max-memory: \"{}\" is no size above 0; write 512M, 1G or bytes", flags.most);
}

void set_memory_limit(const MemoryFlags& flags) {
  if (!flags.most.empty()) set_memory_limit(size_of(flags.most));
}

}  // namespace whit
