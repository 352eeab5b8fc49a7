// The OpenColorIO configuration that whit uses when the user has none (for display.cpp; not for other folders).
#pragma once

#include <OpenColorIO/OpenColorIO.h>

namespace whit {

/// Linear Rec.709 as scene_linear, the display "sRGB" with the views "sRGB", "ACES SDR" and "exposure"; the last uses
/// `exposure` in [0, 1). May throw OpenColorIO's exceptions.
OCIO_NAMESPACE::ConstConfigRcPtr make_builtin_config(float exposure);

}  // namespace whit
