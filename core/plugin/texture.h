// Textures: functions from surface points to numbers or colours, and Tex<T>, a parameter that may be one.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>

#include "core/batch/shading.h"
#include "core/plugin/plugin.h"

namespace whit {

/// One value per lane: floats, or colour triples.
template <class T>
struct ValueLanes;
template <>
struct ValueLanes<float> {
  using type = float*;
  static type alloc(Arena& a, int n) { return a.floats(n); }
  static void set(type lanes, int i, float v) { lanes[i] = v; }
};
template <>
struct ValueLanes<RGB> {
  using type = RGBLanes;
  static type alloc(Arena& a, int n) { return a.rgb(n); }
  static void set(const type& lanes, int i, const RGB& v) { lanes.set(i, v); }
};

/// How finely a texture that is a picture is looked up.
struct TexelUse {
  int width = 0, height = 0;  ///< Of the picture.
  /// At each point, how many of its texels the shorter and the longer side of the footprint cover.
  float *least = nullptr, *most = nullptr;
};

/// A texture of floats or of linear colours (RGB).
template <class T>
class Texture : public Plugin {
 public:
  static constexpr const char* kCategory = std::is_same_v<T, float> ? "float texture" : "spectrum texture";
  using Lanes = typename ValueLanes<T>::type;

  /// The CTM at the Texture statement, set by the builder before prepare(): where non-uv mappings live.
  Mat4d texture_to_world;

  /// Filtering, for a texture that does not say: one that ignores the footprint calls for nothing.
  EffectSet effects() const override { return {Effect::TextureFiltering}; }

  /// Writes the texture's value at each of the s.n points to out[0 .. s.n). One that is made of textures is also asked
  /// with no points, before prepare(): the textures that it then evaluates are all that it may read.
  virtual void evaluate(const ShadingBatch& s, const Lanes& out) const = 0;

  /// The value when it is the same everywhere, so that it folds away; nullopt otherwise. After binding.
  virtual std::optional<T> constant() const { return std::nullopt; }

  /// Of a texture that is a picture, after prepare(): what the points of a batch with footprints use of it.
  virtual std::optional<TexelUse> texels_used(const ShadingBatch& /*s*/) const { return std::nullopt; }

  std::vector<const Plugin*> textures_read() const final {
    std::vector<const Plugin*> textures;
    Arena arena(ShadingBatch::kNoPoints);
    ShadingBatch no_points;
    no_points.arena = &arena;
    no_points.textures_asked = &textures;
    evaluate(no_points, ValueLanes<T>::alloc(arena, 0));
    return textures;
  }
};

/// Stands where a parameter could not be had, which has been reported, so that it is known who asks for it.
template <class T>
class MissingTexture final : public Texture<T> {
 public:
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    for_lanes(s.n, [&](int i) { ValueLanes<T>::set(out, i, T(0.0f)); });
  }
};

/// Whether a texture of floats or colours is the same everywhere, so that what uses it holds the value.
inline bool is_folded(const Plugin& texture) {
  if (const auto* floats = dynamic_cast<const Texture<float>*>(&texture)) return floats->constant().has_value();
  const auto* colours = dynamic_cast<const Texture<RGB>*>(&texture);
  return colours && colours->constant().has_value();
}

/// A parameter that is a constant or a texture. Textures that turn out constant have folded into constants.
template <class T>
class Tex {
 public:
  Tex() = default;
  explicit Tex(const T& value) : value_(value) {}
  explicit Tex(std::shared_ptr<Texture<T>> texture) : texture_(std::move(texture)) {
    if (texture_) {
      if (const auto c = texture_->constant()) value_ = *c, texture_.reset();
    }
  }

  bool is_constant() const { return !texture_; }
  /// The constant's value; meaningless when !is_constant().
  const T& value() const { return value_; }
  /// The texture, or null when constant.
  const std::shared_ptr<Texture<T>>& texture() const { return texture_; }

  /// The value at every point of s, in s.arena.
  typename ValueLanes<T>::type operator()(const ShadingBatch& s) const {
    const auto out = ValueLanes<T>::alloc(*s.arena, s.n);
    if (s.textures_asked) {
      if (texture_) s.textures_asked->push_back(texture_.get());
    } else if (compiled_in(Effect::Textures) && texture_) {
      const StageScope stage(s.clock, Stage::Textures);
      if (s.texture_values) *s.texture_values += s.n;
      texture_->evaluate(s, out);
    } else {
      const T v = value_;
      for_lanes(s.n, [&](int i) { ValueLanes<T>::set(out, i, v); });
    }
    return out;
  }

 private:
  T value_{};
  std::shared_ptr<Texture<T>> texture_;
};

}  // namespace whit
