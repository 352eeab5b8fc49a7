#include "core/plugin/module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

namespace whit {

const void* load_module(const std::string& name) {
  void* const module = ::dlopen((name + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
  const void* const functions = module ? ::dlsym(module, name.c_str()) : nullptr;
  if (!functions)
    throw std::runtime_error(
        fmt::format("{}.so cannot be loaded ({}); it belongs beside the program", name, ::dlerror()));
  return functions;
}

}  // namespace whit
