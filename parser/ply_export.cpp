#include "parser/ply_export.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "core/base/ply_write.h"

namespace whit {

namespace {

/// pbrt's limit: shorter meshes are easier to read where they are.
constexpr size_t kInlineIndices = 500;

/// The parameters of a mesh that a PLY file can hold; null where there is none.
struct MeshData {
  const Parameter* indices = nullptr;
  const Parameter* positions = nullptr;
  const Parameter* normals = nullptr;
  const Parameter* uv = nullptr;
  bool inexpressible = false;  ///< Something is there that would be lost.
};

bool is_uv(const Parameter& p) {
  return (p.name == "uv" || p.name == "st") && (p.type == ParamType::Point2 || p.type == ParamType::Float);
}

MeshData mesh_data(const Statement& statement) {
  MeshData mesh;
  for (const Parameter& p : statement.parameters) {
    if (p.name == "indices" && p.type == ParamType::Integer) mesh.indices = &p;
    if (p.name == "P" && p.type == ParamType::Point3) mesh.positions = &p;
    if (p.name == "N" && p.type == ParamType::Normal3) mesh.normals = &p;
    if (p.name == "S" || p.name == "faceIndices") mesh.inexpressible = true;
    if (!is_uv(p)) continue;
    if (mesh.uv) mesh.inexpressible = true;
    mesh.uv = &p;
  }
  return mesh;
}

bool is_consistent(const MeshData& mesh) {
  const size_t vertices = mesh.positions->numbers().size() / 3;
  if (mesh.indices->integers().size() % 3 != 0) return false;
  if (mesh.normals && mesh.normals->numbers().size() != 3 * vertices) return false;
  if (mesh.uv && mesh.uv->numbers().size() != 2 * vertices) return false;
  const auto in_range = [vertices](int32_t i) { return i >= 0 && static_cast<size_t>(i) < vertices; };
  return std::all_of(mesh.indices->integers().begin(), mesh.indices->integers().end(), in_range);
}

/// True when rounding the positions to float would show: at more than a millionth of the mesh's size.
bool needs_double(const std::vector<double>& positions) {
  double extent = 0, error = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    double low = positions[axis], high = low;
    for (size_t i = axis; i < positions.size(); i += 3) {
      low = std::min(low, positions[i]);
      high = std::max(high, positions[i]);
      error = std::max(error, std::abs(static_cast<double>(static_cast<float>(positions[i])) - positions[i]));
    }
    extent = std::max(extent, high - low);
  }
  return !(error <= 1e-6 * extent);
}

/// Rounded; none of a parameter that is not there.
std::vector<float> to_floats(const Parameter* p) {
  if (!p) return {};
  return {p->numbers().begin(), p->numbers().end()};
}

/// Whether a file holds exactly `data`.
bool holds(const std::string& path, const std::string& data) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed) || std::filesystem::file_size(path, failed) != data.size())
    return false;
  std::ifstream file(path, std::ios::binary);
  std::string there(data.size(), '\0');
  return file.read(there.data(), static_cast<std::streamsize>(there.size())) && there == data;
}

}  // namespace

bool can_export_mesh(const Statement& statement) {
  if (statement.row != find_statement("Shape") || statement.names[0] != "trianglemesh") return false;
  const MeshData mesh = mesh_data(statement);
  if (!mesh.indices || !mesh.positions || mesh.inexpressible) return false;
  return mesh.indices->integers().size() > kInlineIndices && is_consistent(mesh);
}

std::string mesh_as_ply(const Statement& statement) {
  const MeshData mesh = mesh_data(statement);
  const std::vector<double>& positions = mesh.positions->numbers();
  const std::vector<int32_t>& indices = mesh.indices->integers();
  const std::vector<float> normals = to_floats(mesh.normals), uvs = to_floats(mesh.uv);
  const std::array<PlyColumns, 2> columns{{{"nx ny nz", 3, normals}, {"u v", 2, uvs}}};
  return write_ply(positions, needs_double(positions), columns, std::vector<uint32_t>(indices.begin(), indices.end()));
}

NewFile write_new_file(const std::string& path, const std::string& data, std::string& problem) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == EEXIST) return holds(path, data) ? NewFile::HasTheSame : NewFile::NameTaken;
  bool good = descriptor >= 0;
  for (size_t done = 0; good && done < data.size();) {
    const ssize_t wrote = ::write(descriptor, data.data() + done, data.size() - done);
    if (wrote > 0) done += static_cast<size_t>(wrote);
    good = wrote > 0 || errno == EINTR;
  }
  if (!good) problem = std::strerror(errno);
  if (descriptor < 0) return NewFile::Failed;
  if (::close(descriptor) != 0 && good) {
    problem = std::strerror(errno);
    good = false;
  }
  if (!good) ::unlink(path.c_str());
  return good ? NewFile::Written : NewFile::Failed;
}

void replace_by_plymesh(Statement& statement, const std::string& filename) {
  const MeshData mesh = mesh_data(statement);
  ParameterList kept(1);
  kept[0].type = ParamType::String;
  kept[0].name = "filename";
  kept[0].values = std::vector<std::string>{filename};
  for (Parameter& p : statement.parameters)
    if (&p != mesh.indices && &p != mesh.positions && &p != mesh.normals && &p != mesh.uv) kept.push_back(std::move(p));
  statement.names[0] = "plymesh";
  statement.parameters = std::move(kept);
}

}  // namespace whit
