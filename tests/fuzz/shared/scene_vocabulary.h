// Statements made of what the parser and the plugins declare, for mutators: right in all but their values, mostly.
#pragma once

#include <string>

#include "core/plugin/registry.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/scene_text.h"

namespace whit::fuzz {

/// A statement of any kind.
Tokens make_statement(Dice& dice);

/// A parameter that a plugin declares, with values of a type that it takes.
Tokens make_parameter(const PluginInfo& info, Dice& dice);

/// The plugin that a statement names; null where it names none.
const PluginInfo* plugin_of(const Tokens& statement);

/// In quotes: a name of another plugin that may stand where that one does, of a type, or of something in the scene.
std::string other_plugin(const PluginInfo& info, Dice& dice);
std::string any_type(Dice& dice);
std::string any_name(Dice& dice);

}  // namespace whit::fuzz
