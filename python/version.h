// The version of the module, which is the program's.
#pragma once

namespace whit::python {

/// "0.1.0"
const char* version();

}  // namespace whit::python
