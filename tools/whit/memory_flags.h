// The flag that says how much memory may be taken.
#pragma once

#include <string>

#include "tools/whit/command_line.h"

namespace whit {

struct MemoryFlags {
  std::string most;  ///< As given: size_of(); "" for nine tenths of what there is.
};

/// The flag's row, for the commands that render.
Flag memory_flag(MemoryFlags& flags);
/// "" or what is wrong with it.
std::string usage_problem(const MemoryFlags& flags);
/// Makes it the limit of the process (core/plugin/memory_limit.h).
void set_memory_limit(const MemoryFlags& flags);

}  // namespace whit
