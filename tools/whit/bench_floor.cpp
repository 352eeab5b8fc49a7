#include "tools/whit/bench_floor.h"

#include "core/render/render.h"

namespace whit {
namespace {

constexpr std::array<RayKind, 3> kKinds{RayKind::Camera, RayKind::Secondary, RayKind::Shadow};

RayCall best_call(const Accel& accel, const RayRecord& record, RayKind kind) {
  RayCall best = RayCall::Single;
  double least = 0;
  for (const RayCall call : kRayCalls) {
    if (!is_usable(accel, kind, call)) continue;
    const double seconds =
        std::min(replay_seconds(accel, record, kind, call), replay_seconds(accel, record, kind, call));
    if (call != kRayCalls.front() && seconds >= least) continue;
    least = seconds, best = call;
  }
  return best;
}

}  // namespace

Floor measure_floor(const Scene& scene, int runs) {
  RenderOptions options;
  options.threads = 1;
  RayRecord record;
  scene.accel->record(&record);
  render(scene, options);
  scene.accel->record(nullptr);

  Floor floor;
  for (size_t k = 0; k < kKinds.size(); ++k) {
    floor.kinds[k].rays = record.count(kKinds[k]);
    floor.kinds[k].best_call = best_call(*scene.accel, record, kKinds[k]);
  }
  std::vector<double> ratios;
  std::array<std::vector<double>, 3> seconds;
  for (int run = 0; run < runs; ++run) {
    double sum = 0;
    for (size_t k = 0; k < kKinds.size(); ++k) {
      seconds[k].push_back(replay_seconds(*scene.accel, record, kKinds[k], floor.kinds[k].best_call));
      sum += seconds[k].back();
    }
    ratios.push_back(render(scene, options).seconds / sum);
  }
  for (size_t k = 0; k < kKinds.size(); ++k) floor.kinds[k].seconds = spread_of(seconds[k]).median;
  floor.ratio = spread_of(ratios);
  return floor;
}

std::string call_name(RayCall call) {
  switch (call) {
    case RayCall::Single: return "single";
    case RayCall::Packet8: return "8";
    case RayCall::Packet16: return "16";
    case RayCall::Packet16Coherent: return "16 coherent";
    case RayCall::StreamCoherent: return "64 coherent";
  }
  return "";
}

}  // namespace whit
