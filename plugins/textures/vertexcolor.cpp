// The colours that a mesh has at its vertices, interpolated; 1 where it has none.
#include "core/base/fastmath.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class VertexColor : public Texture<RGB> {
 public:
  EffectSet effects() const override { return {}; }
  MeshAttributes attributes_read() const override { return {.uvs1 = false, .colors = true}; }
  void evaluate(const ShadingBatch& s, const RGBLanes& out) const override {
    for_lanes(s.n, [&](int i) { out.set(i, s.color ? s.color[i] : RGB(1.0f)); });
  }
};

class VertexNumber : public Texture<float> {
 public:
  Choice channel;
  enum Channel { Alpha, Luminance, Red, Green, Blue };

  EffectSet effects() const override { return {}; }
  MeshAttributes attributes_read() const override { return {.uvs1 = false, .colors = true}; }
  void evaluate(const ShadingBatch& s, float* const& out) const override {
    if (!s.color) return for_lanes(s.n, [&](int i) { out[i] = 1; });
    if (channel.index == Luminance) return for_lanes(s.n, [&](int i) { out[i] = luminance(s.color[i]); });
    const float* const from[] = {s.color_alpha, nullptr, s.color.r, s.color.g, s.color.b};
    const float* const values = from[channel.index];
    for_lanes(s.n, [&](int i) { out[i] = values[i]; });
  }
};

constexpr const char* kDoc = "The colours at the vertices of a mesh, linear; 1 on shapes that have none.";

const Register<VertexColor> vertexcolor_spectrum{"vertexcolor", kDoc};
const Register<VertexNumber> vertexcolor_float{
    "vertexcolor", kDoc,
    choice(&VertexNumber::channel, "channel", {"alpha", "luminance", "red", "green", "blue"}, "What of the colour.")};

}  // namespace
}  // namespace whit
