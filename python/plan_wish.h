// Arguments that rendering and explaining share.
#pragma once

#include "python/convert.h"
#include "python/kept_scene.h"

namespace whit::python {

/// Of a dict with the arguments' names.
PlanWish plan_wish(const py::dict& from);
ModelWish model_wish(const py::dict& from);

}  // namespace whit::python
