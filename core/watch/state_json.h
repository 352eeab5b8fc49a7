// What a preview has to say, as JSON for its page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/watch/preview.h"

namespace whit {

/// What the page can show beside the picture.
struct WatchExtras {
  std::vector<std::string>
      views;              ///< That the server applies; "" for the exact sRGB curve, which the page applies itself.
  std::string reference;  ///< Its name; "" when there is none.
  std::string reference_problem;  ///< Why it cannot be shown.
  int reference_width = 0, reference_height = 0;
  uint64_t reference_number = 0;
};

std::string state_json(const std::string& scene, const PreviewState& state, const WatchExtras& extras);
std::string spot_json(const PreviewSpot& spot);
/// {"problem": "..."}
std::string problem_json(const std::string& problem);

/// What pages send; nothing when it is not that.
struct CameraWish {
  std::optional<CameraPose> pose;  ///< None: back to the file's.
};
std::optional<CameraWish> camera_wish(const std::string& json);
std::optional<EffectSet> effects_wish(const std::string& json);

}  // namespace whit
