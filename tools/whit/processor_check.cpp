// Ends a program that the processor cannot run with a sentence, where an illegal instruction would.
//
// This file and processor_sets.cpp are compiled for every x86-64 processor (CMakeLists.txt), and the constructor here runs
// before all others of the program, which may use any instruction set: the linker puts those that have a priority first.
// What runs before it are the constructors of shared libraries, and those are the system's. Both files must stay in C, of
// the C library alone: an inline function of a C++ header is in the program once, and the linker may take the copy of a file
// that was compiled for more.
#include <stdio.h>
#include <unistd.h>

#include "tools/whit/instruction_sets.h"

namespace whit {
namespace {

// The first priority that is not the compiler's own.
__attribute__((constructor(101))) void refuse_a_processor_that_has_less() {
  const std::uint32_t lacks = kCompiledFor & ~processor_has();
  if (lacks == 0) return;
  ::dprintf(STDERR_FILENO, "whit: this processor has no ");
  const char* between = "";
  for (unsigned i = 0; i < kInstructionSets; ++i) {
    const auto set = static_cast<InstructionSet>(i);
    if ((lacks & bit(set)) == 0) continue;
    ::dprintf(STDERR_FILENO, "%s%s", between, name_of(set));
    between = ", ";
  }
  ::dprintf(STDERR_FILENO, ", which this program is compiled for (%s); compile it on this machine (docs/install.md)\n",
            kArchitecture);
  ::_exit(2);
}

}  // namespace
}  // namespace whit
