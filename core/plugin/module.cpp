#include "core/plugin/module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "core/plugin/memory_limit.h"

namespace whit {

const void* load_module(const std::string& name) {
  void* const module = ::dlopen((name + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
  const void* const functions = module ? ::dlsym(module, name.c_str()) : nullptr;
  if (functions) return functions;
  const std::string reason = ::dlerror();
  const std::string text = fmt::format("{}.so cannot be loaded ({})", name, reason);
  if (reason.find(std::strerror(ENOMEM)) != std::string::npos) throw OutOfMemory(text);
  throw std::runtime_error(text + "; it belongs beside the program");
}

}  // namespace whit
