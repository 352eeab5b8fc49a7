#include "tools/whit/terminal_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace whit {
namespace {

constexpr int kLevels = 6;  ///< Of each channel, in sixels.

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k) three = three << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += k <= n ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

/// The number of the nearest of 216 colours, with a pattern that neighbours make up for one another by.
int colour_of(const uint8_t* rgb, int x, int y) {
  constexpr std::array<std::array<int, 4>, 4> kPattern{
      {{{0, 8, 2, 10}}, {{12, 4, 14, 6}}, {{3, 11, 1, 9}}, {{15, 7, 13, 5}}}};
  const double shift = (kPattern[static_cast<size_t>(y & 3)][static_cast<size_t>(x & 3)] + 0.5) / 16;
  int colour = 0;
  for (int c = 0; c < 3; ++c) {
    const int level = static_cast<int>(rgb[c] / 255.0 * (kLevels - 1) + shift);
    colour = colour * kLevels + std::min(level, kLevels - 1);
  }
  return colour;
}

/// The same character many times, as sixels write it.
void add_run(std::string& out, char sixel, int n) {
  if (n > 3) out += fmt::format("!{}{}", n, sixel);
  else out.append(static_cast<size_t>(n), sixel);
}

}  // namespace

TerminalPicture resampled(const TerminalPicture& picture, int width, int height) {
  if (width == picture.width && height == picture.height) return picture;
  TerminalPicture out{width, height,
                      std::vector<uint8_t>(3 * static_cast<size_t>(width) * static_cast<size_t>(height))};
  const auto edge = [](int i, int to, int from) { return static_cast<int>(int64_t{i} * from / to); };
  for (int y = 0; y < height; ++y) {
    const int y0 = edge(y, height, picture.height), y1 = std::max(edge(y + 1, height, picture.height), y0 + 1);
    for (int x = 0; x < width; ++x) {
      const int x0 = edge(x, width, picture.width), x1 = std::max(edge(x + 1, width, picture.width), x0 + 1);
      std::array<int, 3> sum{};
      for (int v = y0; v < y1; ++v) {
        for (int u = x0; u < x1; ++u) {
          for (size_t c = 0; c < 3; ++c)
            sum[c] +=
                picture.rgb[3 * (static_cast<size_t>(v) * static_cast<size_t>(picture.width) + static_cast<size_t>(u)) +
                            c];
        }
      }
      const int n = (x1 - x0) * (y1 - y0);
      for (size_t c = 0; c < 3; ++c)
        out.rgb[3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) + c] =
            static_cast<uint8_t>((sum[c] + n / 2) / n);
    }
  }
  return out;
}

std::string as_blocks(const TerminalPicture& picture) {
  std::string out;
  const auto at = [&](int x, int y) {
    return &picture.rgb[3 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x))];
  };
  for (int y = 0; y < picture.height; y += 2) {
    std::string last;
    for (int x = 0; x < picture.width; ++x) {
      const uint8_t* above = at(x, y);
      std::string colours = fmt::format("\033[38;2;{};{};{}", above[0], above[1], above[2]);
      if (y + 1 < picture.height) {
        const uint8_t* below = at(x, y + 1);
        colours += fmt::format(";48;2;{};{};{}", below[0], below[1], below[2]);
      }
      colours += "m";
      if (colours != last) out += colours;
      last = std::move(colours);
      out += "▀";
    }
    out += "\033[0m\n";
  }
  return out;
}

std::string as_kitty(const TerminalPicture& picture) {
  constexpr size_t kPiece = 4096;
  const std::string data = base64({reinterpret_cast<const char*>(picture.rgb.data()), picture.rgb.size()});
  std::string out;
  for (size_t at = 0; at < data.size(); at += kPiece) {
    const int more = at + kPiece < data.size() ? 1 : 0;
    // The same number each time: a picture takes the place of the one before. Without an answer (q=2).
    if (at == 0) out += fmt::format("\033_Ga=T,f=24,i=1,p=1,q=2,s={},v={},m={};", picture.width, picture.height, more);
    else out += fmt::format("\033_Gm={};", more);
    out += data.substr(at, kPiece) + "\033\\";
  }
  return out + "\n";
}

std::string as_sixels(const TerminalPicture& picture) {
  std::string out = fmt::format("\033Pq\"1;1;{};{}", picture.width, picture.height);
  for (int i = 0; i < kLevels * kLevels * kLevels; ++i)
    out += fmt::format("#{};2;{};{};{}", i, i / 36 * 20, i / 6 % 6 * 20, i % 6 * 20);
  std::vector<int> colours(static_cast<size_t>(picture.width) * 6);
  for (int top = 0; top < picture.height; top += 6) {
    const int rows = std::min(6, picture.height - top);
    std::array<bool, kLevels * kLevels * kLevels> used{};
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const size_t pixel = static_cast<size_t>(top + y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x);
        const int colour = colour_of(&picture.rgb[3 * pixel], x, top + y);
        colours[static_cast<size_t>(x) * 6 + static_cast<size_t>(y)] = colour;
        used[static_cast<size_t>(colour)] = true;
      }
    }
    for (int colour = 0; colour < static_cast<int>(used.size()); ++colour) {
      if (!used[static_cast<size_t>(colour)]) continue;
      out += fmt::format("#{}", colour);
      char last = 0;
      int n = 0;
      for (int x = 0; x < picture.width; ++x) {
        int bits = 0;
        for (int y = 0; y < rows; ++y)
          bits |= (colours[static_cast<size_t>(x) * 6 + static_cast<size_t>(y)] == colour) << y;
        const char sixel = static_cast<char>('?' + bits);
        if (n > 0 && sixel != last) add_run(out, last, n), n = 0;
        last = sixel, ++n;
      }
      add_run(out, last, n);
      out += '$';
    }
    out += '-';
  }
  return out + "\033\\\n";
}

}  // namespace whit
