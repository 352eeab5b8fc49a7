// The filters of MipMap, one point at a time inside loops over a batch.
#ifdef __F16C__
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/base/fastmath.h"
#include "core/image/mipmap.h"

namespace whit {
namespace {

constexpr int kWeights = 128;

// exp(-2 r^2) - exp(-2): a Gaussian that reaches 0 on the ellipse, tabulated over r^2 in [0, 1); 0 from there on.
const std::array<float, kWeights + 1>& ewa_weights() {
  static const std::array<float, kWeights + 1> table = [] {
    std::array<float, kWeights + 1> w{};
    for (int i = 0; i < kWeights; ++i)
      w[i] = std::exp(-2.0f * (static_cast<float>(i) / (kWeights - 1))) - std::exp(-2.0f);
    return w;
  }();
  return table;
}

// Index i of a side of n texels, n a power of two; -1 stands for black.
template <WrapMode W>
int wrap_texel(int i, int n) {
  if constexpr (W == WrapMode::Repeat) return i & (n - 1);
  if constexpr (W == WrapMode::Clamp) return std::clamp(i, 0, n - 1);
  if constexpr (W == WrapMode::Black) return i >= 0 && i < n ? i : -1;
}

// One texel as the processor adds it: three channels in a vector of four (a GCC and Clang extension), or one alone.
using Vector4 = float __attribute__((vector_size(16)));
template <int C>
using Texel = std::conditional_t<C == 1, float, Vector4>;

template <int C>
std::array<float, C> to_value(const Texel<C>& t) {
  if constexpr (C == 1) return {t};
  else return {t[0], t[1], t[2]};
}

template <int C>
Texel<C> decode_texel(const uint8_t* bytes, const float* table) {
  if constexpr (C == 1) return table[bytes[0]];
  else return Vector4{table[bytes[0]], table[bytes[1]], table[bytes[2]], 0};
}

template <int C>
Texel<C> load_texel(const float* floats) {
  if constexpr (C == 1) return floats[0];
  else return Vector4{floats[0], floats[1], floats[2], 0};
}

// With three channels reads a fourth number, the next texel's or the padding's.
template <int C>
Texel<C> load_texel(const Imath::half* halves) {
  if constexpr (C == 1) return static_cast<float>(halves[0]);
#ifdef __F16C__
  else return _mm_cvtph_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(halves)));
#else
  else return Vector4{float(halves[0]), float(halves[1]), float(halves[2]), 0};
#endif
}

}  // namespace

// The region around st that EWA weighs, in texels of one level: A s^2 + B s t + C t^2 < 1.
struct MipMap::Ellipse {
  float s, t;
  float A, B, C;
  int s0, s1, t0, t1;

  Ellipse(const Level& level, float st_s, float st_t, const float (&d0)[2], const float (&d1)[2]) {
    const float w = static_cast<float>(level.width), h = static_cast<float>(level.height);
    s = st_s * w - 0.5f;
    t = st_t * h - 0.5f;
    const float s_0 = d0[0] * w, t_0 = d0[1] * h, s_1 = d1[0] * w, t_1 = d1[1] * h;
    // The 1 widens the ellipse by a texel, so that it never falls between texel centres.
    A = t_0 * t_0 + t_1 * t_1 + 1;
    B = -2 * (s_0 * t_0 + s_1 * t_1);
    C = s_0 * s_0 + s_1 * s_1 + 1;
    const float inv_f = 1 / (A * C - B * B * 0.25f);
    A *= inv_f;
    B *= inv_f;
    C *= inv_f;
    const float det = -B * B + 4 * A * C, inv_det = 1 / det;
    const float half_s = 2 * inv_det * std::sqrt(det * C), half_t = 2 * inv_det * std::sqrt(A * det);
    // Rounding can make det 0 or negative for the longest, thinnest ellipses: then the box is empty and
    // the caller takes the bilinear value.
    const bool good = half_s < 4096 && half_t < 4096;
    s0 = good ? static_cast<int>(std::ceil(s - half_s)) : 0;
    s1 = good ? static_cast<int>(std::floor(s + half_s)) : -1;
    t0 = good ? static_cast<int>(std::ceil(t - half_t)) : 0;
    t1 = good ? static_cast<int>(std::floor(t + half_t)) : -1;
  }
};

// Where the texels of a stretch of a row lie in the table of weights, computed together.
struct MipMap::RowWeights {
  static constexpr int kLanes = 8;
  int32_t index[kLanes];

  RowWeights(const Ellipse& e, int x0, int y) {
    const float tt = static_cast<float>(y) - e.t, b = e.B * tt, c = e.C * tt * tt;
#pragma omp simd
    for (int k = 0; k < kLanes; ++k) {
      const float ss = static_cast<float>(x0 + k) - e.s;
      // Rounding can leave it a hair below 0.
      index[k] = static_cast<int32_t>(clamp_to((e.A * ss + b) * ss + c, 0.0f, 1.0f) * kWeights);
    }
  }
};

// The filters for C channels and one wrap mode, so that inner loops have neither switch nor call.
template <int C, WrapMode W>
class MipMap::Sampler {
 public:
  explicit Sampler(const MipMap& map) : map_(map), last_(map.level_count() - 1), finest_(last_) {}

  // The finest level asked for so far.
  int finest() const { return finest_; }

  // st near enough to the texture for integer texel indices, at no change of the result: a repeating texture is
  // reduced to [0, 1], exactly; with the others everything 10 000 texture sizes away looks the same.
  static float reduce(float v) {
    if constexpr (W == WrapMode::Repeat) return v - std::floor(v);
    return std::clamp(v, -1e4f, 1e4f);
  }

  static Value<C> no_value() {
    Value<C> v;
    v.fill(std::numeric_limits<float>::quiet_NaN());
    return v;
  }

  Value<C> coarsest() const {
    return with_fetch(*map_.levels_[last_], [](const auto& fetch) { return fetch(0); });
  }

  Value<C> bilinear(int level, float s, float t) {
    const Level& l = use(level);
    s = s * static_cast<float>(l.width) - 0.5f;
    t = t * static_cast<float>(l.height) - 0.5f;
    const float s_floor = std::floor(s), t_floor = std::floor(t);
    const float ds = s - s_floor, dt = t - t_floor;
    const int x0 = static_cast<int>(s_floor), y0 = static_cast<int>(t_floor);
    const int x[2] = {wrap_texel<W>(x0, l.width), wrap_texel<W>(x0 + 1, l.width)};
    const int y[2] = {wrap_texel<W>(y0, l.height), wrap_texel<W>(y0 + 1, l.height)};
    const float weight[2][2] = {{(1 - ds) * (1 - dt), (1 - ds) * dt}, {ds * (1 - dt), ds * dt}};
    return with_fetch(l, [&](const auto& fetch) {
      Value<C> sum{};
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          if (W != WrapMode::Black || (x[i] >= 0 && y[j] >= 0))
            add(sum, weight[i][j], fetch(static_cast<size_t>(y[j]) * l.width + x[i]));
      return sum;
    });
  }

  // `width` is the footprint's side in st; not finite means everything.
  Value<C> trilinear(float s, float t, float width) {
    const float level = static_cast<float>(last_) + std::log2(std::max(width, 1e-8f));
    if (!(level < static_cast<float>(last_))) return coarsest();
    if (level < 0) return bilinear(0, s, t);
    const int fine = static_cast<int>(level);
    return mix(level - static_cast<float>(fine), bilinear(fine, s, t), bilinear(fine + 1, s, t));
  }

  Value<C> ewa(float s, float t, const float (&dx)[2], const float (&dy)[2], float max_anisotropy) {
    const float x2 = dx[0] * dx[0] + dx[1] * dx[1], y2 = dy[0] * dy[0] + dy[1] * dy[1];
    const float(&major)[2] = x2 < y2 ? dy : dx;
    float minor[2] = {x2 < y2 ? dx[0] : dy[0], x2 < y2 ? dx[1] : dy[1]};
    const float major_length = std::sqrt(std::max(x2, y2));
    float minor_length = std::sqrt(std::min(x2, y2));
    if (minor_length * max_anisotropy < major_length && minor_length > 0) {
      const float scale = major_length / (minor_length * max_anisotropy);
      minor[0] *= scale;
      minor[1] *= scale;
      minor_length *= scale;
    }
    if (minor_length == 0) return bilinear(0, s, t);
    const float lod = std::max(0.0f, static_cast<float>(last_) + std::log2(minor_length));
    if (!(lod < static_cast<float>(last_ + 1))) return coarsest();
    const int fine = static_cast<int>(lod);
    const float x = lod - static_cast<float>(fine);
    const Value<C> finer = ewa_level(fine, s, t, major, minor);
    if (x == 0) return finer;  // as ever when the texture is magnified
    return mix(x, finer, fine == last_ ? coarsest() : ewa_level(fine + 1, s, t, major, minor));
  }

 private:
  // A level the pyramid does not have is noted, and the finest that it has taken in its place.
  const Level& use(int level) {
    finest_ = std::min(finest_, level);
    return *map_.levels_[std::max(level, map_.first_)];
  }

  static void add(Value<C>& sum, float weight, const Value<C>& v) {
    for (int c = 0; c < C; ++c) sum[c] += weight * v[c];
  }

  static Value<C> mix(float x, const Value<C>& a, const Value<C>& b) {
    Value<C> out;
    for (int c = 0; c < C; ++c) out[c] = lerp(x, a[c], b[c]);
    return out;
  }

  // Calls f with a function that fetches texel i of the level, compiled once for each storage.
  template <class F>
  Value<C> with_fetch(const Level& level, const F& f) const {
    switch (level.storage) {
      case Storage::Bytes:
        return f([bytes = level.bytes.data(), table = map_.byte_values_.data()](size_t i) {
          Value<C> v;
          for (int c = 0; c < C; ++c) v[c] = table[bytes[i * C + c]];
          return v;
        });
      case Storage::Halves:
        return f([halves = level.halves.data(), gain = map_.gain_](size_t i) {
          Value<C> v;
          for (int c = 0; c < C; ++c) v[c] = static_cast<float>(halves[i * C + c]) * gain;
          return v;
        });
      default:
        return f([floats = level.floats.data()](size_t i) {
          Value<C> v;
          for (int c = 0; c < C; ++c) v[c] = floats[i * C + c];
          return v;
        });
    }
  }

  // The weighted mean of the texels in an ellipse. Where all texels are finite those outside are not skipped but weigh
  // nothing: a branch that goes wrong at both ends of every row takes longer than they do.
  Value<C> ewa_level(int level, float s, float t, const float (&d0)[2], const float (&d1)[2]) {
    const Level& l = use(level);
    const Ellipse e(l, s, t, d0, d1);
    const auto table = map_.byte_values_.data();
    float weights = 0;
    Texel<C> sum{};
    switch (l.storage) {
      case Storage::Bytes:
        sum = weigh<true>(e, l, weights, [&](size_t i) { return decode_texel<C>(l.bytes.data() + i * C, table); });
        break;
      case Storage::Halves:
        sum = weigh<true>(e, l, weights, [&](size_t i) { return load_texel<C>(l.halves.data() + i * C); });
        sum *= map_.gain_;
        break;
      case Storage::Floats:
        sum = weigh<false>(e, l, weights, [&](size_t i) { return load_texel<C>(l.floats.data() + i * C); });
        break;
    }
    if (!(weights > 0)) return bilinear(level, s, t);
    return to_value<C>(sum / weights);
  }

  template <bool kFinite, class Fetch>
  static Texel<C> weigh(const Ellipse& e, const Level& l, float& weight_sum, const Fetch& fetch) {
    const float* const table = ewa_weights().data();
    Texel<C> sum{};
    float weights = 0;
    for (int y = e.t0; y <= e.t1; ++y) {
      const int row = wrap_texel<W>(y, l.height);
      const size_t row_start = static_cast<size_t>(row) * l.width;
      for (int x0 = e.s0; x0 <= e.s1; x0 += RowWeights::kLanes) {
        const RowWeights w(e, x0, y);
        for (int k = 0; k < std::min(RowWeights::kLanes, e.s1 - x0 + 1); ++k) {
          const float weight = table[w.index[k]];
          if (!kFinite && weight == 0) continue;
          weights += weight;
          const int column = wrap_texel<W>(x0 + k, l.width);
          if (W != WrapMode::Black || (row >= 0 && column >= 0)) sum += weight * fetch(row_start + column);
        }
      }
    }
    weight_sum = weights;
    return sum;
  }

  const MipMap& map_;
  const int last_;
  int finest_;
};

// Calls f with the sampler of this map's wrap mode; returns the finest level that f asked for.
template <int C, class F>
int MipMap::with_sampler(const F& f) const {
  const auto run = [&](auto sampler) {
    f(sampler);
    return sampler.finest();
  };
  switch (wrap_) {
    case WrapMode::Repeat: return run(Sampler<C, WrapMode::Repeat>(*this));
    case WrapMode::Black: return run(Sampler<C, WrapMode::Black>(*this));
    default: return run(Sampler<C, WrapMode::Clamp>(*this));
  }
}

namespace {

template <size_t C>
void put(float* const* out, int i, const std::array<float, C>& v) {
  for (size_t c = 0; c < C; ++c) out[c][i] = v[c];
}

}  // namespace

int MipMap::lookup(const LookupPoints& p, const MipFilter& filter, float* const* out) const {
  const float anisotropy = std::clamp(filter.max_anisotropy, 0.01f, 256.0f);
  const auto at = [&](auto& sampler, int i) {
    const float s = sampler.reduce(p.s[i]), t = sampler.reduce(p.t[i]);
    if (!p.dsdx) return sampler.bilinear(0, s, t);
    const float dx[2] = {p.dsdx[i], p.dtdx[i]}, dy[2] = {p.dsdy[i], p.dtdy[i]};
    if (!std::isfinite(std::abs(dx[0]) + std::abs(dx[1]) + std::abs(dy[0]) + std::abs(dy[1])))
      return sampler.coarsest();
    if (!filter.trilinear) return sampler.ewa(s, t, dx, dy, anisotropy);
    const float widest = std::max({std::abs(dx[0]), std::abs(dx[1]), std::abs(dy[0]), std::abs(dy[1])});
    return sampler.trilinear(s, t, widest);
  };
  const auto run = [&](auto& sampler) {
    for (int i = 0; i < p.n; ++i)
      put(out, i, std::isfinite(p.s[i]) && std::isfinite(p.t[i]) ? at(sampler, i) : sampler.no_value());
  };
  return channels_ == 1 ? with_sampler<1>(run) : with_sampler<3>(run);
}

int MipMap::lookup_width(int n, const float* s, const float* t, const float* width, float* const* out) const {
  const auto run = [&](auto& sampler) {
    for (int i = 0; i < n; ++i)
      put(out, i,
          std::isfinite(s[i]) && std::isfinite(t[i])
              ? sampler.trilinear(sampler.reduce(s[i]), sampler.reduce(t[i]), width[i])
              : sampler.no_value());
  };
  return channels_ == 1 ? with_sampler<1>(run) : with_sampler<3>(run);
}

}  // namespace whit
