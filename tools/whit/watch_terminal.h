// A preview in the terminal.
#pragma once

#include <functional>
#include <string>

#include "core/watch/preview.h"

namespace whit {

struct WatchTerminal {
  std::string graphics;         ///< "auto", "blocks", "kitty" or "sixel".
  std::string view, ocio;       ///< As for pictures.
  std::function<bool()> ended;  ///< Whether the user wants it to end.
};

/// Draws pictures until the user ends it. Where standard output is no terminal: the finished picture, once. Returns the exit
/// code.
int watch_in_terminal(Preview& preview, const WatchTerminal& how);

}  // namespace whit
