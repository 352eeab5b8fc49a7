// The flags that switch effects off by hand, which render and explain share.
#pragma once

#include <optional>
#include <string>

#include "core/scene/effect_plan.h"
#include "tools/whit/command_line.h"

namespace whit {

struct EffectFlags {
  std::optional<std::string> without, only;  ///< Names with commas between.
  bool plan_check = false;
};

void add_effect_flags(CommandLine& command, EffectFlags& flags);
/// "" or what is wrong with them, and the remedy.
std::string usage_problem(const EffectFlags& flags);
/// Of flags without a problem.
PlanOptions plan_options(const EffectFlags& flags);

}  // namespace whit
