#include "python/version.h"

namespace whit::python {

const char* version() { return WHIT_VERSION; }

}  // namespace whit::python
