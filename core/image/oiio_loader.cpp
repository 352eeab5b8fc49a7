#include "core/image/oiio/module.h"
#include "core/plugin/module.h"

namespace whit {

const Oiio& oiio() {
  static const auto& functions = *static_cast<const Oiio*>(load_module("whit_oiio"));
  return functions;
}

}  // namespace whit
