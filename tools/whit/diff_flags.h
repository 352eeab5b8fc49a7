// The flags of `whit diff`.
#pragma once

#include <string>

#include "core/compare/policy.h"
#include "core/compare/settings.h"
#include "tools/whit/commands.h"

namespace whit {

struct DiffFlags {
  std::string a, b;                  ///< Pictures or folders, the judged one and the reference.
  CompareSettings said;              ///< What the command line says of how to compare.
  CompareRequest base;               ///< What no policy says: the crop, slow measures.
  std::string policy;                ///< File, "" for none.
  std::string heatmap, html, junit;  ///< Files to write, "" for none.
  bool heat_signed = false;
  double heat_scale = 0;  ///< What the map's ends stand for, 0: as the picture has it.
  std::string note;       ///< Which flags decide nothing beside others, "" for none.
  bool verbose = false, json = false, update = false, yes = false;
};

/// Reads the arguments. False when there is no more to do, with the exit code.
bool read_diff_flags(const Arguments& args, DiffFlags& flags, int& code);

/// "", or which flag does nothing, neither by the other flags nor by what a rule of the policy says.
std::string flag_without_effect(const DiffFlags& flags, const Policy& policy);

/// How a picture is to be compared: as the policy says for its name, and the command line above that.
CompareRequest request_of(const DiffFlags& flags, const Policy& policy, const std::string& name);

}  // namespace whit
