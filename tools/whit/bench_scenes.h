// The scenes of `whit bench`, made by code: text in pbrt's own format, so that they exercise the whole program.
#pragma once

#include <string>
#include <vector>

namespace whit {

struct BenchScene {
  std::string name;
  std::string summary;
  std::string text;
};

/// The built-in scenes. `mesh`: a bumpy plastic ball of 100,000 triangles on a matte floor under one spherical
/// area light, one light sample per point.
std::vector<BenchScene> bench_scenes();

}  // namespace whit
