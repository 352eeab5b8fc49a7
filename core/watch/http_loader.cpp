#include "core/plugin/module.h"
#include "core/watch/http/module.h"

namespace whit {

const HttpModule& http_module() {
  static const auto& functions = *static_cast<const HttpModule*>(load_module("whit_http"));
  return functions;
}

}  // namespace whit
