// A closed mesh with nothing regular about it, and rays in random directions: what tests of leaks share.
#pragma once

#include <fmt/core.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "tests/plugins/shape_support.h"

namespace whit::test {

using shape_test::Numbers;

/// A sphere of radius 1 around `centre`, each vertex moved by up to 10 % along its radius: rows x 2 rows cells of two
/// triangles, and fans of 2 rows triangles at the poles. Seen from the middle it covers every direction once.
class NoisySphere {
 public:
  explicit NoisySphere(int rows, const Vec3d& centre = {0, 0, 0}, double radius = 1) : columns_(2 * rows) {
    Numbers u(11);
    const auto add = [&](double theta, double phi) {
      const Vec3d d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      positions.push_back(centre + d * (radius * u.between(0.9, 1.1)));
    };
    add(0, 0);
    for (int r = 1; r < rows; ++r) {
      for (int c = 0; c < columns_; ++c) add(M_PI * r / rows, 2 * M_PI * c / columns_);
    }
    add(M_PI, 0);
    const auto last = static_cast<uint32_t>(positions.size() - 1);
    for (int c = 0; c < columns_; ++c) {
      triangle(0, at(1, c), at(1, c + 1));
      triangle(last, at(rows - 1, c + 1), at(rows - 1, c));
      for (int r = 1; r < rows - 1; ++r) {
        triangle(at(r, c), at(r + 1, c), at(r + 1, c + 1));
        triangle(at(r, c), at(r + 1, c + 1), at(r, c + 1));
      }
    }
  }

  std::string text() const {
    std::string out = "Shape \"trianglemesh\" \"integer indices\" [";
    for (const uint32_t i : indices) out += fmt::format("{} ", i);
    out += "] \"point P\" [";
    for (const Vec3d& p : positions) out += fmt::format("{:.17g} {:.17g} {:.17g} ", p.x, p.y, p.z);
    return out + "]\n";
  }

  std::vector<Vec3d> positions;
  std::vector<uint32_t> indices;

 private:
  uint32_t at(int r, int c) const { return static_cast<uint32_t>(1 + (r - 1) * columns_ + c % columns_); }
  void triangle(uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); }

  int columns_;
};

}  // namespace whit::test
