#include "core/render/aov_film.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/render/cryptomatte.h"

namespace whit {
namespace {

/// Adds to what covers a pixel, sorted by number: the order in which things are met must not be seen in sums of them.
void note(std::vector<Coverage>& coverage, const Coverage& more) {
  const auto before = [](const Coverage& c, uint32_t id) { return c.id < id; };
  auto at = std::lower_bound(coverage.begin(), coverage.end(), more.id, before);
  if (at == coverage.end() || at->id != more.id) at = coverage.insert(at, {more.id, 0, 0});
  add_exactly(at->weight, at->rest, more.weight, more.rest);
}

}  // namespace

AovTile::AovTile(const AovPlan& plan, Vec2i tile, const FilterTable& filter, int size)
    : plan_(plan),
      reach_(tile, filter, size),
      size_(size),
      x0_(tile.x * size),
      y0_(tile.y * size),
      stride_(plan.means + 2),
      sums_(stride_ * reach_.pixels()),
      rests_(sums_.size()) {
  const auto own_pixels = static_cast<size_t>(size * size);
  coverage_.assign(plan.mattes.size(), std::vector<std::vector<Coverage>>(reach_.pixels()));
  distance_.assign(own_pixels, std::numeric_limits<float>::infinity());
  nearest_.resize(own_pixels * (plan.columns.size() - plan.means));
  if (plan.statistics) samples_.resize(own_pixels);
}

void AovTile::add(const SampleChunk& chunk, const uint8_t* usable, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    if (!usable[i]) continue;
    if (plan_.sums()) add_sums(chunk, i);
    if (plan_.nearest() && chunk.ray_weight[i] != 0) add_nearest(chunk, i);
    if (plan_.statistics) ++samples_[own(chunk.px[i], chunk.py[i])];
  }
}

void AovTile::add_sums(const SampleChunk& chunk, int i) {
  const size_t means = plan_.means;
  // A ray that does not reach the film has met nothing.
  const bool met = chunk.met[i] != 0 && chunk.ray_weight[i] != 0;
  reach_.each_reached(chunk.film_x[i], chunk.film_y[i], [&](int pixel, double weight) {
    double* const sums = &sums_[stride_ * static_cast<size_t>(pixel)];
    float* const rests = &rests_[stride_ * static_cast<size_t>(pixel)];
    for (size_t c = 0; c < means; ++c) {
      const bool is_light = plan_.columns[c]->pixel == AovPixel::Mean;
      const double value = chunk.aovs[c][i] * (is_light ? chunk.ray_weight[i] : 1.0f);
      if (is_light || met) add_exactly(sums[c], rests[c], weight * value);
    }
    add_exactly(sums[means], rests[means], weight);
    if (!met) return;
    add_exactly(sums[means + 1], rests[means + 1], weight);
    for (size_t m = 0; m < plan_.mattes.size(); ++m) {
      const auto id = static_cast<uint32_t>(chunk.aovs[plan_.mattes[m]][i]);
      note(coverage_[m][static_cast<size_t>(pixel)], {id, 0, weight});
    }
  });
}

void AovTile::add_nearest(const SampleChunk& chunk, int i) {
  const float dx = chunk.film_x[i] - static_cast<float>(chunk.px[i]) - 0.5f;
  const float dy = chunk.film_y[i] - static_cast<float>(chunk.py[i]) - 0.5f;
  const size_t pixel = own(chunk.px[i], chunk.py[i]), columns = plan_.columns.size() - plan_.means;
  if (!(dx * dx + dy * dy < distance_[pixel])) return;
  distance_[pixel] = dx * dx + dy * dy;
  for (size_t c = 0; c < columns; ++c) nearest_[columns * pixel + c] = chunk.aovs[plan_.means + c][i];
}

const float* AovTile::nearest(int x, int y) const {
  const size_t pixel = own(x, y);
  return std::isfinite(distance_[pixel]) ? &nearest_[(plan_.columns.size() - plan_.means) * pixel] : nullptr;
}

void AovTile::save(ByteWriter& out) const {
  out.numbers(std::span(sums_));
  out.numbers(std::span(rests_));
  for (const auto& matte : coverage_) {
    for (const std::vector<Coverage>& pixel : matte) {
      out.value(static_cast<uint32_t>(pixel.size()));
      for (const Coverage& c : pixel) out.value(c);
    }
  }
  out.numbers(std::span(distance_));
  out.numbers(std::span(nearest_));
  out.numbers(std::span(samples_));
}

void AovTile::restore(ByteReader& in, std::span<const size_t> things) {
  in.numbers(std::span(sums_));
  in.numbers(std::span(rests_));
  each_coverage(in, things, [](std::vector<Coverage>& pixel, const Coverage& c) { pixel.push_back(c); });
  in.numbers(std::span(distance_));
  in.numbers(std::span(nearest_));
  in.numbers(std::span(samples_));
}

/// Calls body(what covers the pixel here, something that was saved of it).
template <class Body>
void AovTile::each_coverage(ByteReader& in, std::span<const size_t> things, const Body& body) {
  for (size_t matte = 0; matte < coverage_.size(); ++matte) {
    for (std::vector<Coverage>& pixel : coverage_[matte]) {
      for (auto n = in.value<uint32_t>(); n > 0 && in.ok(); --n) {
        const auto c = in.value<Coverage>();
        if (c.id >= things[matte]) in.fail();
        body(pixel, c);
      }
    }
  }
}

void AovTile::merge(ByteReader& in, std::span<const size_t> things) {
  std::vector<double> sums(sums_.size());
  std::vector<float> rests(rests_.size()), distance(distance_.size()), nearest(nearest_.size());
  std::vector<int64_t> samples(samples_.size());
  in.numbers(std::span(sums));
  in.numbers(std::span(rests));
  each_coverage(in, things, note);
  in.numbers(std::span(distance));
  in.numbers(std::span(nearest));
  in.numbers(std::span(samples));
  for (size_t i = 0; i < sums.size(); ++i) add_exactly(sums_[i], rests_[i], sums[i], rests[i]);
  const size_t columns = plan_.columns.size() - plan_.means;
  for (size_t pixel = 0; pixel < distance.size(); ++pixel) {
    if (!(distance[pixel] < distance_[pixel])) continue;
    distance_[pixel] = distance[pixel];
    std::copy_n(&nearest[columns * pixel], columns, &nearest_[columns * pixel]);
  }
  for (size_t i = 0; i < samples.size(); ++i) samples_[i] += samples[i];
}

namespace {

/// (integral of f)^2 / integral of f^2 in pixels: the variance of a sum of neighbours over the sum of their variances.
double noise_area(const Filter& filter) {
  constexpr int kSteps = 256;
  double sum = 0, squares = 0;
  for (int y = 0; y < kSteps; ++y)
    for (int x = 0; x < kSteps; ++x) {
      const auto at = [](int i, float radius) { return ((static_cast<float>(i) + 0.5f) / kSteps * 2 - 1) * radius; };
      const auto f = static_cast<double>(filter.evaluate(at(x, filter.x_width), at(y, filter.y_width)));
      sum += f;
      squares += f * f;
    }
  const double step =
      4.0 * static_cast<double>(filter.x_width) * static_cast<double>(filter.y_width) / (kSteps * kSteps);
  return squares > 0 ? sum * sum * step / squares : 1;
}

/// All units as one picture.
class Resolver {
 public:
  Resolver(const Scene& scene, const AovPlan& plan, const std::vector<AovTile>& tiles, const FilmUnits& film,
           const Box2i& window)
      : scene_(scene), plan_(plan), tiles_(tiles), film_(film), window_(window) {}

  AovPicture run(const StatementPlace& place) {
    for (const AovLayer& layer : plan_.layers) {
      const size_t first = add_channels(layer.channels, layer.row->full_float);
      each_pixel([&](Vec2i pixel, size_t at) { resolve(layer, first, pixel, at); });
    }
    size_t matte = 0;
    for (const AovLayer& layer : plan_.layers) {
      if (layer.row->matte) add_matte(layer, matte++, layer.row->names(scene_, place));
    }
    add_camera();
    add_noise();
    return std::move(out_);
  }

 private:
  template <class Body>
  void each_pixel(const Body& body) const {
    const int width = window_.max.x - window_.min.x, height = window_.max.y - window_.min.y;
    tbb::parallel_for(0, height, [&](int row) {
      for (int x = 0; x < width; ++x)
        body(window_.min + Vec2i(x, row),
             static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(x));
    });
  }

  size_t add_channels(const std::vector<std::string>& names, bool full_float) {
    const size_t first = out_.channels.size();
    const Vec2i size = window_.max - window_.min;
    for (const std::string& name : names) {
      out_.channels.push_back(
          {name, full_float, std::vector<float>(static_cast<size_t>(size.x) * static_cast<size_t>(size.y))});
    }
    return first;
  }

  /// The unit whose own samples a pixel's are; null where none is rendered.
  const AovTile* own_tile(Vec2i pixel) const {
    const int unit = film_.grid.own_unit(pixel);
    return unit < 0 ? nullptr : &tiles_[static_cast<size_t>(unit)];
  }

  void resolve(const AovLayer& layer, size_t first, Vec2i pixel, size_t at) {
    std::vector<float> value(layer.channels.size(), layer.row->nothing);
    if (layer.row->pixel == AovPixel::Statistic) {
      const AovTile* const tile = own_tile(pixel);
      PixelStatistics of;
      if (tile) of.n = tile->samples(pixel.x, pixel.y);
      if (plan_.blocks) of.variance = block_variance(film_, pixel) * (double{film_scale()} * double{film_scale()});
      layer.row->statistic(of, value.data());
    } else if (layer.row->pixel == AovPixel::Nearest) {
      const AovTile* const tile = own_tile(pixel);
      const float* const nearest = tile ? tile->nearest(pixel.x, pixel.y) : nullptr;
      const size_t column = static_cast<size_t>(layer.column) - plan_.means;
      if (nearest) std::copy_n(nearest + column, value.size(), value.begin());
    } else {
      mean(layer, pixel, value);
    }
    for (size_t c = 0; c < value.size(); ++c) out_.channels[first + c].values[at] = value[c];
  }

  float film_scale() const { return static_cast<float>(scene_.film().scale()); }

  void mean(const AovLayer& layer, Vec2i pixel, std::vector<float>& value) const {
    const size_t n = value.size(), means = plan_.means;
    std::vector<double> sum(n, 0.0);
    double all = 0, met = 0;
    film_.each_around(pixel, [&](size_t unit) {
      if (!tiles_[unit].reaches(pixel.x, pixel.y)) return;
      const auto of = [&](size_t column) { return film_.weight(unit) * tiles_[unit].sum(pixel.x, pixel.y, column); };
      for (size_t c = 0; c < n; ++c) sum[c] += of(static_cast<size_t>(layer.column) + c);
      all += of(means), met += of(means + 1);
    });
    double weight = layer.row->pixel == AovPixel::Mean ? all : met;
    if (layer.row->pixel == AovPixel::SurfaceDirection)
      weight = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    const double scale = layer.row->pixel == AovPixel::Mean ? static_cast<double>(film_scale()) : 1.0;
    for (size_t c = 0; c < n; ++c) value[c] = weight != 0 ? static_cast<float>(sum[c] / weight * scale) : 0.0f;
  }

  /// What covers a pixel, by its share of the weights of all samples, the largest first. Things of one name are one.
  std::vector<Coverage> ranks(size_t matte, const std::vector<uint32_t>& hash_of, Vec2i pixel) const {
    std::vector<Coverage> found;
    double all = 0;
    film_.each_around(pixel, [&](size_t unit) {
      const AovTile& tile = tiles_[unit];
      if (!tile.reaches(pixel.x, pixel.y)) return;
      const double w = film_.weight(unit);
      all += w * tile.sum(pixel.x, pixel.y, plan_.means);
      for (const Coverage& c : tile.coverage(matte, pixel.x, pixel.y))
        note(found, {hash_of[c.id], 0, w * (c.weight + static_cast<double>(c.rest))});
    });
    for (Coverage& c : found) c.weight = all != 0 ? (c.weight + static_cast<double>(c.rest)) / all : 0;
    // Weights of some filters are negative, and so may be a sum of few.
    std::erase_if(found, [](const Coverage& c) { return !(c.weight > 0); });
    std::sort(found.begin(), found.end(), [](const Coverage& a, const Coverage& b) {
      return a.weight != b.weight ? a.weight > b.weight : a.id < b.id;
    });
    return found;
  }

  /// Three layers of two ranks each: six things cover a pixel at most.
  void add_matte(const AovLayer& layer, size_t matte, const std::vector<IdName>& names) {
    constexpr size_t kRanks = 6;
    std::vector<uint32_t> hash_of;
    for (const IdName& n : names) hash_of.push_back(matte_id(n.name));
    std::vector<std::string> channels;
    for (size_t rank = 0; rank < kRanks; rank += 2) {
      for (const char c : {'r', 'g', 'b', 'a'})
        channels.push_back(fmt::format("{}{:02}.{}", layer.row->matte, rank / 2, c));
    }
    const size_t first = add_channels(channels, true);
    each_pixel([&](Vec2i pixel, size_t at) {
      const std::vector<Coverage> found = ranks(matte, hash_of, pixel);
      for (size_t r = 0; r < std::min(found.size(), kRanks); ++r) {
        out_.channels[first + 2 * r].values[at] = matte_float(found[r].id);
        out_.channels[first + 2 * r + 1].values[at] = static_cast<float>(found[r].weight);
      }
    });
    out_.seen.push_back(numbers_seen(matte));
  }

  /// What is in the picture, of whatever number of things there may be in the scene.
  std::set<uint32_t> numbers_seen(size_t matte) const {
    std::set<uint32_t> seen;
    for (int y = window_.min.y; y < window_.max.y; ++y) {
      for (int x = window_.min.x; x < window_.max.x; ++x) {
        film_.each_around({x, y}, [&](size_t unit) {
          if (!tiles_[unit].reaches(x, y)) return;
          for (const Coverage& c : tiles_[unit].coverage(matte, x, y)) seen.insert(c.id);
        });
      }
    }
    return seen;
  }

  /// OpenEXR's standard attributes; of a camera that moves, when the transforms' interval begins.
  void add_camera() {
    const Mat4d to_camera = scene_.space.from_world() * scene_.camera_keys.front().inverse();
    out_.matrices.push_back({"worldToCamera", Imath::M44f(to_camera)});
    if (const std::optional<Mat4d> to_ndc = scene_.camera().to_ndc())
      out_.matrices.push_back({"worldToNDC", Imath::M44f(to_camera * *to_ndc)});
  }

  /// What `whit diff --noise` wants to know of variances: how well each is known, and how many pixels have noise in common.
  void add_noise() {
    if (!plan_.blocks) return;
    out_.header.push_back({"whit:varianceFreedom", TileSums::kBlocks - 1});
    out_.header.push_back({"whit:filterArea", static_cast<float>(noise_area(scene_.filter()))});
  }

  const Scene& scene_;
  const AovPlan& plan_;
  const std::vector<AovTile>& tiles_;
  const FilmUnits& film_;
  const Box2i window_;
  AovPicture out_;
};

/// The manifest of a matte, and what its numbers stand for.
std::vector<OutputMetadata> header_of(const AovRow& row, const std::vector<IdName>& names,
                                      const std::set<uint32_t>& seen) {
  std::vector<std::string> manifest;
  std::string numbers;
  for (const uint32_t id : seen) {
    manifest.push_back(names[id].name);
    numbers += fmt::format("{}\"{}\":{{\"name\":{},\"where\":{}}}", numbers.empty() ? "{" : ",", id,
                           json_text(names[id].name), json_text(names[id].where));
  }
  std::vector<OutputMetadata> header = matte_header(row.matte, manifest);
  header.push_back({fmt::format("whit:{}s", row.name), numbers.empty() ? "{}" : numbers + "}"});
  return header;
}

}  // namespace

void set_matte_headers(const Scene& scene, const AovPlan& plan, const StatementPlace& place, AovPicture& picture) {
  size_t matte = 0;
  for (const AovLayer& layer : plan.layers) {
    if (!layer.row->matte) continue;
    for (OutputMetadata& item : header_of(*layer.row, layer.row->names(scene, place), picture.seen.at(matte++))) {
      std::erase_if(picture.header, [&](const OutputMetadata& old) { return old.name == item.name; });
      picture.header.push_back(std::move(item));
    }
  }
}

AovPicture resolve_aovs(const Scene& scene, const AovPlan& plan, const StatementPlace& place,
                        const std::vector<AovTile>& tiles, const FilmUnits& film, const Box2i& window) {
  AovPicture picture = Resolver(scene, plan, tiles, film, window).run(place);
  set_matte_headers(scene, plan, place, picture);
  return picture;
}

}  // namespace whit
