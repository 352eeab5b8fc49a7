// From the numbers of a colour space to linear light: what comparing a display picture with a linear one needs.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace whit {

/// Takes three planes of as many numbers each to linear light, in place.
using ToLinear = std::function<void(std::span<float> r, std::span<float> g, std::span<float> b)>;

struct ToLinearResult {
  ToLinear transform;
  std::string error;  ///< Names the spaces that there are.
};

/// Of "linear", "sRGB", "Rec709", "gamma=2.2" (letters of any case), or a colour space or role of the config that $OCIO names.
ToLinearResult make_to_linear(const std::string& space);

}  // namespace whit
