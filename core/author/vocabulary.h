// What scene files can say: statements, plugins and parameters in words, from the tables that read them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/plugin/registry.h"
#include "parser/statements.h"

namespace whit::author {

/// The categories of which a directive names a plugin, the one of `s` alone where it says which: those of Texture are two.
std::string category_of(const Statement& s);
std::vector<std::string> categories_of(std::string_view directive);

/// The name of a statement's plugin, which for MakeNamed... is the value of a parameter; "" where it has none.
std::string plugin_name(const Statement& s);
/// The plugin of a statement; null where it has none or nobody knows it.
const PluginInfo* plugin_of(const Statement& s);

/// The string in a statement that names its plugin: which of Statement::names, or -1.
int plugin_string(std::string_view directive);

/// Whether a parameter's strings are paths of files.
bool names_file(const Statement& s, const Parameter& p);

/// The types that stand for a colour, in whatever way.
bool is_colour(ParamType type);

/// For people, as Markdown.
std::string describe(const StatementRow& row);
std::string describe(const PluginInfo& plugin);
std::string describe(const ParamSpec& spec);
/// Unit, range, default and choices in a line: "default 0.1, above 0, scene length".
std::string facts(const ParamSpec& spec);

}  // namespace whit::author
