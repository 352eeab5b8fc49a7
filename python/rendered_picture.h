// A picture as Python has it: the pixels that the renderer made, in the memory where it made them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/image/planes.h"
#include "core/render/render.h"
#include "core/session/output.h"
#include "python/failure.h"

namespace whit::python {

struct RenderedPicture {
  RenderResult result;
  Json::Object statistics;             ///< picture_stats()
  std::optional<Json::Object> target;  ///< target_json(), where there was one.
  std::vector<Said> said;
  std::vector<OutputMetadata> metadata;
  std::vector<std::string> aovs;  ///< Names of what `result` holds beside its colours.
  std::vector<std::string> read;  ///< Files of the scene, whose place no picture may take.
  std::string view;               ///< The film's.
  double exposure = 0;            ///< Likewise, in stops.
};

/// How a picture is shown: "" and nothing take what the film says.
struct DisplayWish {
  std::string view, ocio;
  std::optional<double> exposure;
};

struct SaveWish : DisplayWish {
  std::string path, display;  ///< `display`: a display picture beside a linear one, "" for none.
  bool full_float = false;
};

/// Writes as the command does; what there is to warn of. Throws Failure.
std::vector<std::string> save(const RenderedPicture& picture, const SaveWish& wish);

/// Display values in 8 bits as in a PNG: height x width x 3. Throws Failure.
std::vector<uint8_t> display_values(const RenderedPicture& picture, const DisplayWish& wish);

/// All channels, for comparisons: copies.
PicturePlanes planes_of(const RenderedPicture& picture);

/// Channels in memory of somebody else's: height x width x channels. Of one channel Y, of two Y and A, of three R, G and B,
/// of four A too.
struct ArrayView {
  const float* values = nullptr;
  int height = 0, width = 0, channels = 0;
};
PicturePlanes planes_of(const ArrayView& array);

}  // namespace whit::python
