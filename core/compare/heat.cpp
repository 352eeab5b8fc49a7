#include "core/compare/heat.h"

#include <algorithm>
#include <cmath>

namespace whit {

std::vector<float> difference_of(const PicturePair& pair, const std::vector<size_t>& channels, HeatSign sign) {
  std::vector<float> out(pair.pixels());
  const float weight = channels.empty() ? 0 : 1 / static_cast<float>(channels.size());
  for (const size_t c : channels) {
    const ComparedChannel& channel = pair.channels[c];
    const bool data = channel.kind != ChannelKind::Colour;
    for (size_t i = 0; i < out.size(); ++i) {
      const float a = channel.a[i], b = channel.b[i], d = a - b;
      // Depths say "nothing there" by infinity. Of colours no infinity is as it should be.
      if (data && a == b) continue;
      out[i] += std::isfinite(d) ? weight * (sign == HeatSign::Absolute ? std::abs(d) : d) : NAN;
    }
  }
  return out;
}

std::vector<size_t> shown_channels(const PicturePair& pair) {
  if (const ComparedLayer* beauty = pair.beauty()) return beauty->channels;
  std::vector<size_t> all, numbers;
  for (const ComparedLayer& layer : pair.layers)
    for (const size_t c : layer.channels) {
      all.push_back(c);
      if (layer.kind != ChannelKind::Id) numbers.push_back(c);
    }
  return numbers.empty() ? all : numbers;
}

double heat_scale(std::span<const float> difference) {
  std::vector<float> sizes;
  for (const float d : difference)
    if (std::isfinite(d)) sizes.push_back(std::abs(d));
  if (sizes.empty()) return 1;
  const auto at = sizes.end() - 1 - static_cast<ptrdiff_t>(sizes.size() / 1000);
  std::nth_element(sizes.begin(), at, sizes.end());
  const float most = *at > 0 ? *at : *std::max_element(sizes.begin(), sizes.end());
  return most > 0 ? double{most} : 1;
}

const ColourMap& heat_map(HeatSign sign) { return sign == HeatSign::Absolute ? kMagma : kBerlin; }

ByteColour heat_colour(double difference, HeatSign sign, double full) {
  if (std::isnan(difference)) return kNanColour;
  const double t = sign == HeatSign::Absolute ? difference / full : 0.5 + 0.5 * difference / full;
  return heat_map(sign)[static_cast<size_t>(std::lround(255 * std::clamp(t, 0.0, 1.0)))];
}

}  // namespace whit
