#include "core/watch/camera_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/image/replace_file.h"
#include "core/session/models.h"
#include "parser/lexer.h"
#include "parser/statements.h"
#include "parser/transforms.h"

namespace whit {
namespace {

/// A statement before Camera that changes where it stands. Matrices are applied to points from the last one to the first.
struct Step {
  std::string name;
  uint64_t begin = 0, end = 0;
  Mat4d matrix;
  std::array<double, 16> numbers{};
};

Vec3d three(const std::array<double, 16>& numbers, size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// The steps to the world's Camera statement, as far as they stand in its file.
std::vector<Step> steps_to(const Sources& sources, const SceneDescription& world) {
  const SourcePos camera = world.camera.where;
  Diagnostics ignored;
  Reporter reporter(ignored);
  Lexer lexer(sources.text(camera.file), camera.file, reporter);
  std::vector<Step> steps;
  Statement s;
  for (;;) {
    s = {};
    const ReadResult read = read_statement(lexer, s);
    if (read == ReadResult::End || s.where.offset >= camera.offset) return steps;
    if (read != ReadResult::Good) continue;
    const std::string_view name = s.row->name;
    if (name == "Identity" || name == "Transform" || name == "WorldBegin" || name == "WorldEnd") steps.clear();
    if (const std::optional<Mat4d> m = matrix_of_transform(name, s.numbers))
      steps.push_back({std::string(name), s.where.offset, s.end, *m, s.numbers});
  }
}

Mat4d product(const std::vector<Step>& steps, size_t first, size_t last) {
  Mat4d m;
  for (size_t i = first; i < last; ++i) m = steps[i].matrix * m;
  return m;
}

/// The largest difference of two matrices, by the largest number.
double difference(const Mat4d& a, const Mat4d& b) {
  double most = 0, size = 1e-300;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c)
      most = std::max(most, std::abs(a[r][c] - b[r][c])), size = std::max(size, std::abs(b[r][c]));
  }
  return most / size;
}

constexpr double kSame = 1e-9;  ///< Matrices that differ by roundings alone; numbers of a file have no fewer digits.

bool is_rigid(const Mat4d& m) {
  const std::array<Vec3d, 3> rows{Vec3d(m[0][0], m[0][1], m[0][2]), Vec3d(m[1][0], m[1][1], m[1][2]),
                                  Vec3d(m[2][0], m[2][1], m[2][2])};
  for (size_t i = 0; i < 3; ++i) {
    if (std::abs(rows[i].dot(rows[i]) - 1) > kSame || std::abs(rows[i].dot(rows[(i + 1) % 3])) > kSame) return false;
  }
  return !swaps_handedness(m);
}

/// A number with so many digits, without a sign where it is nothing beside `size`.
std::string number(double v, int digits, double size) {
  if (std::abs(v) < size * std::pow(10.0, -digits)) v = 0;
  return fmt::format("{:.{}g}", v, digits);
}

std::string numbers(const Vec3d& v, int digits, double size) {
  return fmt::format("{} {} {}", number(v.x, digits, size), number(v.y, digits, size), number(v.z, digits, size));
}

double size_of(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), 1e-300}); }

/// The numbers as they will be read.
Vec3d rounded(const Vec3d& v, int digits, double size) {
  return {std::stod(number(v.x, digits, size)), std::stod(number(v.y, digits, size)),
          std::stod(number(v.z, digits, size))};
}

/// LookAt for a rigid matrix, with as few digits as keep it to a millionth of a millionth.
std::string look_at_text(const Mat4d& m, double distance, const Vec3d& preferred_up) {
  const CameraPose pose = pose_of(m);
  for (Vec3d up : {preferred_up, pose.up}) {
    const Vec3d target = pose.eye + pose.direction * distance;
    for (int digits = 6; digits <= 17; ++digits) {
      const double size = std::max(size_of(pose.eye), size_of(target));
      const auto read =
          looking_at(rounded(pose.eye, digits, size), rounded(target, digits, size), rounded(up, digits, size_of(up)));
      if (!read || difference(*read, m) > 1e-9) continue;
      return fmt::format("LookAt {}  {}  {}", numbers(pose.eye, digits, size), numbers(target, digits, size),
                         numbers(up, digits, size_of(up)));
    }
  }
  return {};
}

std::string matrix_text(const char* name, const Mat4d& m) {
  std::string text = fmt::format("{} [", name);
  for (int i = 0; i < 16; ++i) text += fmt::format("{}{:.12g}", i > 0 ? " " : "", m[i / 4][i % 4]);
  return text + "]";
}

/// All of a camera's place, in one or two statements.
std::string whole_text(const Mat4d& m, const Vec3d& up) {
  if (is_rigid(m)) return look_at_text(m, 1, up);
  const Mat4d mirror = scaling(Vec3d(-1, 1, 1));
  if (is_rigid(m * mirror)) return "Scale -1 1 1\n" + look_at_text(m * mirror, 1, up);
  return matrix_text("Transform", m);
}

bool is_space(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; });
}

/// Nothing but space between the steps.
bool contiguous(const std::vector<Step>& steps, std::string_view text) {
  for (size_t i = 1; i < steps.size(); ++i) {
    if (!is_space(text.substr(steps[i - 1].end, steps[i].begin - steps[i - 1].end))) return false;
  }
  return true;
}

/// Why the statements of the camera's file are not what places it; "" when they are.
std::string not_understood(const SceneDescription& world, const std::vector<Step>& steps) {
  if (!world.camera.where.known()) return "the scene has no Camera statement";
  const TransformPair placed = world.transforms[static_cast<size_t>(world.camera_transform)];
  if (placed.animated()) return "the camera moves while the shutter is open";
  if (difference(product(steps, 0, steps.size()), placed.start) > kSame)
    return "what places the camera does not all stand in the file of the Camera statement";
  return {};
}

/// The one step of a name; the number of steps where there are none or several.
size_t only_step(const std::vector<Step>& steps, std::string_view name, std::string_view other = {}) {
  size_t found = steps.size(), n = 0;
  for (size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].name == name || (!other.empty() && steps[i].name == other)) found = i, ++n;
  }
  return n == 1 ? found : steps.size();
}

/// The text for one step that makes the product the matrix.
std::string step_text(const std::vector<Step>& steps, size_t at, const Mat4d& whole, const Vec3d& up) {
  const Mat4d before = product(steps, 0, at), after = product(steps, at + 1, steps.size());
  const Mat4d own = after.gjInverse() * whole * before.gjInverse();
  if (steps[at].name != "LookAt") return matrix_text(steps[at].name.c_str(), own);
  if (!is_rigid(own)) return {};
  const double distance = (three(steps[at].numbers, 3) - three(steps[at].numbers, 0)).length();
  // `up` is of the world, which is where LookAt is if nothing stands behind it.
  return look_at_text(own, distance, at + 1 == steps.size() ? up : pose_of(own).up);
}

CameraEdit refused(std::string why) {
  CameraEdit edit;
  edit.problem = std::move(why);
  return edit;
}

/// Unless a comment stands in what would be replaced, and would be lost. Statements of numbers have no other #.
CameraEdit with_its_comments(const Sources& sources, CameraEdit edit) {
  if (sources.text(edit.file).substr(edit.begin, edit.end - edit.begin).find('#') != std::string_view::npos)
    edit.problem = fmt::format("there is a comment inside of what places the camera (line {}): put this there yourself",
                               sources.place({edit.file, edit.begin}).line);
  return edit;
}

}  // namespace

CameraPose pose_of(const Mat4d& world_to_camera) {
  const Mat4d m = world_to_camera.gjInverse();
  CameraPose pose;
  pose.eye = transform_point(m, Vec3d(0));
  pose.direction = transform_vector(m, Vec3d(0, 0, 1)).normalized();
  pose.up = transform_vector(m, Vec3d(0, 1, 0)).normalized();
  return pose;
}

Mat4d placed_at(const Mat4d& world_to_camera, const CameraPose& pose) {
  const CameraPose own = pose_of(world_to_camera);
  const auto stood = looking_at(own.eye, own.eye + own.direction, own.up);
  auto stands = looking_at(pose.eye, pose.eye + pose.direction, pose.up);
  if (!stands) stands = looking_at(pose.eye, pose.eye + pose.direction, own.up);
  if (!stood || !stands) return world_to_camera;
  return *stands * stood->gjInverse() * world_to_camera;
}

CameraEdit camera_edit(const Sources& sources, const SceneDescription& world, const Mat4d& world_to_camera,
                       const Vec3d& up) {
  if (!world.camera.where.known()) return refused(not_understood(world, {}));
  if (is_model_text(sources.name(world.camera.where.file)))
    return refused("the camera is of a model: there is no statement to write it into");
  const std::vector<Step> steps = steps_to(sources, world);
  if (std::string why = not_understood(world, steps); !why.empty()) return refused(std::move(why));
  CameraEdit edit;
  edit.file = world.camera.where.file;
  const size_t look_at = only_step(steps, "LookAt"), matrix = only_step(steps, "Transform", "ConcatTransform");
  for (const size_t at : {look_at, matrix}) {
    if (at == steps.size()) continue;
    edit.text = step_text(steps, at, world_to_camera, up);
    edit.begin = steps[at].begin, edit.end = steps[at].end;
    if (!edit.text.empty()) return with_its_comments(sources, std::move(edit));
  }
  edit.text = whole_text(world_to_camera, up);
  if (steps.empty()) {
    edit.begin = edit.end = world.camera.where.offset;
    edit.text += "\n";
    return edit;
  }
  edit.begin = steps.front().begin, edit.end = steps.back().end;
  if (contiguous(steps, sources.text(edit.file))) return with_its_comments(sources, std::move(edit));
  edit.problem = fmt::format(
      "{} statements place the camera, with others or comments between them (from line {}): put this in their place "
      "yourself",
      steps.size(), sources.place({edit.file, edit.begin}).line);
  return edit;
}

Vec3d up_of_camera(const Sources& sources, const SceneDescription& world) {
  const Mat4d m = world.transforms[static_cast<size_t>(world.camera_transform)].start;
  if (!world.camera.where.known()) return pose_of(m).up;
  const std::vector<Step> steps = steps_to(sources, world);
  const size_t last = steps.size() - 1;
  if (steps.empty() || steps[last].name != "LookAt" || !not_understood(world, steps).empty()) return pose_of(m).up;
  return three(steps[last].numbers, 6).normalized();
}

std::string write_edit(const Sources& sources, const CameraEdit& edit) {
  if (!edit.problem.empty()) return edit.problem;
  const std::string& path = sources.name(edit.file);
  const std::string_view read = sources.text(edit.file);
  // The text of a large file is the file itself.
  if (!sources.problem(edit.file).empty() || !holds_text(path, read))
    return fmt::format("{} is not any more what was read", path);
  const std::string text = fmt::format("{}{}{}", read.substr(0, edit.begin), edit.text, read.substr(edit.end));
  const std::string problem = replace_file(path, text);
  return problem.empty() ? "" : fmt::format("{}: {}", path, problem);
}

}  // namespace whit
