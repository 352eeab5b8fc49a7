// The flags that say what is simulated, which render and explain share: the integrator, and effects to leave out.
#pragma once

#include <optional>
#include <string>

#include "core/session/session.h"
#include "tools/whit/command_line.h"

namespace whit {

struct EffectFlags {
  std::optional<std::string> without, only;  ///< Names with commas between.
  bool plan_check = false;
  std::string integrator;  ///< Instead of the scene's.
};

void add_effect_flags(CommandLine& command, EffectFlags& flags);
/// "" or what is wrong with them, and the remedy.
std::string usage_problem(const EffectFlags& flags);
/// Of flags without a problem, as is the rest.
void choose_integrator(const EffectFlags& flags, ParsedFile& file);
PlanOptions plan_options(const EffectFlags& flags);

}  // namespace whit
