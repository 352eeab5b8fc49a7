#include "core/compare/pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/plain_text.h"
#include "core/compare/pair_scale.h"

namespace whit {
namespace {

// ---- Channels ----

std::string joined(const std::vector<std::string>& names) {
  constexpr size_t kMost = 12;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), kMost); ++i) text.append(i ? ", " : "").append(names[i]);
  return names.size() > kMost ? fmt::format("{} and {} more", text, names.size() - kMost) : text;
}

std::vector<std::string> chosen_names(const ImageInfo& info, const std::string& patterns) {
  std::vector<std::string> names;
  for (const std::string& name : info.channel_names)
    if (matches_any(patterns, name)) names.push_back(name);
  return names;
}

std::vector<std::string> without(const std::vector<std::string>& names, const std::vector<std::string>& others) {
  std::vector<std::string> left;
  for (const std::string& name : names)
    if (std::find(others.begin(), others.end(), name) == others.end()) left.push_back(name);
  return left;
}

// The first pattern that chooses nothing of either.
std::string unused_pattern(const ImageInfo& a, const ImageInfo& b, const std::string& patterns) {
  for (const std::string& pattern : split_patterns(patterns)) {
    const std::string chosen = pattern[0] == '!' ? pattern.substr(1) : pattern;
    const auto used = [&](const ImageInfo& info) {
      return std::any_of(info.channel_names.begin(), info.channel_names.end(),
                         [&](const std::string& name) { return matches(chosen, name); });
    };
    if (!used(a) && !used(b)) return chosen;
  }
  return "";
}

// What one picture has and the other lacks, or "".
std::string channel_problem(const ImageInfo& a, const ImageInfo& b, const PicturePair& pair,
                            const PairRequest& request) {
  const std::vector<std::string> of_a = chosen_names(a, request.channels), of_b = chosen_names(b, request.channels);
  const std::vector<std::string> only_a = without(of_a, of_b), only_b = without(of_b, of_a);
  std::vector<std::string> both = without(of_a, only_a);
  if (const std::string unused = unused_pattern(a, b, request.channels); !unused.empty())
    return fmt::format("no channel is called {}: {} has {}", unused, quoted_name(pair.a_path), joined(a.channel_names));
  if (only_a.empty() && only_b.empty())
    return both.empty() ? fmt::format("--channels '{}' leaves no channel", request.channels) : "";
  std::string text = "they have not the same channels: ";
  if (!only_a.empty()) text.append(quoted_name(pair.a_path)).append(" alone has ").append(joined(only_a));
  if (!only_a.empty() && !only_b.empty()) text.append(", ");
  if (!only_b.empty()) text.append(quoted_name(pair.b_path)).append(" alone has ").append(joined(only_b));
  if (both.empty()) return text;
  std::string patterns;
  for (const std::string& name : both) {
    const std::string layer = layer_of(name), pattern = layer.empty() ? name : layer + ".*";
    if (!matches_any(patterns, pattern) || patterns.empty())
      patterns.append(patterns.empty() ? "" : ",").append(pattern);
  }
  return text.append("; --channels '").append(patterns).append("' compares what both have");
}

// ---- Windows ----

std::string size_text(const ImageInfo& info) { return fmt::format("{} x {}", info.full_width, info.full_height); }

// In per cent, of the display window.
double share_of_picture(const PicturePair& pair) {
  return 100 * static_cast<double>(pair.pixels()) / (static_cast<double>(pair.a.full_width) * pair.a.full_height);
}

// Finds the pixels that both have and are asked for. "" or why there are none.
std::string choose_window(const PairRequest& request, PicturePair& pair) {
  if (pair.a.full_width != pair.b.full_width || pair.a.full_height != pair.b.full_height)
    return fmt::format("they have different sizes: {} is {}, {} is {} pixels", quoted_name(pair.a_path),
                       size_text(pair.a), quoted_name(pair.b_path), size_text(pair.b));
  const Box2i a = data_window(pair.a), b = data_window(pair.b);
  const auto common = [](const Box2i& one, const Box2i& other) {
    return Box2i({std::max(one.min.x, other.min.x), std::max(one.min.y, other.min.y)},
                 {std::min(one.max.x, other.max.x), std::min(one.max.y, other.max.y)});
  };
  pair.window = common(a, b);
  if (pair.window.isEmpty())
    return fmt::format("they have no pixel in common: {} has {}, {} has {}", quoted_name(pair.a_path), window_text(a),
                       quoted_name(pair.b_path), window_text(b));
  if (a != b)
    pair.notes.push_back(fmt::format("compared where both have pixels, {:.3g} % of {}: {} has {}, {} has {}",
                                     share_of_picture(pair), size_text(pair.a), quoted_name(pair.a_path),
                                     window_text(a), quoted_name(pair.b_path), window_text(b)));
  if (pair.a.full_x != pair.b.full_x || pair.a.full_y != pair.b.full_y)
    pair.notes.emplace_back("their display windows begin at different places; compared by their upper left corners");
  if (!request.crop) return "";
  const Box2i cropped = common(pair.window, request.window);
  if (cropped.isEmpty()) return fmt::format("the crop has no pixel of theirs: they have {}", window_text(pair.window));
  pair.window = cropped;
  pair.cropped = true;
  pair.notes.emplace_back("compared only " + window_text(cropped));
  return "";
}

// A plane's pixels of the window; all of a plane is moved, not copied.
std::vector<float> cut(std::vector<float>& plane, const ImageInfo& info, const Box2i& window) {
  const Box2i all = data_window(info);
  if (all == window) return std::move(plane);
  const int width = window.max.x - window.min.x + 1;
  std::vector<float> part;
  part.reserve(static_cast<size_t>(width) * static_cast<size_t>(window.max.y - window.min.y + 1));
  for (int y = window.min.y; y <= window.max.y; ++y) {
    const auto row = plane.begin() + static_cast<ptrdiff_t>(y - all.min.y) * info.width + (window.min.x - all.min.x);
    part.insert(part.end(), row, row + width);
  }
  return part;
}

// ---- Layers ----

// R before G before B, whatever the order in the file.
int colour_rank(const std::string& name) {
  constexpr std::string_view kOrder = "RGBrgb";
  const size_t at = kOrder.find(name.back());
  return at == std::string_view::npos ? 9 : static_cast<int>(at % 3);
}

bool is_chosen(const ComparedChannel& channel, const PairRequest& request) {
  const std::vector<std::string> patterns = split_patterns(request.channels);
  const bool named = std::any_of(patterns.begin(), patterns.end(), [](auto& pattern) { return pattern[0] != '!'; });
  if (channel.kind == ChannelKind::Statistic)
    return request.statistics || (named && matches_any(request.channels, channel.name));
  return matches_any(request.channels, channel.name);
}

void make_layers(const PairRequest& request, PicturePair& pair) {
  std::map<std::pair<std::string, ChannelKind>, std::vector<size_t>> found;
  std::map<std::string, std::set<ChannelKind>> kinds;
  for (size_t c = 0; c < pair.channels.size(); ++c) {
    const ComparedChannel& channel = pair.channels[c];
    if (!is_chosen(channel, request)) continue;
    // A coordinate without a layer is one of its own: Z and A have nothing in common.
    const std::string layer = layer_of(channel.name);
    const bool alone = layer.empty() && channel.kind != ChannelKind::Colour;
    found[{alone ? channel.name : layer, channel.kind}].push_back(c);
    kinds[alone ? channel.name : layer].insert(channel.kind);
  }
  for (auto& [key, channels] : found) {
    const auto& [name, kind] = key;
    std::stable_sort(channels.begin(), channels.end(), [&](size_t l, size_t r) {
      return colour_rank(pair.channels[l].name) < colour_rank(pair.channels[r].name);
    });
    const bool only_kind = kinds[name].size() == 1 || kind == ChannelKind::Colour;
    pair.layers.push_back({only_kind ? name : pair.channels[channels[0]].name, kind, channels});
  }
}

std::vector<ComparedChannel> take_channels(PicturePlanes& a, PicturePlanes& b, const Box2i& window) {
  std::vector<ComparedChannel> channels;
  for (size_t c = 0; c < a.channel_names.size(); ++c) {
    const std::string& name = a.channel_names[c];
    const int other = b.channel(name);
    if (other < 0) continue;
    const auto in_b = static_cast<size_t>(other);
    channels.push_back({name, channel_kind(name), a.formats[c], b.formats[in_b], cut(a.planes[c], a, window),
                        cut(b.planes[in_b], b, window)});
  }
  return channels;
}

}  // namespace

Box2i data_window(const ImageInfo& info) {
  const Vec2i corner(info.x - info.full_x, info.y - info.full_y);
  return {corner, corner + Vec2i(info.width - 1, info.height - 1)};
}

std::string window_text(const Box2i& box) {
  return fmt::format("x {} to {}, y {} to {}", box.min.x, box.max.x, box.min.y, box.max.y);
}

const ComparedChannel* PicturePair::find(const std::string& name) const {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](auto& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

const ComparedLayer* PicturePair::beauty() const {
  // A layer without a name is before all others.
  const auto found = std::find_if(layers.begin(), layers.end(),
                                  [](const ComparedLayer& layer) { return layer.kind == ChannelKind::Colour; });
  return found == layers.end() ? nullptr : &*found;
}

Result<PicturePair> make_pair_of(PicturePlanes a, PicturePlanes b, const std::string& a_path, const std::string& b_path,
                                 const PairRequest& request) {
  Result<PicturePair> result;
  PicturePair& pair = result.value;
  pair.a_path = a_path;
  pair.b_path = b_path;
  pair.a = a;
  pair.b = b;
  result.error = choose_window(request, pair);
  if (result.error.empty()) result.error = channel_problem(a, b, pair, request);
  if (!result.error.empty()) return result;
  pair.channels = take_channels(a, b, pair.window);
  make_layers(request, pair);
  if (pair.layers.empty())
    result.error = "they have statistics of samples alone, which are no picture; --channels '*' compares them";
  if (result.error.empty()) result.error = make_alike(request, pair);
  return result;
}

Result<PicturePair> read_pair(const std::string& a, const std::string& b, const PairRequest& request) {
  Result<PicturePlanes> of_a = read_planes(a), of_b = read_planes(b);
  for (const auto* one : {&of_a, &of_b})
    if (!one->ok()) return {{}, one->error};
  return make_pair_of(std::move(of_a.value), std::move(of_b.value), a, b, request);
}

std::vector<float> interleaved_colours(const PicturePair& pair, Side side) {
  const ComparedLayer* beauty = pair.beauty();
  if (!beauty) return {};
  std::vector<float> rgb(3 * pair.pixels());
  for (size_t k = 0; k < 3; ++k) {
    const ComparedChannel& channel = pair.channels[beauty->channels[std::min(k, beauty->channels.size() - 1)]];
    const std::vector<float>& plane = side == Side::A ? channel.a : channel.b;
    for (size_t i = 0; i < plane.size(); ++i) rgb[3 * i + k] = plane[i];
  }
  return rgb;
}

}  // namespace whit
