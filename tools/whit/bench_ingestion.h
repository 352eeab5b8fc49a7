// How fast files come in: scene text, PLY meshes, glTF models, and the ray tracer's structures over them. On one thread.
#pragma once

#include <string>

#include "tools/whit/spread.h"

namespace whit {

struct IngestionSettings {
  int runs = 5;                 ///< Of each measurement.
  double text_megabytes = 256;  ///< Of scene text, 10^6 bytes each.
};

struct Ingestion {
  double text_megabytes = 0, ply_megabytes = 0, triangles = 0;  ///< What was read and built in each run.
  Spread text_mb_per_s;  ///< Parsing a scene of inline meshes from a file that the system has in memory.
  Spread ply_mb_per_s;   ///< Reading a binary little-endian mesh with normals and (u, v), checks included.
  Spread glb_over_ply;   ///< The same mesh as .glb: its time to be traceable by the PLY file's, text and plan included.
  Spread build_mtris_per_s;  ///< Millions of its triangles, from as read to traceable.
};

/// Writes the files it needs into `folder`, which must exist. Throws std::runtime_error when that fails.
Ingestion measure_ingestion(const std::string& folder, const IngestionSettings& settings);

}  // namespace whit
