// --sandbox: what a scene from somebody else may do, by the kernel's word and not by ours.
//
// Landlock (Linux 5.13) takes away all files but those that are named; seccomp takes away the network, other programs and
// what is of use to nobody who renders. Both hold for this thread and those that it starts, until the process ends.
#pragma once

#include <string>
#include <vector>

#include "tools/whit/command_line.h"

namespace whit {

struct SandboxFlags {
  bool on = false;
  std::vector<std::string> allow;  ///< Files and folders that may be read beside.
};

void add_sandbox_flags(CommandLine& command, SandboxFlags& flags);
/// "" or what is wrong with them.
std::string usage_problem(const SandboxFlags& flags);

/// What a command reads and writes by the user's word.
struct SandboxRequest {
  std::vector<std::string> read;   ///< Files, and folders with all below.
  std::vector<std::string> write;  ///< Files: made, and replaced, in their folders. "" and "-" are none.
  bool serves = false;             ///< It answers connections on a port that is to be opened yet.
};

/// The folder of a scene file, below which its own files are; the current one for standard input.
std::string folder_to_read(const std::string& scene);

/// Enters it where the flags say so, before any thread is started. The system's libraries and what tells of the machine
/// may be read there too. "" or why not: the kernel lacks something, or a path cannot be opened.
std::string enter_sandbox(const SandboxFlags& flags, const SandboxRequest& request);

/// Says, when a file could not be read or written in a sandbox, what may be read and written there.
void explain_sandbox(const SandboxFlags& flags, int code);

}  // namespace whit
