// Films: the size of the picture, what of it is rendered, and where it goes.
#pragma once

#include "core/plugin/param.h"

namespace whit {

class Film : public Plugin {
 public:
  static constexpr const char* kCategory = "film";
  virtual Vec2i resolution() const = 0;
  /// The rendered part as fractions (x0, x1, y0, y1) of the full picture.
  virtual void crop_window(double out[4]) const = 0;
  virtual double diagonal_metres() const = 0;
  virtual double scale() const = 0;
  virtual double max_sample_luminance() const = 0;
  virtual const std::string& file_name() const = 0;
  virtual const std::string& view() const = 0;  ///< Display view of the 8-bit picture; "" for the default.
  virtual double exposure() const = 0;          ///< Stops, before the view.
  virtual const StringList& aovs() const = 0;   ///< What else the file holds, by name.
};

}  // namespace whit
