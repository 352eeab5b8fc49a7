// A camera with a real lens: rays from the film are refracted at every surface of a lens file, so that focus, distortion
// and vignetting are what the glass makes of them. Rays aim at the exit pupil, whose bounds are found for every distance
// from the film's centre. Sources: Kolb, Mitchell, Hanrahan, A Realistic Camera Model, 1995; PBR book, 3rd ed., 6.4.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/spectrum.h"
#include "core/plugin/camera.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

constexpr int kBlock = 128;

/// One surface, in camera space: the film at z = 0, the scene towards +z.
struct Surface {
  double radius = 0;     ///< Of curvature, positive when its centre lies towards the film; 0 for the stop.
  double z = 0;          ///< Where it meets the axis.
  double aperture2 = 0;  ///< Square of half its diameter.
  double eta_film = 1, eta_scene = 1;  ///< Indices of refraction at its two sides.
};

/// A ray inside the lens; d need not have length 1.
struct LensRay {
  Vec3d o{0, 0, 0}, d{0, 0, 1};
  bool alive = true;
};

/// Takes a ray through one surface, towards the scene or away from it. No branches, for loops over lanes.
inline LensRay pass_surface(const Surface& s, bool to_scene, const LensRay& r) {
  const bool stop = s.radius == 0;
  const double oz = r.o.z - (s.z - s.radius);
  const double a = r.d.x * r.d.x + r.d.y * r.d.y + r.d.z * r.d.z;
  const double b = r.o.x * r.d.x + r.o.y * r.d.y + oz * r.d.z;
  const double c = r.o.x * r.o.x + r.o.y * r.o.y + oz * oz - s.radius * s.radius;
  const double disc = b * b - a * c, root = std::sqrt(disc > 0 ? disc : 0.0);
  // Of the sphere's two halves the one on the lens: the nearer when the ray comes from outside the sphere.
  const bool nearer = (r.d.z < 0) != (s.radius < 0);
  const double on_sphere = (nearer ? -b - root : -b + root) / a;
  const double on_plane = (s.z - r.o.z) / (r.d.z != 0 ? r.d.z : 1.0);
  const double t = stop ? on_plane : on_sphere;
  const Vec3d p(r.o.x + t * r.d.x, r.o.y + t * r.d.y, r.o.z + t * r.d.z);
  const bool hit = (stop ? (r.d.z > 0) == to_scene && r.d.z != 0 : disc >= 0) && t >= 0;
  const bool open = p.x * p.x + p.y * p.y <= s.aperture2;

  // Snell's law for the unit vector along d and the normal on the ray's side.
  const double inverse_length = 1 / std::sqrt(a);
  const double eta = to_scene ? s.eta_film / s.eta_scene : s.eta_scene / s.eta_film;
  const double nx = p.x, ny = p.y, nz = p.z - (s.z - s.radius);
  const double along = (nx * r.d.x + ny * r.d.y + nz * r.d.z) * inverse_length;
  const double size = (along > 0 ? -1.0 : 1.0) / (stop ? 1.0 : std::abs(s.radius));
  const double cos_i = -along * size;
  const double sin2_i = 1 - cos_i * cos_i, cos2_t = 1 - eta * eta * (sin2_i > 0 ? sin2_i : 0.0);
  const double k = (eta * cos_i - std::sqrt(cos2_t > 0 ? cos2_t : 0.0)) * size, e = eta * inverse_length;
  const bool through = stop || cos2_t > 0;
  const Vec3d bent(e * r.d.x + k * nx, e * r.d.y + k * ny, e * r.d.z + k * nz);
  return {p, {stop ? r.d.x : bent.x, stop ? r.d.y : bent.y, stop ? r.d.z : bent.z}, r.alive && hit && open && through};
}

/// Up to kBlock rays inside the lens, structure of arrays.
struct LensRays {
  alignas(64) double ox[kBlock], oy[kBlock], oz[kBlock], dx[kBlock], dy[kBlock], dz[kBlock];
  alignas(64) int32_t alive[kBlock];

  void set(int i, const LensRay& r) {
    ox[i] = r.o.x, oy[i] = r.o.y, oz[i] = r.o.z;
    dx[i] = r.d.x, dy[i] = r.d.y, dz[i] = r.d.z;
    alive[i] = r.alive ? 1 : 0;
  }
  LensRay get(int i) const { return {{ox[i], oy[i], oz[i]}, {dx[i], dy[i], dz[i]}, alive[i] != 0}; }
};

/// The surfaces of a lens, the one next to the film first.
class Lens {
 public:
  std::vector<Surface> surfaces;

  /// Rays from the film to the scene.
  void trace(int n, LensRays& rays) const {
    for (const Surface& s : surfaces) {
      for_lanes(n, [&rays, s](int i) { rays.set(i, pass_surface(s, true, rays.get(i))); });
    }
  }
  LensRay trace_one(LensRay ray, bool to_scene) const {
    const size_t n = surfaces.size();
    for (size_t i = 0; i < n; ++i) ray = pass_surface(surfaces[to_scene ? i : n - 1 - i], to_scene, ray);
    return ray;
  }
  double rear_z() const { return surfaces.front().z; }
  double front_z() const { return surfaces.back().z; }
  double rear_radius() const { return std::sqrt(surfaces.front().aperture2); }
  void move(double along_z) {
    for (Surface& s : surfaces) s.z += along_z;
  }

  /// How far the lens has to move so that it focuses at `distance` from the film, by its thick lens approximation from
  /// rays at height x. False when it cannot, or such rays do not get through.
  bool focus(double distance, double x, double& move) const {
    const LensRay from_scene{{x, 0, front_z() + 1}, {0, 0, -1}}, from_film{{x, 0, rear_z() - 1}, {0, 0, 1}};
    const LensRay at_film = trace_one(from_scene, false), at_scene = trace_one(from_film, true);
    if (!at_film.alive || !at_scene.alive || at_film.d.x == 0 || at_scene.d.x == 0) return false;
    const auto z_at_height = [](const LensRay& r, double height) { return r.o.z + (height - r.o.x) / r.d.x * r.d.z; };
    // pbrt's axis points away from the scene: principal points of both sides, and the focal point of the film's.
    const double p0 = -z_at_height(at_film, x), p1 = -z_at_height(at_scene, x), f = -z_at_height(at_film, 0) - p0;
    const double c = (p1 + distance - p0) * (p1 + distance - 4 * f - p0);
    if (!(c > 0)) return false;
    move = 0.5 * (p1 + distance + p0 - std::sqrt(c));
    return true;
  }
};

/// A rectangle on the plane of the rear surface, y from -y1 to y1; empty at first.
struct Pupil {
  double x0 = 1e30, x1 = -1e30, y1 = 0;
  bool empty() const { return x0 > x1; }
  double area() const { return (x1 - x0) * 2 * y1; }
  void include(const Pupil& o) { x0 = std::min(x0, o.x0), x1 = std::max(x1, o.x1), y1 = std::max(y1, o.y1); }
  Pupil grown(double by) const { return {x0 - by, x1 + by, y1 + by}; }
};

/// Finds what the film sees of the lens: the bounds of all points of the rear plane through which rays pass.
class PupilFinder {
 public:
  explicit PupilFinder(const Lens& lens) : lens_(lens), whole_{-1.5 * lens.rear_radius(), 1.5 * lens.rear_radius(), 0} {
    whole_.y1 = whole_.x1;
  }

  /// Bounds for films positions in `bands` rings up to `radius`, a little larger than exact by pbrt's margin, which is
  /// part of the exposure of "simpleweighting".
  std::vector<Pupil> rings(int bands, double radius) const {
    std::vector<Pupil> seen;  // from the edges and the middle of each ring
    bool vignetted = false;
    for (int i = 0; i <= 2 * bands; ++i) {
      const double r = radius * i / (2 * bands);
      Pupil p;
      // The pupil wanders little from one radius to the next.
      if (i > 0 && !seen.back().empty()) p = search(r, seen.back().grown(0.25 * seen.back().y1), 32);
      if (p.empty() && !vignetted) p = search(r, whole_, 512);
      vignetted = vignetted || p.empty();
      seen.push_back(p);
    }
    const double margin = 2 * std::sqrt(2.0) * (whole_.x1 - whole_.x0) / 1024;
    std::vector<Pupil> out;
    for (size_t i = 0; i + 2 < seen.size(); i += 2) {
      Pupil ring = seen[i];
      ring.include(seen[i + 1]), ring.include(seen[i + 2]);
      out.push_back(ring.empty() ? whole_ : ring.grown(margin));
    }
    return out;
  }

 private:
  /// True when a ray from (r, 0) on the film passes any of `n` points of the rear plane from `a` to `b`, ends included;
  /// `first` and `last` are then the outermost ones as parts of the way.
  bool line_passes(double r, Vec2d a, Vec2d b, int n, double& first, double& last) const {
    LensRays rays;
    bool any = false;
    for (int begin = 0; begin < n; begin += kBlock) {
      const int count = std::min(kBlock, n - begin);
      const auto part = [&](int i) { return static_cast<double>(begin + i) / (n - 1); };
      for (int i = 0; i < count; ++i) {
        const Vec2d at = a + (b - a) * part(i);
        rays.set(i, {{r, 0, 0}, {at.x - r, at.y, lens_.rear_z()}});
      }
      lens_.trace(count, rays);
      for (int i = 0; i < count; ++i) {
        if (!rays.alive[i]) continue;
        if (!any) first = part(i);
        last = part(i), any = true;
      }
    }
    return any;
  }

  /// The bounds within a window: on a grid first, then each side by bisection.
  Pupil search(double r, const Pupil& window, int columns) const {
    const Pupil in{std::max(window.x0, whole_.x0), std::min(window.x1, whole_.x1), std::min(window.y1, whole_.y1)};
    const int rows = columns / 2;
    const double dx = (in.x1 - in.x0) / (columns - 1), dy = in.y1 / (rows - 1);
    Pupil p;
    double first = 0, last = 0;
    for (int row = 0; row < rows; ++row) {
      if (!line_passes(r, {in.x0, row * dy}, {in.x1, row * dy}, columns, first, last)) continue;
      p.include({in.x0 + first * (in.x1 - in.x0), in.x0 + last * (in.x1 - in.x0), row * dy});
    }
    if (p.empty()) return p;
    constexpr int kLine = 64;
    const double top = std::min(p.y1 + dy, whole_.y1);
    const auto column = [&](double x) { return line_passes(r, {x, 0}, {x, top}, kLine, first, last); };
    const Pupil coarse = p;
    const auto row = [&](double y) { return line_passes(r, {coarse.x0, y}, {coarse.x1, y}, kLine, first, last); };
    p.x0 = bisect(coarse.x0, std::max(coarse.x0 - dx, whole_.x0), column);
    p.x1 = bisect(coarse.x1, std::min(coarse.x1 + dx, whole_.x1), column);
    p.y1 = bisect(coarse.y1, top, row);
    return p;
  }

  /// Where between `inside` and `outside` rays cease to pass.
  template <class Passes>
  static double bisect(double inside, double outside, const Passes& passes) {
    for (int i = 0; i < 8; ++i) {
      const double middle = 0.5 * (inside + outside);
      (passes(middle) ? inside : outside) = middle;
    }
    return inside;
  }

  const Lens& lens_;
  Pupil whole_;
};

class Realistic final : public Camera {
 public:
  FileName lensfile;
  float aperturediameter = 1;  ///< Millimetres.
  float focusdistance = 10;    ///< Scene units (metres), from the film.
  bool simpleweighting = true;

  bool needs_lens() const override { return true; }

  void check(Diagnostics& d, SourcePos statement) override {
    if (lensfile.empty()) d.error(statement, "the realistic camera needs a \"string lensfile\"");
    if (shutter_open <= shutter_close) return;
    d.warning(statement, "the shutter closes before it opens", "the two times are swapped");
    std::swap(shutter_open, shutter_close);
  }

  bool prepare(const PrepareContext& ctx) override {
    if (!read_lens(ctx)) return false;
    if (!(film.diagonal > 0)) {
      ctx.diagnostics->error(ctx.statement, "the realistic camera needs a film whose \"diagonal\" is above 0");
      return false;
    }
    double move = 0;
    if (!lens_.focus(static_cast<double>(focusdistance), 0.001 * film.diagonal, move)) {
      ctx.diagnostics->error(ctx.statement, "this lens cannot be focused at \"focusdistance\"");
      return false;
    }
    lens_.move(move);
    if (!(lens_.rear_z() > 0)) {
      ctx.diagnostics->error(ctx.statement, "focused at \"focusdistance\", the lens would stand behind the film");
      return false;
    }
    const double aspect = static_cast<double>(film.resolution.y) / film.resolution.x;
    film_width_ = film.diagonal / std::sqrt(1 + aspect * aspect), film_height_ = aspect * film_width_;
    pupils_ = PupilFinder(lens_).rings(kRings, 0.5 * film.diagonal);
    const double rear = lens_.rear_z();
    const double open = static_cast<double>(shutter_close) - static_cast<double>(shutter_open);
    exposure_ = simpleweighting ? 1 / pupils_.front().area() : open / (rear * rear);
    return true;
  }

  void generate(const CameraRays& rays) const override {
    for (int first = 0; first < rays.n; first += kBlock) {
      const int n = std::min(kBlock, rays.n - first);
      generate_shifted(rays, first, n, 0, 0, rays.o.from(first), rays.d.from(first), rays.weight + first);
    }
  }

  /// Extrapolated from a twentieth of a pixel, to one side or else to the other; the ray itself where neither gets
  /// through.
  void generate_neighbours(const CameraRays& rays, int axis, const Vec3Lanes& o, const Vec3Lanes& d) const override {
    for (int first = 0; first < rays.n; first += kBlock) {
      const int n = std::min(kBlock, rays.n - first);
      extrapolate(rays, first, n, axis == 0 ? Vec2d(1, 0) : Vec2d(0, 1), o.from(first), d.from(first));
    }
  }

 private:
  static constexpr int kRings = 64;  ///< pbrt's: part of the exposure of "simpleweighting".

  bool read_lens(const PrepareContext& ctx) {
    const SpdFile file = read_spd_file(lensfile.path);  // any table of numbers
    if (!file.error.empty() || file.pairs.size() % 4 != 0) {
      const std::string why = file.readable && !file.pairs.empty() ? "is not a table of four columns" : file.error;
      ctx.diagnostics->file_error(lensfile.where, lensfile.path + ": " + why);
      return false;
    }
    // The file lists surfaces from the scene to the film, in millimetres: radius, distance to the next, index behind it,
    // diameter.
    constexpr double kMetre = 0.001;
    lens_.surfaces.clear();
    double z = 0, eta = 1;
    for (size_t i = 0; i < file.pairs.size(); i += 4) {
      const double* row = file.pairs.data() + i;
      const double half = 0.5 * kMetre * (row[0] == 0 ? stop_diameter(ctx, row[3]) : row[3]);
      lens_.surfaces.push_back({row[0] * kMetre, -z, half * half, row[2] != 0 ? row[2] : 1.0, eta});
      eta = row[2] != 0 ? row[2] : 1.0;
      z += row[1] * kMetre;
    }
    std::reverse(lens_.surfaces.begin(), lens_.surfaces.end());
    lens_.move(z);
    return true;
  }

  double stop_diameter(const PrepareContext& ctx, double largest) const {
    if (static_cast<double>(aperturediameter) <= largest) return static_cast<double>(aperturediameter);
    ctx.diagnostics->warning(ctx.statement, "\"aperturediameter\" is larger than the lens file's stop",
                             "the stop is opened as far as it goes");
    return largest;
  }

  /// Rays from the film positions plus (dx, dy) pixels, in camera space; weight 0 where the lens stops them.
  void generate_shifted(const CameraRays& rays, int first, int n, double dx, double dy, const Vec3Lanes& o,
                        const Vec3Lanes& d, float* weight) const {
    LensRays inside;
    alignas(64) double scale[kBlock];
    const double step_x = film_width_ / film.resolution.x, step_y = film_height_ / film.resolution.y;
    const double to_ring = kRings / (0.5 * film.diagonal), rear = lens_.rear_z(), exposure = exposure_;
    const Pupil* const pupils = pupils_.data();
    const double middle_x = 0.5 * film.resolution.x, middle_y = 0.5 * film.resolution.y;
    for_lanes(n, [&, fx = rays.film_x + first, fy = rays.film_y + first, u = rays.lens_u + first,
                  v = rays.lens_v + first](int i) {
      // The picture on the film is upside down; raster y runs down.
      const double x = (middle_x - (static_cast<double>(fx[i]) + dx)) * step_x;
      const double y = ((static_cast<double>(fy[i]) + dy) - middle_y) * step_y;
      const double r = std::sqrt(x * x + y * y), ring = r * to_ring;
      const Pupil& p = pupils[static_cast<int>(ring < kRings - 1 ? ring : kRings - 1.0)];
      const double px = p.x0 + static_cast<double>(u[i]) * (p.x1 - p.x0),
                   py = p.y1 * (2 * static_cast<double>(v[i]) - 1);
      // The bounds are those for points on the x axis: turn them.
      const double c = r > 0 ? x / r : 1.0, s = r > 0 ? y / r : 0.0;
      const Vec3d along(c * px - s * py - x, s * px + c * py - y, rear);
      const double cos2 = rear * rear / (along.x * along.x + along.y * along.y + rear * rear);
      inside.set(i, {{x, y, 0}, along});
      scale[i] = cos2 * cos2 * exposure * (p.x1 - p.x0) * 2 * p.y1;
    });
    lens_.trace(n, inside);
    for_lanes(n, [&](int i) {
      const LensRay r = inside.get(i);
      const double inverse = 1 / std::sqrt(r.d.x * r.d.x + r.d.y * r.d.y + r.d.z * r.d.z);
      const auto part = [&](double value, double otherwise) { return static_cast<float>(r.alive ? value : otherwise); };
      o.set(i, {part(r.o.x, 0), part(r.o.y, 0), part(r.o.z, rear)});
      d.set(i, {part(r.d.x * inverse, 0), part(r.d.y * inverse, 0), part(r.d.z * inverse, 1)});
      weight[i] = part(scale[i], 0);
    });
  }

  void extrapolate(const CameraRays& rays, int first, int n, Vec2d pixel, const Vec3Lanes& o,
                   const Vec3Lanes& d) const {
    alignas(64) float storage[8][kBlock];
    const Vec3Lanes other_o{storage[0], storage[1], storage[2]}, other_d{storage[3], storage[4], storage[5]};
    float *const reaches = storage[6], *const other_reaches = storage[7];
    constexpr double kStep = 0.05;
    generate_shifted(rays, first, n, kStep * pixel.x, kStep * pixel.y, o, d, reaches);
    generate_shifted(rays, first, n, -kStep * pixel.x, -kStep * pixel.y, other_o, other_d, other_reaches);
    const Vec3Lanes from_o = rays.o.from(first), from_d = rays.d.from(first);
    for_lanes(n, [&](int i) {
      const bool ahead = reaches[i] > 0, behind = other_reaches[i] > 0;
      const float ahead_by = ahead ? static_cast<float>(1 / kStep) : 0.0f;
      const float behind_by = !ahead && behind ? static_cast<float>(-1 / kStep) : 0.0f;
      o.set(i, from_o[i] + (o[i] - from_o[i]) * ahead_by + (other_o[i] - from_o[i]) * behind_by);
      d.set(i, from_d[i] + (d[i] - from_d[i]) * ahead_by + (other_d[i] - from_d[i]) * behind_by);
    });
  }

  Lens lens_;
  std::vector<Pupil> pupils_;  ///< For rings of equal width around the film's centre.
  double film_width_ = 1, film_height_ = 1, exposure_ = 1;
};

const Register<Realistic> realistic{
    "realistic",
    "Camera with the lens of a lens file; scene units are metres.",
    param(
        &Realistic::lensfile, "lensfile", Unit::None,
        "The lens file: a line of radius, thickness, index, diameter (mm) for each surface, front to film. Required."),
    param(&Realistic::aperturediameter, "aperturediameter", 1.0f, Unit::Millimetres, "Diameter of the aperture stop.",
          kPositive),
    param(&Realistic::focusdistance, "focusdistance", 10.0f, Unit::Length, "Distance from the film that is sharp.",
          kPositive),
    param(&Realistic::simpleweighting, "simpleweighting", true, Unit::None,
          "Exposure relative to the film's centre; otherwise by the pupil's size and the shutter's time."),
    shutteropen_param(),
    shutterclose_param()};

}  // namespace
}  // namespace whit
