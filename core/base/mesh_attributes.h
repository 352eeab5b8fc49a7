// What the vertices of a mesh may have beside what surfaces need, for textures that ask for it.
#pragma once

namespace whit {

/// Read, kept and interpolated where a live texture asks for it and a mesh has it; for all else it is not there.
struct MeshAttributes {
  bool uvs1 = false;    ///< A second set of texture coordinates.
  bool colors = false;  ///< Colours and alpha.
  constexpr MeshAttributes& operator|=(const MeshAttributes& o) {
    uvs1 |= o.uvs1, colors |= o.colors;
    return *this;
  }
  constexpr bool operator==(const MeshAttributes&) const = default;
};

}  // namespace whit
