#include "core/author/colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/spectrum.h"
#include "core/color/srgb.h"
#include "parser/include.h"
#include "parser/lexer.h"

namespace whit::author {
namespace {

/// Digits that matter: the picture of a colour has fewer.
std::string digits(double v) { return fmt::format("{:g}", std::round(v * 1e5) / 1e5); }

}  // namespace

std::optional<RGB> colour_of(const Parameter& p, const std::string& folder) {
  const std::vector<double>& v = p.numbers();
  switch (p.type) {
    case ParamType::Rgb:
      if (v.size() != 3) return std::nullopt;
      return RGB(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
    case ParamType::Xyz:
      if (v.size() != 3) return std::nullopt;
      return rgb_from_xyz(v[0], v[1], v[2]);
    case ParamType::Blackbody:
      if (v.size() != 2 || !(v[0] > 0)) return std::nullopt;
      return rgb_from_blackbody(v[0], v[1]);
    case ParamType::Spectrum: break;
    default: return std::nullopt;
  }
  if (v.size() >= 2 && v.size() % 2 == 0) return rgb_from_samples(v);
  if (p.strings().size() != 1) return std::nullopt;
  const SpdFile file = read_spd_file(join_path(folder, p.strings().front()));
  if (!file.error.empty() || file.pairs.size() < 2) return std::nullopt;
  return rgb_from_samples(file.pairs);
}

ShownColour shown(const RGB& c) {
  const float brightest = std::max({c.x, c.y, c.z});
  const float scale = std::isfinite(brightest) ? std::max(1.0f, brightest) : 1.0f;
  const auto encoded = [scale](float v) { return static_cast<double>(srgb_encode(v / scale)); };
  return {encoded(c.x), encoded(c.y), encoded(c.z), static_cast<double>(scale)};
}

std::string srgb_hex(const RGB& colour) {
  const ShownColour s = shown(colour);
  const auto byte = [](double v) { return static_cast<int>(std::lround(v * 255)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(s.red), byte(s.green), byte(s.blue));
}

std::string written(double red, double green, double blue, double scale) {
  const auto number = [scale](double v) { return digits(srgb_decode(std::clamp(v, 0.0, 1.0)) * scale); };
  return fmt::format("{} {} {}", number(red), number(green), number(blue));
}

std::vector<ColourAt> colours_in(const File& file, Span span) {
  std::vector<ColourAt> out;
  const std::vector<Item>& items = file.index.items();
  const size_t first = file.index.item_at(span.begin);
  Statement s;
  for (size_t i = first == items.size() ? 0 : first; i < items.size() && items[i].at.begin < span.end; ++i) {
    if (!items[i].row || !items[i].row->arguments.parameters) continue;
    // Only a colour's declaration has one of these words; most statements have neither, and need not be read.
    const std::string_view text = file.text().substr(items[i].at.begin, items[i].at.size());
    if (text.find("rgb") == std::string_view::npos && text.find("color") == std::string_view::npos) continue;
    if (!read_at(file.text(), items[i].at.begin, s)) continue;
    for (const Parameter& p : s.parameters) {
      if (p.type != ParamType::Rgb || p.numbers().size() != 3) continue;
      const std::vector<Span> at = value_spans(file.text(), p);
      if (at.size() == 3) out.push_back({{at.front().begin, at.back().end}, *colour_of(p, "")});
    }
  }
  return out;
}

}  // namespace whit::author
