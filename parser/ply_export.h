// Inline triangle meshes to PLY files, for pbrt's --toply.
#pragma once

#include <cstdint>
#include <string>

#include "parser/statements.h"

namespace whit {

/// True for a Shape "trianglemesh" with more than 500 indices, all of whose data a PLY file can hold and whose
/// counts and indices are right. Others stay inline, where their mistakes can be reported.
bool can_export_mesh(const Statement& statement);

/// The mesh of such a statement as a binary PLY file: positions as float (as double where rounding to float would move a
/// vertex by more than a millionth of the mesh), normals and uv as float.
std::string mesh_as_ply(const Statement& statement);

enum class NewFile : uint8_t {
  Written,
  HasTheSame,  ///< There is a file of that name already, and it holds these very bytes.
  NameTaken,   ///< There is something else of that name already; it is left alone.
  Failed,      ///< It could not be written, and nothing is left of it.
};

/// Writes a file that is not there yet. Nobody else can take its name meanwhile.
NewFile write_new_file(const std::string& path, const std::string& data, std::string& problem);

/// Turns such a statement into a Shape "plymesh" that reads `filename`.
void replace_by_plymesh(Statement& statement, const std::string& filename);

}  // namespace whit
