// Finds and loads the module. It lies beside the program, where the programs' run path points (CMakeLists.txt).
#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "core/image/oiio/module.h"

namespace whit {
namespace {

const Oiio& load() {
  void* module = ::dlopen("whit_oiio.so", RTLD_NOW | RTLD_LOCAL);
  const auto* functions = module ? static_cast<const Oiio*>(::dlsym(module, "whit_oiio")) : nullptr;
  if (!functions)
    throw std::runtime_error(
        fmt::format("whit_oiio.so cannot be loaded ({}); it belongs beside the program", ::dlerror()));
  return *functions;
}

}  // namespace

const Oiio& oiio() {
  static const Oiio& functions = load();
  return functions;
}

}  // namespace whit
