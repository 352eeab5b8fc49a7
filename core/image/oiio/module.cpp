// What the module hands out under a name that dlsym() can find.
#include "core/image/oiio/functions.h"

extern "C" __attribute__((visibility("default"))) const whit::Oiio whit_oiio{whit::oiio_open, whit::oiio_encode};
