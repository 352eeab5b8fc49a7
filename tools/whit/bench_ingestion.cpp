#include "tools/whit/bench_ingestion.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "core/session/session.h"

namespace whit {
namespace {

/// A wavy sheet of 2 n^2 triangles.
struct Sheet {
  struct Vertex {
    float x, y, z, nx, ny, nz, u, v;
  };
  std::vector<Vertex> vertices;
  std::vector<int32_t> indices;

  explicit Sheet(int n) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const float u = static_cast<float>(i) / static_cast<float>(n),
                    v = static_cast<float>(j) / static_cast<float>(n);
        const float slope_x = 0.3f * std::cos(30 * u), slope_y = -0.3f * std::sin(30 * v);
        const float z = 0.01f * (std::sin(30 * u) + std::cos(30 * v)), length = std::hypot(slope_x, slope_y, 1.0f);
        vertices.push_back({u, v, z, -slope_x / length, -slope_y / length, 1 / length, u, v});
      }
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
        indices.insert(indices.end(), {a, b, d, a, d, c});
      }
    }
  }
};

constexpr const char* kHead = "LookAt 0.5 0.5 2  0.5 0.5 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n";

std::string inline_mesh(const Sheet& sheet) {
  std::string points, normals, uvs, indices;
  for (const Sheet::Vertex& v : sheet.vertices) {
    fmt::format_to(std::back_inserter(points), "{:.6f} {:.6f} {:.6f}\n", v.x, v.y, v.z);
    fmt::format_to(std::back_inserter(normals), "{:.5f} {:.5f} {:.5f}\n", v.nx, v.ny, v.nz);
    fmt::format_to(std::back_inserter(uvs), "{:.6f} {:.6f}\n", v.u, v.v);
  }
  for (size_t i = 0; i < sheet.indices.size(); i += 3) {
    fmt::format_to(std::back_inserter(indices), "{} {} {}\n", sheet.indices[i], sheet.indices[i + 1],
                   sheet.indices[i + 2]);
  }
  return fmt::format(
      "Shape \"trianglemesh\" \"integer indices\" [\n{}] \"point P\" [\n{}] \"normal N\" [\n{}] \"float uv\" [\n{}]\n",
      indices, points, normals, uvs);
}

void close(std::ofstream& file, const std::string& path) {
  file.close();
  if (!file) throw std::runtime_error(fmt::format("cannot write {}", path));
}

void write_text(const std::string& path, double megabytes) {
  std::ofstream file(path, std::ios::binary);
  file << kHead;
  const std::string mesh = inline_mesh(Sheet(300));
  for (double left = megabytes * 1e6; left > 0 && file; left -= static_cast<double>(mesh.size())) file << mesh;
  file << "WorldEnd\n";
  close(file, path);
}

void write_ply(const std::string& path, const Sheet& sheet) {
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", sheet.vertices.size());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
    bytes += fmt::format("property float {}\n", name);
  bytes +=
      fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", sheet.indices.size() / 3);
  const auto append = [&](const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); };
  append(sheet.vertices.data(), sheet.vertices.size() * sizeof(Sheet::Vertex));
  for (size_t i = 0; i < sheet.indices.size(); i += 3) {
    bytes += '\3';
    append(&sheet.indices[i], 3 * sizeof(int32_t));
  }
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  close(file, path);
}

/// The same mesh, interleaved, as a model of one node.
void write_glb(const std::string& path, const Sheet& sheet) {
  const size_t vertex_bytes = sheet.vertices.size() * sizeof(Sheet::Vertex),
               index_bytes = sheet.indices.size() * sizeof(int32_t);
  const auto attribute = [&](int offset, const char* type, const char* more) {
    return fmt::format(R"({{"bufferView":0,"byteOffset":{},"componentType":5126,"count":{},"type":"{}"{}}})", offset,
                       sheet.vertices.size(), type, more);
  };
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}],)"
      R"("accessors":[{},{},{},{{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{},"byteStride":32}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{"byteLength":{}}}]}})",
      attribute(0, "VEC3", R"(,"min":[0,0,-1],"max":[1,1,1])"), attribute(12, "VEC3", ""), attribute(24, "VEC2", ""),
      sheet.indices.size(), vertex_bytes, vertex_bytes, index_bytes, vertex_bytes + index_bytes);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::ofstream file(path, std::ios::binary);
  const auto words = [&](std::initializer_list<uint32_t> list) {
    for (const uint32_t word : list) file.write(reinterpret_cast<const char*>(&word), sizeof word);
  };
  const auto body = static_cast<uint32_t>(vertex_bytes + index_bytes), text = static_cast<uint32_t>(json.size());
  words({0x46546c67, 2, 28 + text + body, text, 0x4e4f534a});
  file << json;
  words({body, 0x004e4942});
  file.write(reinterpret_cast<const char*>(sheet.vertices.data()), static_cast<std::streamsize>(vertex_bytes));
  file.write(reinterpret_cast<const char*>(sheet.indices.data()), static_cast<std::streamsize>(index_bytes));
  close(file, path);
}

/// The medians and spreads of `runs` runs after one that warms caches; measure() returns the rates of a run.
template <size_t N, class Measure>
std::array<Spread, N> repeat(int runs, const Measure& measure) {
  std::array<std::vector<double>, N> rates;
  for (int run = 0; run <= runs; ++run) {
    const std::array<double, N> rate = measure();
    for (size_t i = 0; i < N && run > 0; ++i) rates[i].push_back(rate[i]);
  }
  std::array<Spread, N> spreads;
  for (size_t i = 0; i < N; ++i) spreads[i] = spread_of(rates[i]);
  return spreads;
}

void measure_text(const std::string& path, int runs, Ingestion& out) {
  const auto [spread] = repeat<1>(runs, [&] {
    const ParsedFile file = read_scene_file(path);
    if (file.said.has_errors()) throw std::runtime_error("the scene made for measuring has errors");
    out.text_megabytes = static_cast<double>(file.bytes) / 1e6;
    return std::array{out.text_megabytes / file.elapsed.wall};
  });
  out.text_mb_per_s = spread;
}

void measure_ply(const std::string& path, int runs, Ingestion& out) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  out.ply_megabytes = static_cast<double>(file.tellg()) / 1e6;
  const auto [read, build] = repeat<2>(runs, [&] {
    const ParsedFile scene_file =
        read_scene_text("ply", fmt::format("{}Shape \"plymesh\" \"string filename\" \"{}\"\nWorldEnd\n", kHead, path));
    const BuiltWorld built = build_world(plan_world(scene_file.worlds.at(0), *scene_file.sources));
    if (!built.scene || built.said.has_errors()) throw std::runtime_error("the mesh made for measuring has errors");
    const BuildTimes& times = built.scene->build_times;
    out.triangles = static_cast<double>(built.scene->triangle_count());
    return std::array{out.ply_megabytes / times.geometry.wall,
                      out.triangles / 1e6 / (times.placing.wall + times.ray_tracer.wall)};
  });
  out.ply_mb_per_s = read, out.build_mtris_per_s = build;
}

/// Seconds until the shape of a file is ready to be traced.
double seconds_to_traceable(const char* shape, const std::string& path) {
  const ParsedFile file =
      read_scene_text(shape, fmt::format("{}Shape \"{}\" \"string filename\" \"{}\"\nWorldEnd\n", kHead, shape, path));
  if (file.worlds.empty()) throw std::runtime_error("the model made for measuring has errors");
  PlannedWorld planned = plan_world(file.worlds.front(), *file.sources);
  const double before = file.elapsed.wall + planned.elapsed.wall;
  const BuiltWorld built = build_world(std::move(planned));
  if (!built.scene || built.said.has_errors()) throw std::runtime_error("the model made for measuring has errors");
  return before + built.elapsed.wall;
}

}  // namespace

Ingestion measure_ingestion(const std::string& folder, const IngestionSettings& settings) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const std::string text = folder + "/ingestion.pbrt", ply = folder + "/ingestion.ply", glb = folder + "/ingestion.glb";
  Ingestion out;
  write_text(text, settings.text_megabytes);
  measure_text(text, settings.runs, out);
  write_ply(ply, Sheet(700));  // 980,000 triangles
  measure_ply(ply, settings.runs, out);
  write_glb(glb, Sheet(700));
  out.glb_over_ply = repeat<1>(settings.runs, [&] {
    const double of_ply = seconds_to_traceable("plymesh", ply);
    return std::array{seconds_to_traceable("gltf", glb) / of_ply};
  })[0];
  return out;
}

}  // namespace whit
