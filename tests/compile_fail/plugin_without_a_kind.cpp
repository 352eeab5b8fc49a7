// error: kCategory
// What derives from no kind of plugin has no category.
#include "core/plugin/registry.h"

struct Thing : whit::Plugin {};

const whit::Register<Thing> thing{"thing", "Of no kind."};
