#include "core/gltf/describe_camera.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/box.h"
#include "core/base/fastmath.h"
#include "core/gltf/select.h"
#include "core/gltf/statement_text.h"

namespace whit::gltf {
namespace {

constexpr double kLongerSide = 1280, kUsualAspect = 16.0 / 9;
constexpr double kDegrees = 180 / detail::kPiD;

/// Film, sampler and integrator. Models are made to be seen in light from all around: paths.
std::string options(double aspect) {
  const double width = aspect >= 1 ? kLongerSide : std::max(std::round(kLongerSide * aspect), 1.0);
  const double height = aspect >= 1 ? std::max(std::round(kLongerSide / aspect), 1.0) : kLongerSide;
  return fmt::format(
      "Film \"image\" \"integer xresolution\" {} \"integer yresolution\" {}\n"
      "Sampler \"sobol\" \"integer pixelsamples\" 16\n"
      "Integrator \"path\" \"integer maxdepth\" 8\n",
      width, height);
}

/// A camera looks along -z of its node, pbrt's along +z of a space of the other hand.
std::string camera_statements(const Camera& camera, const Mat4d& to_root) {
  const double aspect = camera.aspect > 0    ? camera.aspect
                        : camera.perspective ? kUsualAspect
                                             : camera.xmag / camera.ymag;
  Mat4d turn;
  turn[2][2] = -1;
  std::string out = options(aspect) + matrix_statement("Transform", (turn * to_root).gjInverse());
  if (!camera.perspective) {
    return out + fmt::format("Camera \"orthographic\" \"float screenwindow\" [ {} {} {} {} ]\n", -camera.xmag,
                             camera.xmag, -camera.ymag, camera.ymag);
  }
  // The window's height is twice the tangent of half of fov, whatever side is the shorter.
  return out + fmt::format("Camera \"perspective\" \"float fov\" {} \"float screenwindow\" [ {} {} -1 1 ]\n",
                           camera.yfov * kDegrees, -aspect, aspect);
}

/// A box around the vertices that a primitive's triangles have. "" or what is wrong, with the file.
std::string find_bounds(const Model& model, const Primitive& primitive, const Pose& pose, Box3d& box) {
  MeshData mesh;
  if (std::string error = read_primitive(model, primitive, pose, {}, mesh); !error.empty()) return error;
  for (const uint32_t i : mesh.indices) {
    const double* const p = &mesh.positions[3 * size_t{i}];
    box.extendBy(Vec3d(p[0], p[1], p[2]));
  }
  return {};
}

/// The same of all that is drawn. Meshes that nothing bends are looked at once, wherever they are placed.
std::string find_bounds(const Model& model, const ShownNodes& shown, Box3d& box) {
  std::vector<DrawnMesh> drawn;
  size_t unplaceable = 0;
  if (std::string error = drawn_meshes(model, shown, drawn, unplaceable); !error.empty()) return model.at(error);
  std::map<int, Box3d> unbent;
  for (const DrawnMesh& mesh : drawn) {
    const bool bent = is_bent(mesh.pose);
    const bool known = !bent && unbent.count(mesh.mesh) > 0;
    Box3d local = known ? unbent[mesh.mesh] : Box3d();
    if (!known) {
      for (const Primitive& primitive : model.meshes[static_cast<size_t>(mesh.mesh)].primitives) {
        if (std::string error = find_bounds(model, primitive, mesh.pose, local); !error.empty()) return error;
      }
    }
    if (!bent) unbent[mesh.mesh] = local;
    for (const Mat4d& to_root : mesh.to_root) {
      const Box3d there = transform_box(to_root, local);
      if (!there.isEmpty()) box.extendBy(there);
    }
  }
  return {};
}

/// A camera from the front (+z), the right and above, so far away that the whole box is in the picture.
std::string framing_camera(const Box3d& box, std::vector<std::string>& notes) {
  constexpr double kFov = 40, kMargin = 1.08;
  const double slope = std::tan(kFov / kDegrees / 2);
  const Vec3d back = Vec3d(0.9, 0.6, 1.4).normalized(), right = Vec3d(0, 1, 0).cross(back).normalized(),
              up = back.cross(right);
  const Vec3d middle = box.isEmpty() ? Vec3d(0, 0, 0) : box.center();
  double distance = 0;
  if (!box.isEmpty()) {
    for (const Vec3d& corner : corners_of(box)) {
      const Vec3d c = corner - middle;
      distance = std::max({distance, c.dot(back) + kMargin * std::abs(c.dot(up)) / slope,
                           c.dot(back) + kMargin * std::abs(c.dot(right)) / (slope * kUsualAspect)});
    }
  }
  if (!(distance > 0)) distance = 1;
  const Vec3d eye = middle + back * distance;
  notes.push_back(
      fmt::format("there is no camera in the file: this one looks from {:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g}",
                  eye.x, eye.y, eye.z, middle.x, middle.y, middle.z));
  // Mirrored: pbrt shows a right-handed world as in a mirror.
  return options(kUsualAspect) +
         fmt::format("Scale -1 1 1\nLookAt {} {} {}  {} {} {}  0 1 0\n", eye.x, eye.y, eye.z, middle.x, middle.y,
                     middle.z) +
         fmt::format("Camera \"perspective\" \"float fov\" {}\n", kFov);
}

/// The first of the nodes whose camera is the one that is wanted, or any; -1 where there is none.
int find_camera(const Model& model, const std::string& name, const ShownNodes& shown) {
  const int wanted = name.empty() ? -1 : camera_index(model, name);
  const auto shows = [&](int n) {
    const Node& node = model.nodes[static_cast<size_t>(n)];
    // A camera may have the name of its node.
    const bool meant = name.empty() || node.camera == wanted || (wanted < 0 && node.name == name);
    return node.camera >= 0 && meant && is_placeable(shown.posed.to_root[static_cast<size_t>(n)]);
  };
  const auto found = std::find_if(shown.nodes.begin(), shown.nodes.end(), shows);
  return found == shown.nodes.end() ? -1 : *found;
}

/// What cameras there are, by name or else number.
std::string cameras_there(const Model& model, const ShownNodes& shown) {
  std::string there;
  for (const int n : shown.nodes) {
    const int camera = model.nodes[static_cast<size_t>(n)].camera;
    if (camera < 0) continue;
    const std::string& name = model.cameras[static_cast<size_t>(camera)].name;
    there +=
        fmt::format("{}{}", there.empty() ? "" : ", ", name.empty() ? fmt::format("{}", camera) : '"' + name + '"');
  }
  return there.empty() ? "without --camera one is made that shows all of it" : "there are " + there;
}

}  // namespace

bool describe_view(const Model& model, const Selection& selection, const ShownNodes& shown, std::string& text,
                   std::vector<std::string>& notes, Diagnostics& diagnostics) {
  const int node = find_camera(model, selection.camera, shown);
  if (node >= 0) {
    const Node& of = model.nodes[static_cast<size_t>(node)];
    text = camera_statements(model.cameras[static_cast<size_t>(of.camera)],
                             shown.posed.to_root[static_cast<size_t>(node)]);
    return true;
  }
  if (!selection.camera.empty()) {
    diagnostics.add({Severity::Error,
                     ErrorClass::Usage,
                     {},
                     fmt::format("{} has no camera \"{}\" in the scene", model.path, selection.camera),
                     cameras_there(model, shown)});
    return false;
  }
  Box3d box;
  const std::string error = find_bounds(model, shown, box);
  if (error.empty()) text = framing_camera(box, notes);
  else diagnostics.error({}, error);
  return error.empty();
}

std::string light_statements(const Model& model, int index, const Mat4d& to_root, std::set<std::string>& notes) {
  const int number = model.nodes[static_cast<size_t>(index)].light;
  if (number < 0) return {};
  const Light& light = model.lights[static_cast<size_t>(number)];
  if (light.has_range) notes.insert("the range of lights is not used: their light falls off and does not end");
  const Vec3d power = light.color * light.intensity;
  // They shine along -z of their node.
  std::string statement;
  switch (light.type) {
    case Light::Type::Point: statement = "LightSource \"point\"" + vector_param("rgb I", power); break;
    case Light::Type::Directional:
      statement = "LightSource \"distant\"" + vector_param("rgb L", power) + " \"point to\" [ 0 0 -1 ]";
      break;
    case Light::Type::Spot:
      statement = "LightSource \"spot\"" + vector_param("rgb I", power) + " \"point to\" [ 0 0 -1 ]" +
                  number_param("float coneangle", light.outer_cone * kDegrees) +
                  number_param("float conedeltaangle", (light.outer_cone - light.inner_cone) * kDegrees) +
                  " \"float falloff\" 2";
      break;
  }
  const std::string name = light.name.empty() ? "" : comment(light.name);
  return name + "AttributeBegin\n" + (to_root == Mat4d() ? "" : matrix_statement("ConcatTransform", to_root)) +
         statement + "\nAttributeEnd\n";
}

}  // namespace whit::gltf
