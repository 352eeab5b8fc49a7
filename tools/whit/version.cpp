#include "tools/whit/version.h"

namespace whit {

const char* version() { return WHIT_VERSION; }

}  // namespace whit
