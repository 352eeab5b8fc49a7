#include "core/lobe/fourier.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/lobe/draw.h"
#include "core/lobe/pair.h"

namespace whit {

namespace {

// ---- Reading ----

constexpr size_t kHeaderSize = 64;
constexpr char kMagic[8] = {'S', 'C', 'A', 'T', 'F', 'U', 'N', '\x01'};

/// Takes little-endian values off the front of the file, as every machine this runs on has them.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  T take() {
    T value;
    take_all(&value, 1);
    return value;
  }
  template <class T>
  void take_all(T* to, size_t n) {
    if (n > 0) std::memcpy(to, rest_.data(), n * sizeof(T));  // An empty list has no place to copy to.
    rest_.remove_prefix(n * sizeof(T));
  }
  size_t size() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

std::string check_table(const FourierTable& t) {
  if (!all_finite(t.mu) || !all_finite(t.a)) return "holds numbers that are not finite";
  for (size_t i = 0; i < t.mu.size(); ++i) {
    if (std::abs(t.mu[i]) > 1) return "has a cosine outside [-1, 1]";
    if (i > 0 && t.mu[i] < t.mu[i - 1]) return "has cosines that decrease";
  }
  if (!(t.mu.front() < t.mu.back())) return "has but one cosine";
  for (size_t k = 0; k < t.first.size(); ++k) {
    const int64_t end = t.first[k] + static_cast<int64_t>(t.order[k]) * t.channels;
    if (t.first[k] < 0 || t.order[k] < 0 || t.order[k] > t.max_order || end > static_cast<int64_t>(t.a.size()))
      return "has a series that is longer than its coefficients";
  }
  return {};
}

/// The slope of the spline at node k, times the width of the interval between nodes lo and lo + 1.
float slope(const FourierTable& t, const float* f, int k, int lo) {
  const int before = std::max(k - 1, 0), after = std::min(k + 1, t.size() - 1);
  const auto mu = [&](int i) { return t.mu[static_cast<size_t>(i)]; };
  return (f[after] - f[before]) / (mu(after) - mu(before)) * (mu(lo + 1) - mu(lo));
}

/// One interval of the spline through f: cubic in t in [0, 1]. Of no width where a cosine stands twice.
struct Segment {
  float f0, f1, d0, d1, width;
  /// The integral from 0 to t, times the width.
  float integral(float t) const {
    const float c = f1 - f0;
    return width * t * (f0 + t * (0.5f * d0 + t * ((c - (2 * d0 + d1) / 3) + t * (0.25f * (d0 + d1) - 0.5f * c))));
  }
};
Segment segment(const FourierTable& t, const float* f, int k) {
  const float width = t.mu[static_cast<size_t>(k) + 1] - t.mu[static_cast<size_t>(k)];
  // Without a width all nodes around may be equal, and the slopes 0 / 0.
  if (width == 0) return {f[k], f[k + 1], 0, 0, 0};
  return {f[k], f[k + 1], slope(t, f, k, k), slope(t, f, k + 1, k), width};
}

/// What sampling needs; the file's own integrals are not relied upon.
void prepare_sampling(FourierTable& t) {
  t.mean.resize(t.order.size()), t.integrals.resize(t.order.size());
  for (size_t k = 0; k < t.order.size(); ++k) t.mean[k] = t.order[k] > 0 ? t.a[static_cast<size_t>(t.first[k])] : 0;
  for (int o = 0; o < t.size(); ++o) {
    const float* const f = &t.mean[t.at(o, 0)];
    float sum = 0;
    for (int i = 0; i < t.size(); ++i) {
      t.integrals[t.at(o, i)] = sum;
      if (i + 1 < t.size()) sum += segment(t, f, i).integral(1);
    }
  }
}

// ---- Interpolating ----

/// The weights of four neighbouring nodes in a Catmull-Rom spline; `first` may be -1, with weight 0.
struct Spline {
  int first = 0;
  float w[4] = {0, 0, 0, 0};
  bool inside = false;
};

Spline spline_at(const std::vector<float>& nodes, float x) {
  Spline s;
  const int n = static_cast<int>(nodes.size());
  if (!(x >= nodes.front() && x <= nodes.back())) return s;
  // An interval of some width: behind all nodes that are not above x, or, at the upper end, before those that equal x.
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), x);
  const auto end = above != nodes.end() ? above : std::lower_bound(nodes.begin(), nodes.end(), x);
  const int k = static_cast<int>(end - nodes.begin()) - 1;
  const float* const at = nodes.data() + k;
  const float width = at[1] - at[0], t = (x - at[0]) / width, t2 = t * t, t3 = t2 * t;
  s.first = k - 1, s.inside = true;
  s.w[1] = 2 * t3 - 3 * t2 + 1, s.w[2] = 3 * t2 - 2 * t3;
  // The slopes at both ends, by the neighbours or, at the border, by the interval itself.
  const float left = t3 - 2 * t2 + t, right = t3 - t2;
  const float l = left * (k > 0 ? width / (at[1] - at[-1]) : 1.0f);
  const float r = right * (k + 2 < n ? width / (at[2] - at[0]) : 1.0f);
  s.w[2] += l, s.w[k > 0 ? 0 : 1] -= l;
  s.w[1] -= r, s.w[k + 2 < n ? 3 : 2] += r;
  return s;
}

/// The interpolated coefficients, channel after channel, max_order each, in `to`. Returns the longest series.
int coefficients(const FourierTable& t, const Spline& o, const Spline& i, float* to) {
  std::fill_n(to, static_cast<size_t>(t.max_order) * static_cast<size_t>(t.channels), 0.0f);
  int longest = 0;
  for (int b = 0; b < 4; ++b) {
    for (int a = 0; a < 4; ++a) {
      const float w = o.w[b] * i.w[a];
      if (w == 0) continue;
      const size_t k = t.at(o.first + b, i.first + a);
      const int order = t.order[k];
      longest = std::max(longest, order);
      for (int c = 0; c < t.channels; ++c) {
        const float* const from = t.a.data() + t.first[k] + static_cast<ptrdiff_t>(c) * order;
        float* const sum = to + static_cast<ptrdiff_t>(c) * t.max_order;
        for (int m = 0; m < order; ++m) sum[m] += w * from[m];
      }
    }
  }
  return longest;
}

/// The cosine series at an angle, by Clenshaw's recurrence; in double, because many terms cancel.
float series(const float* a, int n, double cos_phi) {
  double b1 = 0, b2 = 0;
  for (int k = n - 1; k > 0; --k) {
    const double b = static_cast<double>(a[k]) + 2 * cos_phi * b1 - b2;
    b2 = b1, b1 = b;
  }
  return n > 0 ? static_cast<float>(static_cast<double>(a[0]) + cos_phi * b1 - b2) : 0.0f;
}

/// What the table makes of a pair of directions given by their cosines (mu_i of -wi) and the cosine of their azimuths.
RGB look_up(const FourierTable& t, float mu_o, float mu_i, float cos_phi, float* scratch) {
  const Spline o = spline_at(t.mu, mu_o), i = spline_at(t.mu, mu_i);
  if (!o.inside || !i.inside || mu_i == 0) return RGB(0.0f);
  const int n = coefficients(t, o, i, scratch);
  const float y = max_of(series(scratch, n, cos_phi), 0.0f);
  // Radiance is scaled through the boundary: by 1 / eta^2 on the way in.
  const float eta = mu_i > 0 ? 1 / t.eta : t.eta;
  const float scale = mu_i * mu_o > 0 ? eta * eta : 1.0f;
  if (t.channels == 1) return RGB(y * scale);
  const float r = series(scratch + t.max_order, n, cos_phi), b = series(scratch + 2 * t.max_order, n, cos_phi);
  const float g = 1.39829f * y - 0.100913f * b - 0.297375f * r;
  return RGB(max_of(r * scale, 0.0f), max_of(g * scale, 0.0f), max_of(b * scale, 0.0f));
}

/// The cosine of the azimuth from -wi to wo, from the squared lengths and the product of their tangential parts.
float cos_azimuth(float wi2, float wo2, float product) {
  return wi2 > 0 && wo2 > 0 ? clamp_to(-product / (std::sqrt(wi2) * std::sqrt(wo2)), -1.0f, 1.0f) : 1.0f;
}

// ---- Sampling ----

/// The spline across o of a row of values over i.
std::vector<float> blended_row(const FourierTable& t, const Spline& o, const std::vector<float>& values) {
  std::vector<float> row(t.mu.size(), 0.0f);
  for (int b = 0; b < 4; ++b) {
    if (o.w[b] == 0) continue;
    for (int i = 0; i < t.size(); ++i) row[static_cast<size_t>(i)] += o.w[b] * values[t.at(o.first + b, i)];
  }
  return row;
}

/// The x in [lo, hi] at which a rising function reaches y.
template <class F>
double bisect(double lo, double hi, double y, const F& f) {
  for (int k = 0; k < 48; ++k) {
    const double middle = 0.5 * (lo + hi);
    (f(middle) < y ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

/// A cosine of -wi, in proportion to the mean over the azimuth.
float sample_cosine(const FourierTable& t, const Spline& o, float u) {
  const std::vector<float> f = blended_row(t, o, t.mean), integral = blended_row(t, o, t.integrals);
  const float wanted = u * integral.back();
  const auto above = std::upper_bound(integral.begin(), integral.end(), wanted) - integral.begin();
  const int k = std::clamp(static_cast<int>(above) - 1, 0, t.size() - 2);
  const Segment part = segment(t, f.data(), k);
  const double rest = wanted - integral[static_cast<size_t>(k)];
  const double x = bisect(0, 1, rest, [&](double t01) { return part.integral(static_cast<float>(t01)); });
  return t.mu[static_cast<size_t>(k)] + static_cast<float>(x) * part.width;
}

/// An azimuth in proportion to the series: half a turn is sampled, the other half is its mirror image.
float sample_azimuth(const float* a, int n, float u) {
  const bool mirrored = u >= 0.5f;
  const double wanted = (mirrored ? 2 - 2 * u : 2 * u) * detail::kPiD * static_cast<double>(a[0]);
  const auto integral = [&](double phi) {
    double sum = static_cast<double>(a[0]) * phi;
    for (int k = 1; k < n; ++k) sum += static_cast<double>(a[k]) / k * std::sin(k * phi);
    return sum;
  };
  const auto phi = static_cast<float>(bisect(0, detail::kPiD, wanted, integral));
  return mirrored ? -phi : phi;
}

/// The density with which sample() finds a direction, from what look_up() takes.
float density(const FourierTable& t, float mu_o, float mu_i, float cos_phi, float* scratch) {
  const Spline o = spline_at(t.mu, mu_o), i = spline_at(t.mu, mu_i);
  if (!o.inside || !i.inside) return 0;
  const int n = coefficients(t, o, i, scratch);
  const float y = series(scratch, n, cos_phi);
  float all = 0;
  for (int b = 0; b < 4; ++b) {
    if (o.w[b] != 0) all += o.w[b] * t.integrals[t.at(o.first + b, t.size() - 1)];
  }
  return y > 0 && all > 0 ? y / (kTwoPi * all) : 0.0f;
}

/// The zero vector when no direction comes out; both in the local frame.
Vec3f sample(const FourierTable& t, const Vec3f& wo, float u, float v) {
  const Spline o = spline_at(t.mu, wo.z);
  if (!o.inside) return {0, 0, 0};
  const float mu = sample_cosine(t, o, u);
  const Spline i = spline_at(t.mu, mu);
  if (!i.inside) return {0, 0, 0};
  std::vector<float> a(static_cast<size_t>(t.max_order) * static_cast<size_t>(t.channels));
  const int n = coefficients(t, o, i, a.data());
  if (n == 0 || a[0] <= 0) return {0, 0, 0};
  const float phi = sample_azimuth(a.data(), n, v) + (wo.x != 0 || wo.y != 0 ? atan2_of(wo.y, wo.x) : 0.0f);
  const float r = safe_sqrt((1 - mu) * (1 + mu));
  const SinCos at = sin_cos(phi);
  return {-r * at.cos, -r * at.sin, -mu};
}

void eval(const LobeQuery& q, const LobeValues& out) {
  const FourierTable& t = *q.lobe.table;
  const RGBLanes weight = q.lobe.weight;
  const ArenaScope scope(*q.s.arena);
  float* const scratch = q.s.arena->floats(t.max_order * t.channels);
  // Not lanes side by side: each reads series of its own length, and adding them up is what vectorises.
  for (int i = 0; i < q.s.n; ++i) {
    const Pair p = make_pair(q.s, q.wi, i);
    if (p.zo == 0) continue;
    const Vec3f o = p.wo - p.n * p.zo, w = p.wi - p.n * p.zi;
    const float cos_phi = cos_azimuth(dot(w, w), dot(o, o), dot(w, o));
    const RGB f = look_up(t, p.zo, -p.zi, cos_phi, scratch);
    out.f.r[i] += weight.r[i] * f.x, out.f.g[i] += weight.g[i] * f.y, out.f.b[i] += weight.b[i] * f.z;
    if (out.pdf) out.pdf[i] += out.share[i] * density(t, p.zo, -p.zi, cos_phi, scratch);
  }
}

void draw(const LobeDraw& d) {
  draw_one_by_one(d, [&](int, const Vec3f& wo, float u, float v) { return sample(*d.lobe.table, wo, u, v); });
}

}  // namespace

std::string parse_fourier_table(std::string_view bytes, FourierTable& table) {
  if (bytes.size() < kHeaderSize || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    return "is not a bsdf file of version 1";
  Bytes in(bytes.substr(sizeof kMagic));
  const auto flags = in.take<int32_t>(), n = in.take<int32_t>(), count = in.take<int32_t>();
  table.max_order = in.take<int32_t>(), table.channels = in.take<int32_t>();
  const auto bases = in.take<int32_t>();
  int32_t unused[4];
  in.take_all(unused, 3);
  table.eta = in.take<float>();
  in.take_all(unused, 4);
  if (flags != 1 || bases != 1 || (table.channels != 1 && table.channels != 3))
    return "is of a kind that is not supported: neither one nor three channels, or textured";
  if (n < 2 || count < 0 || table.max_order < 0 || table.max_order > count || !(table.eta > 0))
    return "has a broken header";
  const size_t nodes = static_cast<size_t>(n), pairs = nodes * nodes;
  // Divided, not multiplied: a hostile header could overflow the product.
  if (nodes > in.size() / 4 || pairs > in.size() / 12 || nodes + 3 * pairs + static_cast<size_t>(count) > in.size() / 4)
    return "ends too early";
  table.mu.resize(nodes), table.integrals.resize(pairs), table.a.resize(static_cast<size_t>(count));
  std::vector<int32_t> offsets(2 * pairs);
  in.take_all(table.mu.data(), nodes), in.take_all(table.integrals.data(), pairs);
  in.take_all(offsets.data(), 2 * pairs), in.take_all(table.a.data(), table.a.size());
  table.first.resize(pairs), table.order.resize(pairs);
  for (size_t k = 0; k < pairs; ++k) table.first[k] = offsets[2 * k], table.order[k] = offsets[2 * k + 1];
  std::string problem = check_table(table);
  if (problem.empty()) prepare_sampling(table);
  return problem;
}

const LobeRow lobe_rows::Fourier = {
    .name = "Fourier",
    .effect = Effect::Glossy,
    .reflects = true,
    .transmits = true,
    .eval = eval,
    .sample = draw,
};

}  // namespace whit
