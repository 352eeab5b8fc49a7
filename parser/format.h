// Writes a scene file back in normal form: `whit fmt`, pbrt's --cat and --toply.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "core/base/diagnostics.h"
#include "parser/source.h"

namespace whit {

struct FormatOptions {
  std::string indent = "  ";     ///< For each open AttributeBegin, TransformBegin and ObjectBegin.
  bool expand_includes = false;  ///< Put the statements of included files in place of the Include, as --cat does.
  bool to_ply = false;           ///< Write large inline triangle meshes to PLY files, as --toply does.
  std::string ply_folder;        ///< Where those go, under names from mesh_00001.ply on that are free; "" is here.
  std::vector<std::string>* written = nullptr;  ///< Takes the paths of the PLY files, if given.
};

/// Writes the statements of a file to `out`: one a line, indented by FormatOptions::indent, shortest numbers that read back the same. Comments and single blank lines stay;
/// a comment within a statement moves in front of it. A statement with a mistake is reported and copied as it is.
/// Formatting the result again changes nothing. The grammar is checked here, the meaning is not.
Diagnostics format_file(Sources& sources, const std::string& path, std::ostream& out,
                        const FormatOptions& options = {});

/// The same for text that is no file; includes are relative to `folder`.
Diagnostics format_text(Sources& sources, std::string name, std::string text, std::string folder, std::ostream& out,
                        const FormatOptions& options = {});

}  // namespace whit
