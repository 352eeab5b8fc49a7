// The pictures that goniometric and projection lights read.
#pragma once

#include "core/batch/lanes.h"
#include "core/image/texels.h"
#include "core/plugin/memory_need.h"
#include "core/plugin/param.h"
#include "core/plugin/plugin.h"

namespace whit {

class ImageTexture;

/// A picture that a point of light throws or is measured by: neither flipped nor decoded, bilinear, as in pbrt-v3.
class LightMap {
 public:
  /// Reads the header of the file, or does nothing when there is none. Returns false after reporting an error.
  bool prepare(const PrepareContext& ctx, const FileName& file, WrapMode wrap);
  /// What preparing it will come to.
  static MemoryNeed need(const FileName& file, WrapMode wrap);
  explicit operator bool() const { return image_ != nullptr; }
  double aspect() const { return aspect_; }  ///< Width over height of the picture; 1 when there is none.
  /// Colours at n places of the unit square, (0, 0) being the upper left corner; numbers that are negative or not
  /// finite are 0.
  void look_up(int n, const float* s, const float* t, const RGBLanes& out) const;
  /// The mean of the picture, which is read for it; there must be one.
  RGB mean() const;

 private:
  const ImageTexture* image_ = nullptr;
  double aspect_ = 1;
};

}  // namespace whit
