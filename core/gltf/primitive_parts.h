// The steps from a primitive to a mesh.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/gltf/buffers.h"
#include "core/gltf/model.h"
#include "core/gltf/primitive.h"

namespace whit::gltf {

/// A mesh of KHR_draco_mesh_compression, decoded.
class DracoMesh {
 public:
  DracoMesh();
  ~DracoMesh();
  /// Returns "", or what is wrong with the bytes. Nothing is decoded that has more triangles than the accessor of the
  /// indices has room for.
  std::string decode(std::span<const uint8_t> bytes, uint64_t most_indices);
  std::vector<uint32_t> indices() const;
  /// The numbers of an attribute, as its accessor describes them.
  std::string read(int attribute, const Accessor& as, std::vector<float>& out) const;

 private:
  struct Decoded;
  std::unique_ptr<Decoded> decoded_;
};

/// Decodes the accessors of one primitive, wherever their numbers are. What is wrong is returned with its place.
class PrimitiveSource {
 public:
  PrimitiveSource(const Model& model, const Primitive& primitive) : model_(model), primitive_(primitive) {}
  /// Decodes what the primitive has compressed; before all else.
  std::string open();
  /// Numbers may be NaN or infinite.
  std::string positions(std::vector<double>& out) const;
  /// The corners of triangles, three each, all below the number of vertices.
  std::string triangles(size_t vertices, std::vector<uint32_t>& out) const;
  /// Finite numbers of `vertices` elements; none where there is no accessor.
  std::string floats(int accessor, size_t vertices, std::vector<float>& out) const;
  std::string integers(int accessor, size_t vertices, std::vector<uint32_t>& out) const;
  std::string at(const std::string& what) const { return model_.at(primitive_.place) + what; }

 private:
  int draco_attribute(int accessor) const;
  std::string check_count(int accessor, size_t found, size_t vertices) const;
  const Model& model_;
  const Primitive& primitive_;
  std::unique_ptr<DracoMesh> draco_;
};

/// What is posed of a mesh. Tangents have four numbers, the last one being the sign of the bitangent.
struct PosedArrays {
  std::vector<double> positions;
  std::vector<float> normals, tangents;
};
std::string pose_arrays(const PrimitiveSource& source, const Primitive& primitive, const Pose& pose,
                        PosedArrays& arrays);

/// The vertices of the mesh become those of `from`, which may name one many times.
void pick_vertices(MeshData& mesh, const std::vector<uint32_t>& from);

/// Tangents by the rules of MikkTSpace (Mikkelsen 2008), with texture coordinates whose v points up. Vertices at which
/// they differ are split. The mesh has normals, and no triangle without area.
void add_tangents(MeshData& mesh, const std::vector<float>& uvs);

}  // namespace whit::gltf
