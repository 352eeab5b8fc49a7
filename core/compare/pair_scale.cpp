#include "core/compare/pair_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/plain_text.h"
#include "core/color/to_linear.h"

namespace whit {
namespace {

bool holds_integers(const ImageInfo& info) {
  return info.format == SampleFormat::UInt8 || info.format == SampleFormat::UInt16;
}

// The colour space of a file's numbers. Integers are for displays where the file says nothing, other numbers
// are light, whatever its primaries are called. Rec709 is what OpenImageIO says of PPM and PFM files, which say nothing.
std::string colour_space(const ImageInfo& info, const std::string& asked) {
  if (!asked.empty() && holds_integers(info)) return lower_case(asked) == "linear" ? "linear" : asked;
  const auto said = info.metadata.find("oiio:ColorSpace");
  const std::string space = said == info.metadata.end() ? "" : lower_case(said->second);
  if (space == "srgb") return "sRGB";
  const bool display = space.rfind("gamma", 0) == 0;
  if (!holds_integers(info)) return display ? space : "linear";
  if (space == "linear" || space == "scene_linear" || space.rfind("lin_", 0) == 0) return "linear";
  return space.empty() || space == "rec709" ? "sRGB" : space;
}

// The planes of a layer's colours, three of them; of fewer the first again.
std::array<std::vector<float>*, 3> colour_planes(PicturePair& pair, const ComparedLayer& layer, Side side) {
  std::array<std::vector<float>*, 3> planes{};
  for (size_t k = 0; k < 3; ++k) {
    ComparedChannel& channel = pair.channels[layer.channels[std::min(k, layer.channels.size() - 1)]];
    planes[k] = side == Side::A ? &channel.a : &channel.b;
  }
  return planes;
}

void make_linear(const ToLinear& transform, Side side, PicturePair& pair) {
  for (const ComparedLayer& layer : pair.layers) {
    if (layer.kind != ChannelKind::Colour) continue;
    auto [r, g, b] = colour_planes(pair, layer, side);
    std::vector<float> more_g = g == r ? *g : std::vector<float>(),
                       more_b = b == g || b == r ? *b : std::vector<float>();
    transform(*r, g == r ? more_g : *g, b == g || b == r ? more_b : *b);
  }
}

// A display's numbers end at 0 and 1: what a picture of light has beyond, the other cannot show.
void cut_to_display(Side side, PicturePair& pair) {
  size_t cut = 0;
  for (const ComparedLayer& layer : pair.layers) {
    if (layer.kind != ChannelKind::Colour) continue;
    for (const size_t c : layer.channels)
      for (float& v : side == Side::A ? pair.channels[c].a : pair.channels[c].b) {
        if (!std::isfinite(v) || (v >= 0 && v <= 1)) continue;
        v = v > 0 ? 1.0f : 0.0f;
        ++cut;
      }
  }
  if (cut > 0)
    pair.notes.push_back(
        fmt::format("{} numbers of {} are beyond 0 and 1, which the other cannot hold, and are cut there", cut,
                    quoted_name(side == Side::A ? pair.a_path : pair.b_path)));
}

void note(PicturePair& pair, std::string_view text) { pair.notes.push_back(fmt::format("{}", text)); }

void note_alpha(PicturePair& pair) {
  if (pair.find("A") && holds_integers(pair.a) != holds_integers(pair.b))
    note(pair, "alpha is not multiplied into the colours of either");
}

void note_primaries(PicturePair& pair) {
  const auto a = pair.a.metadata.find("chromaticities"), b = pair.b.metadata.find("chromaticities");
  if (a != pair.a.metadata.end() && b != pair.b.metadata.end() && a->second != b->second)
    note(pair, "their headers have different primaries (chromaticities); the numbers are compared as they are");
}

}  // namespace

std::string make_alike(const PairRequest& request, PicturePair& pair) {
  const std::string a = colour_space(pair.a, request.colour_space), b = colour_space(pair.b, request.colour_space);
  note_alpha(pair);
  note_primaries(pair);
  if (a == b && a == "linear") return "";
  if (a == b) {
    pair.scale = PairScale::Display;
    pair.notes.push_back(fmt::format("display values ({}) are compared as they are", a));
    return make_to_linear(a).error;
  }
  for (const Side side : {Side::A, Side::B}) {
    const std::string& space = side == Side::A ? a : b;
    if (space == "linear") continue;
    const ToLinearResult to_linear = make_to_linear(space);
    if (!to_linear.error.empty()) return to_linear.error;
    make_linear(to_linear.transform, side, pair);
    pair.notes.push_back(fmt::format("{} is taken from {} to linear light",
                                     quoted_name(side == Side::A ? pair.a_path : pair.b_path), space));
  }
  if (holds_integers(pair.a) != holds_integers(pair.b))
    cut_to_display(holds_integers(pair.a) ? Side::B : Side::A, pair);
  return "";
}

}  // namespace whit
