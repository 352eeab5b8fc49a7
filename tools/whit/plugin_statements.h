// Which statement asks for the plugins of a category, and what it looks like.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace whit {

struct PluginStatement {
  const char* category;   ///< "float texture".
  const char* statement;  ///< "Texture".
  const char* start;      ///< What stands before the plugin's name: `Texture "name" "float"`.
};

/// A row for each category.
std::span<const PluginStatement> plugin_statements();

/// The row of a category; null when there is none.
const PluginStatement* statement_of(std::string_view category);

/// The categories that a statement asks for: none, one, or two of Texture.
std::vector<const char*> categories_of(std::string_view statement);

}  // namespace whit
