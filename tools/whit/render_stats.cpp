#include "tools/whit/render_stats.h"

#include "tools/whit/text_file.h"
#include "tools/whit/version.h"

namespace whit {

void RenderStats::add(const RenderSettings& settings, const std::string& scene, const RenderOutcome& outcome) {
  PictureSettings asked;
  asked.scene = scene, asked.command = settings.command_line, asked.version = version();
  asked.traversal = settings.traversal, asked.texture_filter = settings.effects.overrides.texture_filter;
  asked.texture_memory = settings.texture_memory, asked.seed = settings.seed;
  pictures_.push_back(picture_stats(asked, outcome));
}

std::string RenderStats::write(const std::string& path) const {
  if (path.empty() || pictures_.empty()) return {};
  return write_text(path, to_text(several_ ? Json(pictures_) : pictures_.front()) + '\n');
}

}  // namespace whit
