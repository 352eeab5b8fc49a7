// What the server does for an editor beside diagnostics: a handler for each request, which turns what core/author knows
// into JSON.

#include "tools/whit/lsp_server.h"

namespace whit::lsp {

std::vector<Method> feature_methods() { return {}; }

Value feature_capabilities() { return Value::object(); }

}  // namespace whit::lsp
