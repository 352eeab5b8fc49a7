// Finds and loads the module. It lies beside the program, where the programs' run path points (CMakeLists.txt).
#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "core/watch/http/module.h"

namespace whit {
namespace {

const HttpModule& load() {
  void* module = ::dlopen("whit_http.so", RTLD_NOW | RTLD_LOCAL);
  const auto* functions = module ? static_cast<const HttpModule*>(::dlsym(module, "whit_http")) : nullptr;
  if (!functions)
    throw std::runtime_error(
        fmt::format("whit_http.so cannot be loaded ({}); it belongs beside the program", ::dlerror()));
  return *functions;
}

}  // namespace

const HttpModule& http_module() {
  static const HttpModule& functions = load();
  return functions;
}

}  // namespace whit
