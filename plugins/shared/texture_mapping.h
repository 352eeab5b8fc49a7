// From surface points to texture coordinates: pbrt-v3's four 2D mappings and its 3D mapping.
//
// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 10.2. Transforms are composed in
// double precision and rounded once, so that a scene far from the origin keeps its textures.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "core/plugin/registry.h"
#include "core/plugin/texture.h"

namespace whit {

/// Texture coordinates of a batch, in its arena, and their derivatives along the screen's x and y; these are
/// null when the batch has no footprints.
struct MappedPoints {
  float *s = nullptr, *t = nullptr;
  float *dsdx = nullptr, *dtdx = nullptr, *dsdy = nullptr, *dtdy = nullptr;
};

/// An affine map in float: p' = (dot(p, x) + tx, dot(p, y) + ty, dot(p, z) + tz).
struct AffineMap {
  Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, offset{0, 0, 0};
  AffineMap() = default;
  explicit AffineMap(const Mat4d& m);
  Vec3f point(const Vec3f& p) const { return vector(p) + offset; }
  Vec3f vector(const Vec3f& v) const {
    return {v.x * x.x + v.y * x.y + v.z * x.z, v.x * y.x + v.y * y.y + v.z * y.z, v.x * z.x + v.y * z.y + v.z * z.z};
  }
};

/// A 2D mapping, ready to map.
struct TextureMapping2D {
  enum Kind { Uv, Spherical, Cylindrical, Planar } kind = Uv;
  float su = 1, sv = 1, du = 0, dv = 0;  ///< Uv: s = su u + du, t = sv v + dv,
  float s_of_v = 0, t_of_u = 0;          ///< and these times the other; `turns` where they are not 0.
  bool turns = false;
  bool second_uvs = false;  ///< (u, v) are those of the second set, where a mesh has it.
  AffineMap from_render;    ///< Spherical, Cylindrical: to texture space. Planar: x gives s, y gives t.

  MappedPoints map(const ShadingBatch& s) const;
};

/// Whether there is a way back; Imath gives the identity where there is none.
inline bool is_invertible(const Mat4d& m) { return m == Mat4d() || m.gjInverse() != Mat4d(); }

/// A texture in two dimensions: declares, binds and prepares its mapping. Register it with Register2D.
template <class T>
class Texture2D : public Texture<T> {
 public:
  Choice mapping;  ///< As TextureMapping2D::Kind.
  float uscale = 1, vscale = 1, udelta = 0, vdelta = 0;
  FloatList uvmatrix;  ///< 6, or none.
  int uvset = 0;
  Vector v1, v2;

  void check(Diagnostics& diagnostics, SourcePos) override {
    if (uvmatrix.given && uvmatrix.size() != 6)
      diagnostics.error(uvmatrix.where, "\"uvmatrix\" has " + std::to_string(uvmatrix.size()) + " numbers",
                        "it takes 6: s = m0 u + m1 v + m2, t = m3 u + m4 v + m5");
  }

  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all;
    const auto add = [&all](std::initializer_list<const char*> names, const char* why) {
      for (const char* name : names) all.push_back({name, why});
    };
    const int kind = mapping.index;
    if (kind != TextureMapping2D::Uv)
      add({"uscale", "vscale", "uvmatrix", "uvset"}, "the \"mapping\" is not by (u, v)");
    if (kind == TextureMapping2D::Spherical || kind == TextureMapping2D::Cylindrical)
      add({"udelta", "vdelta"}, "the \"mapping\" takes no shift");
    if (kind != TextureMapping2D::Planar) add({"v1", "v2"}, "the \"mapping\" is not planar");
    return all;
  }

  MeshAttributes attributes_read() const override { return {.uvs1 = asks_second_uvs(), .colors = false}; }

  bool read(Diagnostics& diagnostics, SourcePos statement) override {
    if (mapping.index == TextureMapping2D::Uv || is_invertible(this->texture_to_world)) return true;
    diagnostics.error(statement, "the transform of this texture's mapping cannot be inverted",
                      "nothing may be scaled to zero or infinity");
    return false;
  }

  bool prepare(const PrepareContext& ctx) override {
    map_ = make_mapping(mapping.index, {uscale, vscale, udelta, vdelta, uvmatrix.values}, v1.value, v2.value,
                        this->texture_to_world, ctx.space);
    map_.second_uvs = asks_second_uvs();
    return true;
  }

 protected:
  TextureMapping2D map_;

 private:
  bool asks_second_uvs() const { return mapping.index == TextureMapping2D::Uv && uvset == 1; }
  struct UvParameters {
    float su, sv, du, dv;
    std::span<const double> matrix;
  };
  static TextureMapping2D make_mapping(int kind, const UvParameters& uv, const Vec3d& v1, const Vec3d& v2,
                                       const Mat4d& texture_to_world, const RenderSpace& space);
};

extern template class Texture2D<float>;
extern template class Texture2D<RGB>;

/// From render space to the space of 3D textures. pbrt-v3 applies the CTM of the Texture statement itself to
/// world points, not its inverse (its 2D mappings take the inverse), and scenes are made for that.
AffineMap mapping_3d(const Mat4d& texture_to_world, const RenderSpace& space);

/// Registers a Texture2D<T> subclass, the mapping's parameters after its own.
template <class Plugin2D, class T>
class Register2D : public Register<Plugin2D> {
 public:
  template <class... D, class... V>
  Register2D(const char* name, const char* doc, DeclaredParam<D, V>... own)
      : Register<Plugin2D>(
            name, doc, own...,
            choice(&Texture2D<T>::mapping, "mapping", {"uv", "spherical", "cylindrical", "planar"},
                   "How points become texture coordinates."),
            param(&Texture2D<T>::uscale, "uscale", 1.0f, Unit::None, "Repeats along u (uv mapping)."),
            param(&Texture2D<T>::vscale, "vscale", 1.0f, Unit::None, "Repeats along v (uv mapping)."),
            param(&Texture2D<T>::udelta, "udelta", 0.0f, Unit::None, "Shift along u (uv and planar mapping)."),
            param(&Texture2D<T>::vdelta, "vdelta", 0.0f, Unit::None, "Shift along v (uv and planar mapping)."),
            param(
                &Texture2D<T>::uvmatrix, "uvmatrix", Unit::None,
                "Six numbers m that take (u, v) to (m0 u + m1 v + m2, m3 u + m4 v + m5), before scale and shift; none "
                "leave it as it is (uv mapping)."),
            param(
                &Texture2D<T>::uvset, "uvset", 0, Unit::None,
                "Which of a mesh's sets of texture coordinates (u, v) are, 0 or 1; of shapes that have one it is that "
                "(uv mapping).",
                Range{0, 1}),
            param(&Texture2D<T>::v1, "v1", Vector{{1, 0, 0}}, Unit::None,
                  "World-space direction of s, one over the length of a repeat (planar mapping)."),
            param(&Texture2D<T>::v2, "v2", Vector{{0, 1, 0}}, Unit::None,
                  "World-space direction of t, one over the length of a repeat (planar mapping).")) {}
};

}  // namespace whit
