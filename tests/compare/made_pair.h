// Pairs of pictures made by hand, for tests of what tells of them.
#pragma once

#include <functional>

#include "core/compare/pair.h"

namespace whit::test {

/// The value of a channel at a pixel.
using PixelOf = std::function<double(int x, int y, int channel)>;

/// Two pictures of R, G and B, of floats.
inline PicturePair made_pair(int width, int height, const PixelOf& a, const PixelOf& b) {
  PicturePair pair;
  pair.a_path = "out/made.exr";
  pair.b_path = "ref/made.exr";
  pair.window = {{0, 0}, {width - 1, height - 1}};
  for (ImageInfo* info : {&pair.a, &pair.b}) {
    info->width = info->full_width = width;
    info->height = info->full_height = height;
    info->channels = 3;
    info->channel_names = {"R", "G", "B"};
  }
  pair.layers.push_back({"", ChannelKind::Colour, {0, 1, 2}});
  for (int c = 0; c < 3; ++c) {
    ComparedChannel channel;
    channel.name = std::string(1, "RGB"[c]);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        channel.a.push_back(static_cast<float>(a(x, y, c)));
        channel.b.push_back(static_cast<float>(b(x, y, c)));
      }
    pair.channels.push_back(std::move(channel));
  }
  return pair;
}

/// One more layer, of the same size.
inline void add_layer(PicturePair& pair, const std::string& name, ChannelKind kind,
                      const std::vector<std::string>& channels, const PixelOf& a, const PixelOf& b) {
  ComparedLayer layer{name, kind, {}};
  for (size_t c = 0; c < channels.size(); ++c) {
    layer.channels.push_back(pair.channels.size());
    ComparedChannel channel;
    channel.name = channels[c];
    channel.kind = kind;
    for (int y = 0; y < pair.height(); ++y)
      for (int x = 0; x < pair.width(); ++x) {
        channel.a.push_back(static_cast<float>(a(x, y, static_cast<int>(c))));
        channel.b.push_back(static_cast<float>(b(x, y, static_cast<int>(c))));
      }
    pair.channels.push_back(std::move(channel));
  }
  pair.layers.push_back(std::move(layer));
}

}  // namespace whit::test
