// EXT_meshopt_compression, version 0 of the codecs, through meshoptimizer.
#include <meshoptimizer.h>

#include "core/gltf/buffers.h"

namespace whit::gltf {

std::string decompress(const Compression& c, std::span<const uint8_t> bytes, std::vector<uint8_t>& out) {
  out.resize(c.count * c.stride);
  int failed = 0;
  switch (c.mode) {
    case Compression::Mode::Attributes:
      failed = meshopt_decodeVertexBuffer(out.data(), c.count, c.stride, bytes.data(), bytes.size());
      break;
    case Compression::Mode::Triangles:
      failed = meshopt_decodeIndexBuffer(out.data(), c.count, c.stride, bytes.data(), bytes.size());
      break;
    case Compression::Mode::Indices:
      failed = meshopt_decodeIndexSequence(out.data(), c.count, c.stride, bytes.data(), bytes.size());
      break;
  }
  if (failed != 0) return "its bytes cannot be decoded";
  switch (c.filter) {
    case Compression::Filter::None: break;
    case Compression::Filter::Octahedral: meshopt_decodeFilterOct(out.data(), c.count, c.stride); break;
    case Compression::Filter::Quaternion: meshopt_decodeFilterQuat(out.data(), c.count, c.stride); break;
    case Compression::Filter::Exponential: meshopt_decodeFilterExp(out.data(), c.count, c.stride); break;
  }
  return {};
}

}  // namespace whit::gltf
