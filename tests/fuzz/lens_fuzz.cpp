// libFuzzer entry: any bytes are a lens file. A camera that can be made of it gives rays that are rays.
#include <cmath>

#include "core/plugin/camera.h"
#include "core/plugin/registry.h"
#include "tests/fuzz/shared/fuzz.h"

namespace {

using whit::fuzz::require;

std::shared_ptr<whit::Camera> make_camera(const std::string& lens) {
  static const whit::PluginInfo& info = *whit::find_plugin("camera", "realistic");
  whit::Diagnostics said;
  const std::shared_ptr<whit::Plugin> plugin = info.make();
  whit::BindContext bind;
  bind.diagnostics = &said, bind.statement_name = "realistic";
  whit::Parameter file{.type = whit::ParamType::String, .name = "lensfile", .values = std::vector<std::string>{lens}};
  require(whit::bind_parameters(info, *plugin, {file}, bind));
  auto camera = std::static_pointer_cast<whit::Camera>(plugin);
  camera->film.resolution = {16, 9};
  whit::PrepareContext context;
  context.diagnostics = &said;
  camera = whit::prepared(std::move(camera), context);
  require((camera == nullptr) == said.has_errors());
  return camera;
}

/// Rays through the corners, the edges and the middle of film and lens.
void generate(const whit::Camera& camera) {
  constexpr int kCount = 8;
  const float x[kCount] = {0, 16, 8, 8, 0.5f, 3, 15.9f, 8}, y[kCount] = {0, 9, 4.5f, 0, 8.5f, 3, 0.1f, 4.5f};
  const float u[kCount] = {0, 0.999f, 0.5f, 0.5f, 0, 0.3f, 0.9f, 0.5f},
              v[kCount] = {0, 0, 0.5f, 0.999f, 0.5f, 0.7f, 0.1f, 0.501f};
  float out[7][kCount];
  whit::CameraRays rays;
  rays.n = kCount, rays.film_x = x, rays.film_y = y, rays.lens_u = u, rays.lens_v = v;
  rays.o = {out[0], out[1], out[2]}, rays.d = {out[3], out[4], out[5]}, rays.weight = out[6];
  camera.generate(rays);
  for (int i = 0; i < kCount; ++i) {
    require(std::isfinite(rays.weight[i]) && rays.weight[i] >= 0);
    for (const auto& values : out) require(std::isfinite(values[i]));
    require(std::abs(rays.d[i].length() - 1) < 1e-3f);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static whit::fuzz::MemoryFile file;
  file.set(data, size);
  if (const auto camera = make_camera(file.path())) generate(*camera);
  return 0;
}

/// Letters are no lens: half of the time numbers alone are changed, one for another.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  whit::fuzz::Dice dice(seed);
  if (dice.one_in(2)) return LLVMFuzzerMutate(data, size, max_size);
  return whit::fuzz::exchange_number(data, size, max_size, dice);
}
