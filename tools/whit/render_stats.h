// What `whit render` tells machines when pictures are done (--stats FILE.json).
#pragma once

#include <string>

#include "tools/whit/json.h"
#include "tools/whit/render_flags.h"
#include "tools/whit/render_report.h"

namespace whit {

/// The figures of every picture of a run.
class RenderStats {
 public:
  explicit RenderStats(size_t scenes) : several_(scenes > 1) {}

  /// So many worlds a scene file has.
  void expect(size_t worlds) { several_ = several_ || worlds > 1; }
  void add(const RenderSettings& settings, const std::string& scene, const RenderOutcome& outcome);

  /// Writes an object, or an array of objects where several pictures were asked for; nothing where none was made. The
  /// file appears complete or not at all. "" or what went wrong.
  std::string write(const std::string& path) const;

 private:
  bool several_;
  Json::Array pictures_;
};

}  // namespace whit
