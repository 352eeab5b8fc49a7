#include "core/scene/light_choice.h"

#include "core/scene/scene.h"

namespace whit {
namespace {
class UniformChoice final : public LightChoice {
 public:
  explicit UniformChoice(int count) : count_(count) {}
  void choose(int n, const Vec3Lanes&, const float* u, int32_t* light, float* probability) const override {
    for (int i = 0; i < n; ++i) {
      light[i] = std::min(static_cast<int>(u[i] * static_cast<float>(count_)), count_ - 1);
      probability[i] = 1 / static_cast<float>(count_);
    }
  }
  float probability(int, const Vec3f&) const override { return 1 / static_cast<float>(count_); }

 private:
  int count_;
};
}  // namespace
std::unique_ptr<LightChoice> make_light_choice(std::span<const SceneLight> lights, LightStrategy, double) {
  return std::make_unique<UniformChoice>(static_cast<int>(lights.size()));
}
}  // namespace whit
