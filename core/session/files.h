// Which files a scene is made of.
#pragma once

#include <string>
#include <vector>

#include "core/session/session.h"

namespace whit {

/// The scene's own text and what it includes: those that are files, in the order of reading.
std::vector<std::string> texts_of(const ParsedFile& file);

/// The files that its statements name (pictures, meshes, models with their parts, spectra, lenses), live or not, there or
/// not; sorted, each once.
std::vector<std::string> assets_of(const ParsedFile& file);

/// "scene.pbrt:12:3" for a statement, by the folder of the scene at `path`: names of things in a picture are the same
/// wherever it was rendered from.
std::string place_in_scene(const Sources& sources, SourcePos where, const std::string& path);

}  // namespace whit
