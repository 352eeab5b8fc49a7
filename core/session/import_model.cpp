#include "core/session/import_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <sstream>

#include "core/base/mapped_file.h"
#include "core/gltf/buffers.h"
#include "core/gltf/statement_text.h"
#include "core/image/atomic_file.h"
#include "core/plugin/mesh_ply.h"
#include "parser/format.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// What may be in the name of a file everywhere: other characters become underscores.
std::string file_name(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    out += plain ? c : '_';
  }
  constexpr size_t kLongest = 100;
  if (out.empty() || out.front() == '.') out.insert(out.begin(), '_');
  return out.substr(0, kLongest);
}

/// A file to be written.
struct NewFile {
  std::string path;
  std::shared_ptr<const MeshSource> mesh;  ///< What is in it: a mesh, a picture, or a text.
  const gltf::Image* image = nullptr;
  std::string bytes;
};

/// Meshes and pictures become files of a folder.
class FileAssets final : public gltf::Assets {
 public:
  explicit FileAssets(fs::path folder) : folder_(std::move(folder)) {}

  std::string mesh(std::shared_ptr<const MeshSource> source, const std::string& name) override {
    const std::string file = add(name, "ply");
    files_.back().mesh = std::move(source);
    return " \"plymesh\"" + gltf::string_param("string filename", file);
  }

  std::string picture(const gltf::Image& image, const std::string& name) override {
    auto [found, is_new] = pictures_.try_emplace(&image);
    if (is_new) {
      std::string stem = image.name;
      if (stem.empty() && !image.file.empty()) stem = fs::path(image.file).stem().string();
      found->second = add(stem.empty() ? name : stem, image.extension.empty() ? "picture" : image.extension);
      files_.back().image = &image;
    }
    return gltf::string_param("string filename", found->second);
  }

  std::vector<NewFile> take() { return std::move(files_); }

 private:
  std::string add(const std::string& stem, const std::string& ending) {
    const std::string base = file_name(stem);
    std::string name = base + '.' + ending;
    for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}_{}.{}", base, i, ending);
    files_.push_back({(folder_ / name).string(), nullptr, nullptr, {}});
    return (folder_.filename() / name).string();
  }

  fs::path folder_;
  std::set<std::string> taken_;
  std::map<const gltf::Image*, std::string> pictures_;
  std::vector<NewFile> files_;
};

/// Reads what a new file is to have; "" or what is wrong.
std::string read_bytes(const gltf::Model& model, NewFile& file) {
  if (file.mesh) {
    MeshData mesh;
    if (std::string error = file.mesh->read(mesh); !error.empty()) return error;
    file.bytes = mesh_as_ply(mesh);
  } else if (file.image && file.image->inside) {
    const std::span<const uint8_t> inside = file.image->inside->bytes;
    file.bytes.assign(inside.begin(), inside.end());
    const std::string changed = model.buffers->problem();
    if (!changed.empty()) return model.at(changed);
  } else if (file.image) {
    const MappedFile picture(file.image->file);
    file.bytes = picture.bytes();
    const std::ptrdiff_t number = file.image - model.images.data();
    if (const std::string problem = picture.problem(); !problem.empty())
      return model.at(fmt::format("/images/{}/uri: cannot read \"{}\": {}", number, file.image->file, problem));
  }
  return {};
}

/// Whether a file is one that the model is read from.
bool is_source(const gltf::Model& model, const std::string& path) {
  return std::any_of(model.images.begin(), model.images.end(), [&](const gltf::Image& image) {
    std::error_code failed;
    return !image.file.empty() && fs::equivalent(image.file, path, failed);
  });
}

bool holds(const std::string& path, const std::string& bytes) {
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {}) == bytes;
}

/// Writes the files, in order; after an error removes those that were not there before.
class FileWriter {
 public:
  FileWriter(const gltf::Model& model, bool overwrite) : model_(model), overwrite_(overwrite) {}
  ~FileWriter() {
    std::error_code ignored;
    if (!done_) {
      for (auto path = made_.rbegin(); path != made_.rend(); ++path) fs::remove(*path, ignored);
    }
  }
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  std::string write(const std::string& path, const std::string& bytes) {
    const bool there = fs::exists(path);
    if (there && !fs::is_regular_file(path)) return fmt::format("\"{}\" is there already, and is no file", path);
    if (there && holds(path, bytes)) return {};
    if (there && is_source(model_, path)) return fmt::format("\"{}\" is a picture of the model itself", path);
    if (there && !overwrite_)
      return fmt::format("\"{}\" is there already, with something else in it; --force replaces files", path);
    AtomicFile file(path);
    file.write_at(bytes.data(), bytes.size(), 0);
    const std::string failure = file.commit();
    if (failure.empty() && !there) made_.push_back(path);
    return failure.empty() ? "" : fmt::format("cannot write \"{}\": {}", path, failure);
  }
  void make_folder(const std::string& path) {
    std::error_code ignored;  // Writing the first file in it says what is wrong.
    if (fs::create_directory(path, ignored)) made_.push_back(path);
  }
  void keep() { done_ = true; }

 private:
  const gltf::Model& model_;
  const bool overwrite_;
  bool done_ = false;
  std::vector<std::string> made_;
};

/// "# From model.glb by whit import." and what there is to know.
std::string head(const ImportRequest& request, const std::vector<std::string>& notes) {
  std::string out = gltf::comment(fmt::format("From {} by whit import.", fs::path(request.model).filename().string()));
  for (const std::string& note : notes) out += gltf::comment(note + ".");
  return out + "\n";
}

/// Indented, as `whit fmt` writes it.
std::string in_normal_form(const std::string& text, Diagnostics& said) {
  Sources sources;
  std::ostringstream out;
  const Diagnostics found = format_text(sources, "import", text, "", out);
  for (Diagnostic d : found.all()) {
    d.where = {};
    said.add(d);
  }
  return out.str();
}

}  // namespace

ImportResult import_model(const ImportRequest& request) {
  ImportResult out;
  const auto model = gltf::load_model(request.model, request.model, {request.allow_outside}, {}, out.said);
  if (!model) return out;
  const fs::path folder = fs::path(request.scene).replace_extension();
  FileAssets assets(folder);
  const auto described = gltf::describe_scene(model, request.selection, assets, out.said);
  if (!described) return out;
  out.notes = described->notes;
  // All is read before anything is written: a file that is replaced may be one of the model's.
  std::vector<NewFile> files = assets.take();
  for (NewFile& file : files) {
    if (const std::string error = read_bytes(*model, file); !error.empty()) out.said.file_error({}, error);
  }
  const std::string text = in_normal_form(head(request, described->notes) + described->text, out.said);
  files.push_back({request.scene, nullptr, nullptr, text});
  if (out.said.has_errors()) return out;
  FileWriter writer(*model, request.overwrite);
  if (files.size() > 1) writer.make_folder(folder.string());
  for (const NewFile& file : files) {
    if (const std::string failure = writer.write(file.path, file.bytes); !failure.empty()) {
      out.said.file_error({}, failure);
      return out;
    }
    out.written.push_back(file.path);
  }
  writer.keep();
  return out;
}

}  // namespace whit
