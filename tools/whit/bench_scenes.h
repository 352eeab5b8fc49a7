// The scenes of `whit bench`, made by code: text in pbrt's own format, so that they exercise the whole program.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace whit {

struct BenchScene {
  std::string name;
  std::string summary;
  /// The scene's text. Files that it needs are written into the folder, which must exist and be there while the scene
  /// is in use. Throws std::runtime_error when that fails.
  std::function<std::string(const std::string& folder)> text;
};

/// The built-in scenes; each has at least a million camera samples.
std::vector<BenchScene> bench_scenes();

}  // namespace whit
