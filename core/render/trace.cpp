#include "core/render/trace.h"

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/render/aov_transport.h"
#include "core/render/timed.h"
#include "core/render/tracer.h"
#include "core/scene/motion.h"

namespace whit {
namespace {

SampleChunk allocate_chunk(Worker& worker, int n) {
  Arena& arena = worker.arena;
  SampleChunk c;
  c.n = n;
  c.px = arena.alloc<int32_t>(n), c.py = arena.alloc<int32_t>(n), c.index = arena.alloc<uint32_t>(n);
  c.film_x = arena.floats(n), c.film_y = arena.floats(n);
  if (worker.scene.plan.live(Effect::MotionBlur)) c.time = arena.floats(n);
  c.ray_weight = arena.floats(n);
  c.radiance = arena.rgb(n);
  for_lanes(n, [&](int i) { c.radiance.r[i] = c.radiance.g[i] = c.radiance.b[i] = 0; });
  return c;
}

/// Arrays for the AOVs' values, as of samples that meet nothing.
void allocate_aovs(const AovPlan& plan, SampleChunk& c, Arena& arena) {
  const auto columns = static_cast<int>(plan.columns.size());
  c.aovs = arena.alloc<float*>(columns);
  for (int k = 0; k < columns; ++k) {
    c.aovs[k] = arena.floats(c.n);
    std::fill_n(c.aovs[k], c.n, plan.columns[static_cast<size_t>(k)]->nothing);
  }
  c.met = arena.alloc<uint8_t>(c.n);
  std::fill_n(c.met, c.n, uint8_t{0});
}

/// Times in [0,1] over the transform times, from the shutter's interval in seconds.
void sample_times(Worker& worker, const SampleKeys& keys) {
  const Scene& scene = worker.scene;
  scene.sampler().get_1d(keys, worker.layout.time, worker.chunk.time);
  const float open = scene.camera().shutter_open, length = scene.camera().shutter_close - open;
  const float start = static_cast<float>(scene.time_start);
  const float span = static_cast<float>(scene.time_end - scene.time_start);
  const float inverse = span != 0 ? 1 / span : 0.0f;
  float* time = worker.chunk.time;
  worker.statistics.time_samples += keys.n;
  for_lanes(keys.n, [&](int i) { time[i] = clamp_to((open + length * time[i] - start) * inverse, 0.0f, 1.0f); });
}

/// Positions on the lens; its middle for a camera that needs one where depth of field is switched off.
void sample_lens(Worker& worker, const SampleKeys& keys, CameraRays& out) {
  const Scene& scene = worker.scene;
  const bool sampled = scene.plan.live(Effect::DepthOfField);
  if (!sampled && !scene.camera().needs_lens()) return;
  float *u = worker.arena.floats(keys.n), *v = worker.arena.floats(keys.n);
  out.lens_u = u, out.lens_v = v;
  if (!sampled) {
    for_lanes(keys.n, [&](int i) { u[i] = v[i] = 0.5f; });
    return;
  }
  scene.sampler().get_2d(keys, worker.layout.lens, u, v);
  worker.statistics.lens_samples += keys.n;
}

/// Takes camera-space rays to render space; a moving camera has its own matrix for every ray.
void place_rays(const Scene& scene, const float* time, const Rays& rays) {
  const RayDifferentials& next = rays.differentials;
  const auto apply = [&](const Mat4d& m, int i) {
    const auto point = [&](const Vec3Lanes& p) { p.set(i, Vec3f(transform_point(m, Vec3d(p[i])))); };
    // Divided by the camera's own scale, directions stay unit vectors and differentials keep their ratio.
    const double scale = transform_vector(m, Vec3d(rays.d[i])).length();
    const auto vector = [&](const Vec3Lanes& v) { v.set(i, Vec3f(transform_vector(m, Vec3d(v[i])) / scale)); };
    point(rays.o), vector(rays.d);
    if (next) point(next.rx_o), point(next.ry_o), vector(next.rx_d), vector(next.ry_d);
  };
  for (int i = 0; i < rays.n; ++i) apply(interpolate_keys(scene.camera_keys, time ? time[i] : 0), i);
}

/// The same for a camera that stands still: one float matrix for all.
void place_rays_still(const Mat4d& camera, const Rays& rays) {
  float m[4][3];
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 3; ++c) m[r][c] = static_cast<float>(camera[r][c]);
  }
  const auto rotate = [&m](const Vec3f& v) {
    return Vec3f(v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0], v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
                 v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]);
  };
  const Vec3f move(m[3][0], m[3][1], m[3][2]);
  // All directions of a ray are divided by the length that its own has now: their ratio must stay.
  if (const RayDifferentials& next = rays.differentials) {
    for_lanes(rays.n, [&](int i) {
      const float inverse = 1 / length(rotate(rays.d[i]));
      next.rx_o.set(i, rotate(next.rx_o[i]) + move);
      next.ry_o.set(i, rotate(next.ry_o[i]) + move);
      next.rx_d.set(i, rotate(next.rx_d[i]) * inverse);
      next.ry_d.set(i, rotate(next.ry_d[i]) * inverse);
    });
  }
  for_lanes(rays.n, [&](int i) {
    rays.o.set(i, rotate(rays.o[i]) + move);
    const Vec3f d = rotate(rays.d[i]);
    rays.d.set(i, d * (1 / length(d)));
  });
}

/// A sample stands for its share of the pixel (Scene::footprint_samples).
void scale_differentials(const Rays& rays, int footprint_samples) {
  const RayDifferentials& next = rays.differentials;
  const float s = 1 / std::sqrt(static_cast<float>(footprint_samples));
  for_lanes(rays.n, [&](int i) {
    const Vec3f o = rays.o[i], d = rays.d[i];
    next.rx_o.set(i, o + (next.rx_o[i] - o) * s);
    next.ry_o.set(i, o + (next.ry_o[i] - o) * s);
    next.rx_d.set(i, d + (next.rx_d[i] - d) * s);
    next.ry_d.set(i, d + (next.ry_d[i] - d) * s);
  });
}

}  // namespace

void generate_camera_rays(Worker& worker, int n, const int32_t* px, const int32_t* py, const uint32_t* index) {
  const StageScope stage(worker.clock(), Stage::Camera);
  const Scene& scene = worker.scene;
  worker.chunk = allocate_chunk(worker, n);
  SampleChunk& c = worker.chunk;
  if (worker.aovs) allocate_aovs(*worker.aovs, c, worker.arena);
  uint32_t* stream = worker.arena.alloc<uint32_t>(n);
  for_lanes(n, [&](int i) { c.px[i] = px[i], c.py[i] = py[i], c.index[i] = index[i], stream[i] = 0; });
  const SampleKeys keys{n, c.px, c.py, c.index, stream};
  scene.sampler().pixel_offset(keys, c.film_x, c.film_y);
  for_lanes(n, [&](int i) {
    c.film_x[i] += static_cast<float>(c.px[i]);
    c.film_y[i] += static_cast<float>(c.py[i]);
  });
  if (scene.plan.live(Effect::MotionBlur)) sample_times(worker, keys);

  worker.level(0).start(0);
  const Rays rays = worker.level(0).append(n);
  CameraRays out;
  out.n = n;
  out.film_x = c.film_x, out.film_y = c.film_y;
  sample_lens(worker, keys, out);
  out.o = rays.o, out.d = rays.d, out.weight = c.ray_weight;
  scene.camera().generate(out);
  if (const RayDifferentials& next = rays.differentials) {
    scene.camera().generate_neighbours(out, 0, next.rx_o, next.rx_d);
    scene.camera().generate_neighbours(out, 1, next.ry_o, next.ry_d);
  }
  if (scene.camera_keys.size() == 1 || !compiled_in(Effect::MotionBlur)) {
    place_rays_still(scene.camera_keys.front(), rays);
  } else {
    place_rays(scene, c.time, rays);
  }
  if (rays.differentials) scale_differentials(rays, scene.footprint_samples);
  for_lanes(n, [&](int i) {
    rays.throughput.set(i, RGB(1.0f));
    rays.slot[i] = i;
    rays.stream[i] = 0;
  });
  if (rays.time) std::copy_n(c.time, n, rays.time);
  if (rays.pdf) std::fill_n(rays.pdf, n, std::numeric_limits<float>::infinity());
  if (rays.from) for_lanes(n, [&](int i) { rays.from.set(i, rays.o[i]); });
  if (rays.eta2) std::fill_n(rays.eta2, n, 1.0f);
  if (rays.via) std::fill_n(rays.via, n, static_cast<int32_t>(Via::Camera));
  worker.statistics.camera_samples += n;
}

namespace {

/// Where a group of rays from `begin` on ends: at a sample's border, so that the order in which a sample's rays are summed
/// never depends on its neighbours. Longer than a batch where one sample has more rays than that.
int end_of_group(const Rays& rays, int begin) {
  int end = std::min(begin + kBatch, rays.n);
  while (end < rays.n && end > begin && rays.slot[end] == rays.slot[end - 1]) --end;
  if (end > begin) return end;
  end = begin + 1;
  while (end < rays.n && rays.slot[end] == rays.slot[begin]) ++end;
  return end;
}

/// Batch by batch: the integrator says what happens to each.
void shade_group(Worker& worker, int depth, int begin, int end, Tracer& tracer, Transport& transport) {
  for (int first = begin; first < end; first += kBatch) {
    const ArenaScope scope(worker.arena);
    Rays batch = from_lane(worker.level(depth).rays(), first);
    batch.n = std::min(kBatch, end - first);
    worker.scene.integrator().shade(batch, transport);
    tracer.finish();
  }
}

}  // namespace

void trace_chunk(Worker& worker, const Wrap& wrap) {
  Tracer tracer(worker);
  std::optional<TimedTransport> timed;
  if (worker.clock()) timed.emplace(tracer, *worker.clock());
  const std::unique_ptr<Transport> wrapped = wrap ? wrap(tracer) : nullptr;
  Transport& watched = wrapped ? *wrapped : timed ? static_cast<Transport&>(*timed) : tracer;
  std::optional<AovTransport> aovs;
  if (worker.aovs && worker.aovs->watches()) aovs.emplace(watched, worker.scene, *worker.aovs, worker.chunk);
  Transport& transport = aovs ? static_cast<Transport&>(*aovs) : watched;
  // A depth is done before the next begins, so that batches stay full, but for rays that multiply: a full batch of the
  // next depth goes first.
  std::vector<Worker::Cursor>& stack = worker.cursors;
  stack.assign(1, {0, 0});
  while (!stack.empty()) {
    const int depth = stack.back().depth, begin = stack.back().next;
    const int waiting = worker.level(depth + 1).n();
    const Rays& rays = worker.level(depth).rays();
    if (begin == rays.n) {
      worker.leave(depth);
      stack.pop_back();
      if (waiting > 0) stack.push_back({depth + 1, 0});
      else worker.leave(depth + 1);
    } else if (waiting >= kBatch) {
      stack.push_back({depth + 1, 0});
    } else {
      const int end = end_of_group(rays, begin);
      stack.back().next = end;
      shade_group(worker, depth, begin, end, tracer, transport);
    }
  }
}

}  // namespace whit
