// Commands to paste, and the machine in words.
#pragma once

#include <string>

#include "core/accuracy/cost.h"

namespace whit {

/// The command that renders the scene with so many samples and some more flags, to be pasted into a shell.
std::string cost_command(const CostRequest& request, int samples, const std::string& flags = "");

/// Processor, threads, and the widest vectors that it has.
std::string machine_words(int threads);

}  // namespace whit
