// The camera of a scene as its file has it: where it stands, and the statement that says so, to be written anew.
#pragma once

#include <string>

#include "core/base/vec.h"
#include "parser/scene_description.h"
#include "parser/source.h"

namespace whit {

/// Where a camera stands and how it looks, in world space.
struct CameraPose {
  Vec3d eye{0, 0, 0}, direction{0, 0, 1}, up{0, 1, 0};  ///< The direction is a unit vector.
};

/// Of a matrix from world to camera space.
CameraPose pose_of(const Mat4d& world_to_camera);

/// The matrix of the same camera in another pose: what it scales and mirrors stays. Of a pose whose `up` is parallel to its
/// direction the camera's own.
Mat4d placed_at(const Mat4d& world_to_camera, const CameraPose& pose);

/// A piece of a file, and what is to stand there instead.
struct CameraEdit {
  uint32_t file = 0;
  uint64_t begin = 0, end = 0;  ///< Bytes of the file.
  std::string text;
  std::string problem;  ///< Why it cannot be written, for people. The text may be there all the same.
};

/// What makes the world's camera that of the matrix. It is the LookAt or the matrix that places it; or the only run of
/// transforms that does. `up` is what it preferably calls up.
CameraEdit camera_edit(const Sources& sources, const SceneDescription& world, const Mat4d& world_to_camera,
                       const Vec3d& up);

/// The up vector of the LookAt statement that places the camera by itself; that of the matrix where there is none.
Vec3d up_of_camera(const Sources& sources, const SceneDescription& world);

/// Writes it into the file, as replace_file() does, unless that is not any more what was read.
/// "" or why it is not written.
std::string write_edit(const Sources& sources, const CameraEdit& edit);

}  // namespace whit
