// What a plan leaves alone, and why: statements, and the files they name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/effect_plan.h"

namespace whit {

/// A file that is not read.
struct LeftOutFile {
  std::string name;  ///< As the scene file has it.
  int64_t bytes = 0;
};

/// A statement that the picture does not need.
struct LeftOut {
  std::string kind;    ///< "texture", "material", ...
  std::string name;    ///< Its name in the file, or its plugin's.
  std::string reason;  ///< "no visible surface uses it", ...
  SourcePos where;
  std::vector<LeftOutFile> files;
};

/// All of them, kind by kind and in file order. Looks at the sizes of files, and does not open them.
std::vector<LeftOut> find_left_out(const BoundScene& scene, const EffectPlan& plan);

}  // namespace whit
