// What `whit help` prints for people.
#pragma once

#include <string>
#include <string_view>

#include "core/base/effect.h"
#include "core/plugin/registry.h"
#include "core/render/aovs.h"
#include "parser/statements.h"

namespace whit {

/// Commands, plugins and where to go from there.
void print_overview();

void print_help(const PluginInfo& plugin);
void print_help(const StatementRow& statement);
void print_help(Effect effect);
void print_help(const AovRow& aov);
void print_help_of_finding(std::string_view name, std::string_view what);

/// Channels of an AOV, those of a layer together: "N.X .Y .Z".
std::string channels_text(const AovRow& row);

/// The range, or "" where every float is allowed.
std::string limits_text(const Range& range);

}  // namespace whit
