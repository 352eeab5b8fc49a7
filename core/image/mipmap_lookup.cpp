// The filters of MipMap, one point at a time inside loops over a batch.
#ifdef __F16C__
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/base/fastmath.h"
#include "core/batch/lanes.h"
#include "core/image/mipmap.h"

namespace whit {
namespace {

// The weight of a texel at r2, the squared distance from the middle of the ellipse in terms of its edge's:
// exp(-2 r2) - exp(-2), a Gaussian that reaches 0 on the ellipse, and 0 outside. Within 1.3e-6 (a minimax fit), where
// pbrt-v3 has a table of 128 steps: arithmetic vectorises.
inline float ewa_weight(float r2) {
  const float x = min_of(r2, 1.0f), x2 = x * x;  // Rounding may leave r2 a hair below 0, where the fit still holds.
  // By Estrin's scheme, whose steps wait less for each other than Horner's.
  const float low = 0.864663438f - 1.13520816f * x, middle = 0.862681272f - 0.457534625f * x;
  const float high = 0.169620198f - 0.0336283143f * x;
  return (1 - x) * (low + x2 * (middle + x2 * high));
}

// Index i of a side of n texels, n a power of two; -1 stands for black.
template <WrapMode W>
int wrap_texel(int i, int n) {
  static_assert(W != WrapMode::LatLong, "is two modes, one along s and one along t");
  if constexpr (W == WrapMode::Repeat) return i & (n - 1);
  if constexpr (W == WrapMode::Clamp) return std::clamp(i, 0, n - 1);
  if constexpr (W == WrapMode::Mirror) return i & n ? ~i & (n - 1) : i & (n - 1);
  if constexpr (W == WrapMode::Black) return i >= 0 && i < n ? i : -1;
}

// (s, t) of one axis near enough to the texture for integer texel indices, at no change of the result: a texture that
// repeats, mirrored or not, is reduced to its period, exactly; with the others everything 10 000 texture sizes away looks
// the same.
template <WrapMode W>
float reduce(float v) {
  if constexpr (W == WrapMode::Repeat) return v - std::floor(v);
  if constexpr (W == WrapMode::Mirror) return v - 2 * std::floor(0.5f * v);
  return std::clamp(v, -1e4f, 1e4f);
}

// Two wrap modes known when compiling, which the usual ones are.
template <WrapMode W>
struct FixedWrap {
  static constexpr bool kMayBeBlack = wrap_along_s(W) == WrapMode::Black || wrap_along_t(W) == WrapMode::Black;
  static int along_s(int i, int n) { return wrap_texel<wrap_along_s(W)>(i, n); }
  static int along_t(int i, int n) { return wrap_texel<wrap_along_t(W)>(i, n); }
  static float reduce_s(float v) { return reduce<wrap_along_s(W)>(v); }
  static float reduce_t(float v) { return reduce<wrap_along_t(W)>(v); }
};

// Any two.
struct AnyWrap {
  static constexpr bool kMayBeBlack = true;
  WrapMode s, t;
  explicit AnyWrap(WrapMode wrap) : s(wrap_along_s(wrap)), t(wrap_along_t(wrap)) {}
  int along_s(int i, int n) const { return along(s, i, n); }
  int along_t(int i, int n) const { return along(t, i, n); }
  float reduce_s(float v) const { return reduced(s, v); }
  float reduce_t(float v) const { return reduced(t, v); }

 private:
  static int along(WrapMode mode, int i, int n) {
    switch (mode) {
      case WrapMode::Repeat: return wrap_texel<WrapMode::Repeat>(i, n);
      case WrapMode::Mirror: return wrap_texel<WrapMode::Mirror>(i, n);
      case WrapMode::Black: return wrap_texel<WrapMode::Black>(i, n);
      default: return wrap_texel<WrapMode::Clamp>(i, n);
    }
  }
  static float reduced(WrapMode mode, float v) {
    switch (mode) {
      case WrapMode::Repeat: return reduce<WrapMode::Repeat>(v);
      case WrapMode::Mirror: return reduce<WrapMode::Mirror>(v);
      default: return reduce<WrapMode::Clamp>(v);
    }
  }
};

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

// The region around st that EWA weighs, in texels of one level: A s^2 + B s t + C t^2 < 1, and the box around it.
struct MipMap::Ellipse {
  float s, t;
  float A, B, C;
  int s0, s1, t0, t1;

  struct Rows {
    int first, last;
  };

  // The rows that the ellipse can reach in n columns from x0: of a slanted one, few of the box's.
  Rows rows_of(int x0, int n) const {
    if (s1 - s0 < n) return {t0, t1};
    // In the column at ss the ellipse spans -B / (2C) ss -+ sqrt(4C - (4AC - B^2) ss^2) / (2C) around t.
    const float a = static_cast<float>(x0) - s, b = a + static_cast<float>(n - 1);
    const float nearest = a > 0 ? a : (b < 0 ? b : 0.0f), half_inv_c = 0.5f / C;
    const float span = safe_sqrt(4 * C - (4 * A * C - B * B) * nearest * nearest) * half_inv_c;
    const float at_a = -B * half_inv_c * a, at_b = -B * half_inv_c * b;
    const float low = t + min_of(at_a, at_b) - span, high = t + max_of(at_a, at_b) + span;
    return {std::max(t0, static_cast<int>(std::ceil(low))), std::min(t1, static_cast<int>(std::floor(high)))};
  }
};

// Ellipses of a batch of lookups, each in a level of its own.
struct MipMap::EllipseLanes {
  float s[kLanes], t[kLanes], A[kLanes], B[kLanes], C[kLanes];
  int s0[kLanes], s1[kLanes], t0[kLanes], t1[kLanes];

  Ellipse operator[](int i) const { return {s[i], t[i], A[i], B[i], C[i], s0[i], s1[i], t0[i], t1[i]}; }

  // The ellipse with the axes (s_0, t_0) and (s_1, t_1) around a point, all in st, for a level of w x h texels.
  [[gnu::always_inline]] void set(int i, float w, float h, float st_s, float st_t, float s_0, float t_0, float s_1,
                                  float t_1) {
    const float ps = st_s * w - 0.5f, pt = st_t * h - 0.5f;
    s_0 *= w, s_1 *= w, t_0 *= h, t_1 *= h;
    // The 1 widens the ellipse by a texel, so that it never falls between texel centres.
    const float a = t_0 * t_0 + t_1 * t_1 + 1, b = -2 * (s_0 * t_0 + s_1 * t_1), c = s_0 * s_0 + s_1 * s_1 + 1;
    const float inv_f = 1 / (a * c - b * b * 0.25f);
    A[i] = a * inv_f, B[i] = b * inv_f, C[i] = c * inv_f;
    const float det = -B[i] * B[i] + 4 * A[i] * C[i], inv_det = 1 / det;
    const float half_s = 2 * inv_det * std::sqrt(det * C[i]), half_t = 2 * inv_det * std::sqrt(A[i] * det);
    // Rounding can make det 0 or negative for the longest, thinnest ellipses: then the box is empty and
    // the caller takes the bilinear value.
    const bool good = (half_s < 4096) & (half_t < 4096);
    s[i] = ps, t[i] = pt;
    s0[i] = static_cast<int>(good ? std::ceil(ps - half_s) : 0.0f);
    s1[i] = static_cast<int>(good ? std::floor(ps + half_s) : -1.0f);
    t0[i] = static_cast<int>(good ? std::ceil(pt - half_t) : 0.0f);
    t1[i] = static_cast<int>(good ? std::floor(pt + half_t) : -1.0f);
  }
};

// How EWA goes about a batch of lookups: which levels, and the ellipses there. All of it is arithmetic that vectorises.
struct MipMap::EwaLanes {
  int fine[kLanes];    // The finer level; kCoarsest and kBilinear (in level 0) need no ellipse.
  float part[kLanes];  // How much the next level weighs.
  EllipseLanes finer, coarser;

  static constexpr int kCoarsest = -1, kBilinear = -2;

  // (s, t) are those of p, reduced.
  EwaLanes(const MipMap& map, const LookupPoints& p, const float* s, const float* t, float max_anisotropy) {
    const int last = map.level_count() - 1, width = map.width(), height = map.height();
    for_lanes(p.n, [&, this](int i) {
      const float ax = p.dsdx[i], ay = p.dtdx[i], bx = p.dsdy[i], by = p.dtdy[i];
      const float a2 = ax * ax + ay * ay, b2 = bx * bx + by * by;
      const bool swap = a2 < b2;
      const float major_s = swap ? bx : ax, major_t = swap ? by : ay;
      const float major = std::sqrt(swap ? b2 : a2), minor = std::sqrt(swap ? a2 : b2);
      const bool thin = minor * max_anisotropy < major;
      const float scale = (thin & (minor > 0)) ? major / (minor * max_anisotropy) : 1.0f;
      const float minor_s = (swap ? ax : bx) * scale, minor_t = (swap ? ay : by) * scale;
      const double width_of = static_cast<double>(max_of(minor * scale, std::numeric_limits<float>::min()));
      const float lod = max_of(0.0f, static_cast<float>(last) + static_cast<float>(detail::log2_kernel(width_of)));
      const bool everything = !(lod < static_cast<float>(last + 1)) | !(a2 + b2 < std::numeric_limits<float>::max());
      const int level = static_cast<int>(everything ? 0.0f : lod);
      fine[i] = minor == 0 ? kBilinear : everything ? kCoarsest : level;
      part[i] = lod - static_cast<float>(level);
      const auto side = [](int of_finest, int l) { return static_cast<float>(std::max(of_finest >> l, 1)); };
      finer.set(i, side(width, level), side(height, level), s[i], t[i], major_s, major_t, minor_s, minor_t);
      coarser.set(i, side(width, level + 1), side(height, level + 1), s[i], t[i], major_s, major_t, minor_s, minor_t);
    });
  }
};

// The weights of a few columns and rows of texels, computed together.
struct MipMap::BlockWeights {
  static constexpr int kColumns = 4, kRows = 8;
  alignas(64) float weight[kRows * kColumns];

  BlockWeights(const Ellipse& e, int x0, int y0) {
    const float s = static_cast<float>(x0) - e.s, t = static_cast<float>(y0) - e.t;
    for_lanes(kRows * kColumns, [=, this](int k) {
      const float ss = s + static_cast<float>(k % kColumns), tt = t + static_cast<float>(k / kColumns);
      weight[k] = ewa_weight((e.A * ss + e.B * tt) * ss + e.C * tt * tt);
    });
  }
};

// The filters for C channels and one way to wrap, so that inner loops of the usual ones have neither switch nor call.
template <int C, class Wrap>
class MipMap::Sampler {
 public:
  Sampler(const MipMap& map, const Wrap& wrap)
      : map_(map), wrap_(wrap), last_(map.level_count() - 1), held_(std::min(map.first_, last_)), finest_(last_) {}

  // The finest level asked for so far.
  int finest() const { return finest_; }

  float reduce_s(float s) const { return wrap_.reduce_s(s); }
  float reduce_t(float t) const { return wrap_.reduce_t(t); }

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
    const int x[2] = {wrap_.along_s(x0, l.width), wrap_.along_s(x0 + 1, l.width)};
    const int y[2] = {wrap_.along_t(y0, l.height), wrap_.along_t(y0 + 1, l.height)};
    const float weight[2][2] = {{(1 - ds) * (1 - dt), (1 - ds) * dt}, {ds * (1 - dt), ds * dt}};
    return with_fetch(l, [&](const auto& fetch) {
      Value<C> sum{};
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          if (!Wrap::kMayBeBlack || (x[i] >= 0 && y[j] >= 0))
            add(sum, weight[i][j], fetch(static_cast<size_t>(y[j]) * l.width + x[i]));
      return sum;
    });
  }

  // The texel whose square (s, t) is in, of the finest level.
  Value<C> nearest(float s, float t) {
    const Level& l = use(0);
    const int x = wrap_.along_s(static_cast<int>(std::floor(s * static_cast<float>(l.width))), l.width);
    const int y = wrap_.along_t(static_cast<int>(std::floor(t * static_cast<float>(l.height))), l.height);
    if (Wrap::kMayBeBlack && (x < 0 || y < 0)) return {};
    return with_fetch(l, [&](const auto& fetch) { return fetch(static_cast<size_t>(y) * l.width + x); });
  }

  // `width` is the footprint's side in st; not finite means everything.
  Value<C> trilinear(float s, float t, float width) {
    const float level = static_cast<float>(last_) + std::log2(std::max(width, 1e-8f));
    if (!(level < static_cast<float>(last_))) return coarsest();
    if (level < 0) return bilinear(0, s, t);
    const int fine = static_cast<int>(level);
    return mix(level - static_cast<float>(fine), bilinear(fine, s, t), bilinear(fine + 1, s, t));
  }

  // Lookup i of a batch, around (s, t).
  Value<C> ewa(const EwaLanes& lanes, int i, float s, float t) {
    const int fine = lanes.fine[i];
    if (fine == EwaLanes::kBilinear) return bilinear(0, s, t);
    if (fine == EwaLanes::kCoarsest) return coarsest();
    const Value<C> finer = ewa_level(fine, s, t, lanes.finer[i]);
    const float x = lanes.part[i];
    if (x == 0) return finer;  // as ever when the texture is magnified
    return mix(x, finer, fine == last_ ? coarsest() : ewa_level(fine + 1, s, t, lanes.coarser[i]));
  }

 private:
  // A level the pyramid does not have is noted, and the finest that it has taken in its place.
  const Level& use(int level) {
    finest_ = std::min(finest_, level);
    return *map_.levels_[std::max(level, held_)];
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
        return f([bytes = level.bytes(), table = map_.byte_values_.data()](size_t i) {
          Value<C> v;
          for (int c = 0; c < C; ++c) v[c] = table[bytes[i * C + c]];
          return v;
        });
      case Storage::Halves:
        return f([halves = level.halves(), gain = map_.gain_](size_t i) {
          Value<C> v;
          for (int c = 0; c < C; ++c) v[c] = static_cast<float>(halves[i * C + c]) * gain;
          return v;
        });
      default:
        return f([floats = level.floats()](size_t i) {
          Value<C> v;
          for (int c = 0; c < C; ++c) v[c] = floats[i * C + c];
          return v;
        });
    }
  }

  // The weighted mean of the texels in an ellipse. Where all texels are finite those outside are not skipped but weigh
  // nothing: a branch that goes wrong at both ends of every row takes longer than they do.
  Value<C> ewa_level(int level, float s, float t, const Ellipse& e) {
    const Level& l = use(level);
    const auto table = map_.byte_values_.data();
    float weights = 0;
    Texel<C> sum{};
    switch (l.storage) {
      case Storage::Bytes:
        sum = weigh<true>(e, l, l.bytes(), weights, [=](const uint8_t* at) { return decode_texel<C>(at, table); });
        break;
      case Storage::Halves:
        sum = weigh<true>(e, l, l.halves(), weights, [](const Imath::half* at) { return load_texel<C>(at); });
        sum *= map_.gain_;
        break;
      case Storage::Floats:
        sum = weigh<false>(e, l, l.floats(), weights, [](const float* at) { return load_texel<C>(at); });
        break;
    }
    if (!(weights > 0)) return bilinear(level, s, t);
    return to_value<C>(sum / weights);
  }

  // The weighted sum of the texels in an ellipse, and the sum of the weights. `first` is the level's first number. Each
  // column of a block has a sum of its own: a single one would wait for itself from texel to texel.
  template <bool kFinite, class T, class Fetch>
  Texel<C> weigh(const Ellipse& e, const Level& l, const T* first, float& weight_sum, const Fetch& fetch) const {
    constexpr int kColumns = BlockWeights::kColumns;
    Texel<C> sums[kColumns]{};
    Vector4 weights{};
    for (int x0 = e.s0; x0 <= e.s1; x0 += kColumns) {
      int column[kColumns];
      for (int k = 0; k < kColumns; ++k) column[k] = wrap_.along_s(x0 + k, l.width) * C;
      const Ellipse::Rows range = e.rows_of(x0, kColumns);
      for (int y0 = range.first; y0 <= range.last; y0 += BlockWeights::kRows) {
        const BlockWeights block(e, x0, y0);
        const int rows = std::min(BlockWeights::kRows, range.last - y0 + 1);
        for (int j = 0; j < rows; ++j) {
          const float* const w = block.weight + j * kColumns;
          weights += Vector4{w[0], w[1], w[2], w[3]};
          const int row = wrap_.along_t(y0 + j, l.height);
          if (Wrap::kMayBeBlack && row < 0) continue;
          const auto* const texels = first + static_cast<size_t>(row) * l.width * C;
          for (int k = 0; k < kColumns; ++k) {
            if (!kFinite && w[k] == 0) continue;
            if (!Wrap::kMayBeBlack || column[k] >= 0) sums[k] += w[k] * fetch(texels + column[k]);
          }
        }
      }
    }
    weight_sum = (weights[0] + weights[1]) + (weights[2] + weights[3]);
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }

  const MipMap& map_;
  [[no_unique_address]] const Wrap wrap_;
  const int last_, held_;  // the coarsest level; the finest that is there
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
    case WrapMode::Repeat: return run(Sampler<C, FixedWrap<WrapMode::Repeat>>(*this, {}));
    case WrapMode::Black: return run(Sampler<C, FixedWrap<WrapMode::Black>>(*this, {}));
    case WrapMode::Clamp: return run(Sampler<C, FixedWrap<WrapMode::Clamp>>(*this, {}));
    case WrapMode::LatLong: return run(Sampler<C, FixedWrap<WrapMode::LatLong>>(*this, {}));
    default: return run(Sampler<C, AnyWrap>(*this, AnyWrap(wrap_)));
  }
}

namespace {

template <size_t C>
void put(float* const* out, int i, const std::array<float, C>& v) {
  for (size_t c = 0; c < C; ++c) out[c][i] = v[c];
}

// The longest of a footprint's components; NaN where any is.
float widest(const LookupPoints& p, int i) {
  const float x = std::max(std::abs(p.dsdx[i]), std::abs(p.dtdx[i]));
  const float y = std::max(std::abs(p.dsdy[i]), std::abs(p.dtdy[i]));
  return std::isfinite(x + y) ? std::max(x, y) : std::numeric_limits<float>::infinity();
}

}  // namespace

template <class S>
void MipMap::ewa_lookups(S& sampler, const LookupPoints& p, const MipFilter& filter, float* const* out) const {
  const float anisotropy = std::clamp(filter.max_anisotropy, 0.01f, 256.0f);
  float s[kLanes], t[kLanes];
  for (int first = 0; first < p.n; first += kLanes) {
    const int n = std::min(kLanes, p.n - first);
    const LookupPoints part{
        n, p.s + first, p.t + first, p.dsdx + first, p.dtdx + first, p.dsdy + first, p.dtdy + first};
    for_lanes(n, [&](int i) { s[i] = sampler.reduce_s(part.s[i]), t[i] = sampler.reduce_t(part.t[i]); });
    const EwaLanes lanes(*this, part, s, t, anisotropy);
    for (int i = 0; i < n; ++i) {
      const bool good = std::isfinite(part.s[i]) && std::isfinite(part.t[i]);
      put(out, first + i, good ? sampler.ewa(lanes, i, s[i], t[i]) : sampler.no_value());
    }
  }
}

int MipMap::lookup(const LookupPoints& p, const MipFilter& filter, float* const* out) const {
  const auto run = [&](auto& sampler) {
    const bool point = filter.kind == TextureFilter::Point;
    if (p.dsdx && filter.kind == TextureFilter::Ewa) return ewa_lookups(sampler, p, filter, out);
    for (int i = 0; i < p.n; ++i) {
      if (!std::isfinite(p.s[i]) || !std::isfinite(p.t[i])) {
        put(out, i, sampler.no_value());
        continue;
      }
      const float s = sampler.reduce_s(p.s[i]), t = sampler.reduce_t(p.t[i]);
      put(out, i,
          point    ? sampler.nearest(s, t)
          : p.dsdx ? sampler.trilinear(s, t, widest(p, i))
                   : sampler.bilinear(0, s, t));
    }
  };
  return channels_ == 1 ? with_sampler<1>(run) : with_sampler<3>(run);
}

int MipMap::lookup_width(int n, const float* s, const float* t, const float* width, float* const* out) const {
  const auto run = [&](auto& sampler) {
    for (int i = 0; i < n; ++i)
      put(out, i,
          std::isfinite(s[i]) && std::isfinite(t[i])
              ? sampler.trilinear(sampler.reduce_s(s[i]), sampler.reduce_t(t[i]), width[i])
              : sampler.no_value());
  };
  return channels_ == 1 ? with_sampler<1>(run) : with_sampler<3>(run);
}

}  // namespace whit
