#include "core/accuracy/cost_worst.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/accuracy/measures.h"

namespace whit {
namespace {

/// So many things are named.
constexpr size_t kNamed = 8;
/// A pixel is next to an emitter that is within so many pixels.
constexpr int kNear = 2;

/// The number of the shape that each pixel shows, -1 for none; none at all when the look was stopped.
std::vector<float> shapes_seen(CostWorld& world) {
  RenderOptions options;
  options.threads = world.options.threads;
  options.aovs = {{"shape"}, world.options.aovs.place};
  FilmRender look(world.scene(), options);
  look.extend(1u);
  const RenderResult result = look.result();
  for (const AovPicture::Channel& channel : result.aovs.channels) {
    if (channel.name == "shape.id") return channel.values;
  }
  return {};
}

class Namer {
 public:
  Namer(CostWorld& world, const Sources& sources)
      : scene_(world.scene()), sources_(sources), seen_(shapes_seen(world)) {
    for (const ShapeDescription& shape : world.description->shapes)
      plugins_.emplace(std::pair(shape.where.file, shape.where.offset), &shape.plugin);
  }

  /// The shape in a pixel of the window; -1 for none.
  int shape_at(size_t pixel) const { return pixel < seen_.size() ? static_cast<int>(seen_[pixel]) : -1; }
  /// The emitter there, or one that is next to it; -1 for none.
  int light_at(int x, int y, int width, int height) const {
    for (int reach = 0; reach <= kNear; ++reach) {
      for (int j = std::max(0, y - reach); j <= std::min(height - 1, y + reach); ++j) {
        for (int i = std::max(0, x - reach); i <= std::min(width - 1, x + reach); ++i) {
          const int shape = shape_at(static_cast<size_t>(j) * static_cast<size_t>(width) + static_cast<size_t>(i));
          if (shape >= 0 && scene_.shapes[static_cast<size_t>(shape)].emitter >= 0) return shape;
        }
      }
    }
    return -1;
  }
  /// "sphere scene.pbrt:12".
  std::string name(int shape) const {
    if (shape < 0) return "";
    const SourcePos where = scene_.shapes[static_cast<size_t>(shape)].where;
    const auto plugin = plugins_.find({where.file, where.offset});
    return fmt::format("{} {}:{}", plugin == plugins_.end() ? "shape" : *plugin->second, sources_.name(where.file),
                       sources_.place(where).line);
  }

 private:
  const Scene& scene_;
  const Sources& sources_;
  const std::vector<float> seen_;
  std::map<std::pair<uint32_t, uint64_t>, const std::string*> plugins_;
};

}  // namespace

std::vector<double> squared_errors(const CostLevel& level, const Picture& reference) {
  std::vector<double> out(reference.rgb.size() / 3);
  for (const Picture& picture : level.pictures) {
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
      const double off = static_cast<double>(picture.rgb[i]) - static_cast<double>(reference.rgb[i]);
      out[i / 3] += off * off / static_cast<double>(level.pictures.size());
    }
  }
  return out;
}

WorstThings find_worst(CostWorld& world, std::span<const double> squared_errors, const Picture& reference,
                       const Sources& sources) {
  WorstThings out;
  const WorstPixels half = worst_pixels(squared_errors);
  out.half = half.pixels.size();
  if (half.pixels.empty()) return out;
  const Namer namer(world, sources);
  const auto width = static_cast<size_t>(reference.width());
  std::map<std::pair<int, int>, size_t> places;  // shape and light to index into things
  for (size_t i = 0; i < half.pixels.size(); ++i) {
    const size_t pixel = half.pixels[i];
    const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
    const std::pair what(namer.shape_at(pixel), namer.light_at(x, y, reference.width(), reference.height()));
    const auto [place, is_new] = places.emplace(what, out.things.size());
    if (is_new) {
      out.things.push_back({reference.window.min + Vec2i(x, y), 0, namer.name(what.first), namer.name(what.second)});
    }
    out.things[place->second].share += half.shares[i];
  }
  std::stable_sort(out.things.begin(), out.things.end(),
                   [](const CostWorst& a, const CostWorst& b) { return a.share > b.share; });
  out.things.resize(std::min(out.things.size(), kNamed));
  return out;
}

}  // namespace whit
