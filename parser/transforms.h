// The matrices of the transform statements, in double precision and the row-vector convention of core/base/vec.h.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/base/vec.h"

namespace whit {

/// Points moved by `by`.
Mat4d translation(const Vec3d& by);

/// Points scaled about the origin, axis by axis.
Mat4d scaling(const Vec3d& by);

/// Rotation by `degrees` about `axis` (any length but zero), counterclockwise seen against the axis in a
/// right-handed frame. Multiples of 90 degrees about a coordinate axis are exact.
Mat4d rotation(double degrees, const Vec3d& axis);

/// World to camera space: the eye at the origin, `target` on +z, `up` in the upper half of the y-z plane. A rotation
/// and a translation, no mirroring: since +x is shown on the right, a world thought of as right-handed appears
/// mirrored, as pbrt has it. Nothing when the points coincide or `up` is parallel to the view.
std::optional<Mat4d> looking_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up);

/// Sixteen numbers of a file, which are the rows of a matrix in this convention.
Mat4d matrix_of_numbers(const std::array<double, 16>& numbers);

/// What Translate, Scale, Rotate, LookAt and ConcatTransform put before the matrix in force, and what Transform puts in its
/// place, by the numbers behind them. Nothing for other directives, and where the numbers make none.
std::optional<Mat4d> matrix_of_transform(std::string_view directive, const std::array<double, 16>& numbers);

/// True when the matrix and its inverse are finite. The scale of rows and columns does not matter: a matrix that
/// makes things very small or very flat along its axes is regular.
bool is_regular(const Mat4d& m);

}  // namespace whit
