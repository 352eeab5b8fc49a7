// Inline triangle meshes to PLY files, for pbrt's --toply.
#pragma once

#include <string>

#include "parser/statements.h"

namespace whit {

/// True for a Shape "trianglemesh" with more than 500 indices, all of whose data a PLY file can hold and whose
/// counts and indices are right. Others stay inline, where their mistakes can be reported.
bool can_export_mesh(const Statement& statement);

/// Writes the mesh of such a statement as a binary PLY file: positions as float (as double where rounding to float
/// would move a vertex by more than a millionth of the mesh), normals and uv as float. False, with the reason in
/// `problem`, when the file cannot be written.
bool write_mesh(const Statement& statement, const std::string& path, std::string& problem);

/// Turns such a statement into a Shape "plymesh" that reads `filename`.
void replace_by_plymesh(Statement& statement, const std::string& filename);

}  // namespace whit
