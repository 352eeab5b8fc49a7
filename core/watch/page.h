// The page of a preview.
#pragma once

#include <string>

namespace whit {

/// Its text; scripts and styles have the nonce that its Content-Security-Policy names.
std::string watch_page(const std::string& nonce);

}  // namespace whit
