// A glTF 2.0 model as plain data: what the file says, with all references checked, in the file's own words. Geometry and
// pictures stay encoded, in mapped files, until somebody asks for them (core/gltf/accessor.h, core/gltf/primitive.h).
//
// Source: the glTF 2.0 specification and the KHR and EXT extensions named below. Every index is -1 ("none") or valid. The
// graph of nodes has no cycle, no node has two parents, and it is at most kMostDepth deep. Numbers are finite. Units are
// the file's: metres, radians, seconds; vectors are right-handed, +Y up.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/attachment.h"
#include "core/base/diagnostics.h"
#include "core/base/vec.h"

namespace whit::gltf {

inline constexpr int kMostDepth = 1000;

/// A texture as a material uses it, with KHR_texture_transform.
struct TextureUse {
  int texture = -1;
  int uv_set = 0;  ///< TEXCOORD_n: 0 or 1.
  Vec2d offset{0, 0}, scale{1, 1};
  double rotation = 0;  ///< Counter-clockwise, as the extension defines it: v points down.
  explicit operator bool() const { return texture >= 0; }
};

struct Material {
  std::string name;
  std::array<double, 4> base_color{1, 1, 1, 1};  ///< Linear.
  TextureUse base_color_texture;                 ///< sRGB, and alpha.
  double metallic = 1, roughness = 1;
  TextureUse metallic_roughness_texture;  ///< Blue is metallic, green is roughness.
  TextureUse normal_texture;
  double normal_scale = 1;
  TextureUse occlusion_texture;  ///< Only to say that it is ignored.
  Vec3d emissive{0, 0, 0};       ///< Times KHR_materials_emissive_strength.
  TextureUse emissive_texture;   ///< sRGB.
  enum class Alpha { Opaque, Mask, Blend } alpha = Alpha::Opaque;
  double alpha_cutoff = 0.5;
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit

  double ior = 1.5;         ///< KHR_materials_ior; 0 means that everything is reflected.
  double transmission = 0;  ///< KHR_materials_transmission
  TextureUse transmission_texture;
  double thickness = 0;                        ///< KHR_materials_volume: above 0 a solid, at 0 a thin sheet.
  bool has_volume = false;                     ///< The extension is there.
  std::optional<double> attenuation_distance;  ///< Only to say that absorption is ignored.
  double specular = 1;                         ///< KHR_materials_specular
  TextureUse specular_texture;                 ///< Alpha.
  Vec3d specular_color{1, 1, 1};
  TextureUse specular_color_texture;  ///< sRGB.
  double clearcoat = 0;               ///< KHR_materials_clearcoat
  TextureUse clearcoat_texture;       ///< Red.
  double clearcoat_roughness = 0;
  TextureUse clearcoat_roughness_texture;  ///< Green.
  TextureUse clearcoat_normal_texture;     ///< Only to say that it is ignored.
  Vec3d sheen_color{0, 0, 0};              ///< KHR_materials_sheen
  TextureUse sheen_color_texture;          ///< sRGB.
  double sheen_roughness = 0;
  TextureUse sheen_roughness_texture;  ///< Alpha.
  double anisotropy = 0;               ///< KHR_materials_anisotropy: strength
  double anisotropy_rotation = 0;      ///< Counter-clockwise from the tangent.
  TextureUse anisotropy_texture;       ///< Red and green are a direction, blue is the strength.
};

struct Sampler {
  enum class Wrap { Repeat, Clamp, Mirror } wrap_s = Wrap::Repeat, wrap_t = Wrap::Repeat;
  bool nearest = false;  ///< magFilter NEAREST.
};

struct Texture {
  int image = -1;  ///< Of EXT_texture_webp where the texture has them, else "source".
  Sampler sampler;
};

/// An encoded picture: a file beside the model, or bytes inside of it.
struct Image {
  std::string name;
  std::string file;                            ///< Absolute, or "".
  std::shared_ptr<const PictureBytes> inside;  ///< Or null.
  std::string extension;  ///< "png", "jpg", "webp", "ktx2" or "": what the file or the mime type says.
};

/// Indices of accessors, each checked to be of a type and component type that its semantic may have, and of the
/// primitive's number of vertices.
struct Attributes {
  int position = -1, normal = -1, tangent = -1;
  std::array<int, 2> uv{-1, -1};
  int color = -1;                    ///< COLOR_0
  std::vector<int> joints, weights;  ///< JOINTS_n and WEIGHTS_n, as many of each.
};

struct MorphTarget {
  int position = -1, normal = -1, tangent = -1;
};

/// KHR_draco_mesh_compression: attributes and indices are in these bytes, and their accessors say only what they are.
struct DracoPrimitive {
  int view = -1;                                ///< A buffer view.
  std::vector<std::pair<int, int>> attributes;  ///< Accessors, and the numbers of their attributes in the bytes.
};

struct Primitive {
  enum class Mode { Triangles, Strip, Fan, Points, Lines } mode = Mode::Triangles;
  Attributes attributes;
  int indices = -1;
  int material = -1;
  std::vector<MorphTarget> targets;
  std::vector<int>
      variant_material;  ///< Of each of Model::variants: the material, -1 where `material` stays. Or empty.
  std::optional<DracoPrimitive> draco;
  std::string place;  ///< "/meshes/3/primitives/0"
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<double> weights;  ///< As many as each primitive has targets.
};

/// EXT_mesh_gpu_instancing: accessors of as many elements, -1 where there is none.
struct GpuInstances {
  int translation = -1, rotation = -1, scale = -1;
};

struct Node {
  std::string name;
  std::vector<int> children;
  int parent = -1;
  int mesh = -1, camera = -1, skin = -1, light = -1;
  std::optional<Mat4d> matrix;  ///< In whit's convention (row vectors); then the next three say nothing.
  Vec3d translation{0, 0, 0}, scale{1, 1, 1};
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< A unit quaternion: x y z w.
  std::vector<double> weights;                 ///< Instead of the mesh's; or empty.
  GpuInstances instances;
};

struct Skin {
  std::vector<int> joints;
  int inverse_bind_matrices = -1;  ///< An accessor of a matrix for each joint.
};

struct AnimationChannel {
  int node = -1;
  enum class Path { Translation, Rotation, Scale, Weights } path = Path::Translation;
  enum class Interpolation { Linear, Step, CubicSpline } interpolation = Interpolation::Linear;
  int input = -1, output = -1;  ///< Accessors.
};

struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
};

struct Camera {
  std::string name;
  bool perspective = true;
  double yfov = 0;            ///< Radians, of the whole height.
  double aspect = 0;          ///< Width over height; 0 when the file does not say.
  double xmag = 0, ymag = 0;  ///< Orthographic: half the width and height.
};

/// KHR_lights_punctual
struct Light {
  std::string name;
  enum class Type { Directional, Point, Spot } type = Type::Point;
  Vec3d color{1, 1, 1};
  double intensity = 1;                   ///< Candela; lux when directional.
  double inner_cone = 0, outer_cone = 0;  ///< Radians from the axis, which is the node's -Z.
  bool has_range = false;                 ///< Only to say that it is ignored.
};

struct Scene {
  std::string name;
  std::vector<int> nodes;  ///< Roots.
};

/// The bytes behind the model: mapped files and decoded text; core/gltf/buffers.h.
class Buffers;

struct Model {
  std::string path;    ///< As it was given, for messages.
  std::string folder;  ///< Absolute.
  int default_scene = -1;
  std::vector<Scene> scenes;
  std::vector<Node> nodes;
  std::vector<Mesh> meshes;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Image> images;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<std::string> variants;  ///< Names, of KHR_materials_variants.
  std::shared_ptr<const Buffers> buffers;
  std::vector<std::string> files;  ///< That are read beside its own, but for pictures.

  /// "model.glb: /meshes/3"
  std::string at(std::string_view place) const;
};

struct LoadOptions {
  bool allow_outside = false;  ///< Files outside of the model's folder may be read.
};

/// Reads a .gltf or .glb file (its first bytes decide) and checks all of it that does not take decoding. All that is wrong
/// with it goes to `diagnostics` as errors, each with the file and the JSON path, at `where`; so do warnings of what is
/// not read (extensions, once for each file). Null when there is an error. `path` is opened, `shown` names it in messages.
std::shared_ptr<const Model> load_model(const std::string& path, const std::string& shown, const LoadOptions& options,
                                        SourcePos where, Diagnostics& diagnostics);

}  // namespace whit::gltf
