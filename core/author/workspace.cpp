#include "core/author/workspace.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "core/base/file_names.h"
#include "core/base/limits.h"
#include "parser/include.h"

namespace whit::author {
namespace {

namespace fs = std::filesystem;

/// What is larger is geometry that no hand has written, and nobody looks for names there.
constexpr uint64_t kLargest = uint64_t{64} << 20;
/// How many files and folders are looked at for one that includes a file.
constexpr size_t kMostCandidates = 500;
constexpr uint64_t kLargestMain = uint64_t{4} << 20;
constexpr int kMostFolders = 4;

bool is_below(const std::string& path, const std::string& folder) {
  return path == folder || path.starts_with(folder + "/");
}

}  // namespace

const std::string& Workspace::canonical(const std::string& path) {
  const auto [found, fresh] = canonical_.try_emplace(path);
  if (fresh) found->second = canonical_path(path);
  return found->second;
}

File& Workspace::open(const std::string& path, const std::string& uri, std::string text, int64_t version) {
  refresh();
  std::unique_ptr<File>& file = files_[canonical(path)];
  file = std::make_unique<File>();
  file->path = canonical(path), file->uri = uri, file->open = true, file->version = version;
  replace(*file, std::move(text));
  return *file;
}

void Workspace::replace(File& file, std::string text) {
  file.document = Document(std::move(text), encoding);
  file.index = FileIndex(file.text());
}

void Workspace::change(File& file, Position begin, Position end, std::string_view text) {
  const uint64_t from = file.document.offset(begin);
  const Span old{from, std::max(from, file.document.offset(end))};
  file.document.replace(old, text);
  file.index.update(file.text(), old, text.size());
}

void Workspace::close(File& file) {
  refresh();
  files_.erase(files_.find(file.path));
}

File* Workspace::read(const std::string& path) {
  std::error_code failed;
  const auto size = fs::file_size(path, failed);
  if (failed || !fs::is_regular_file(path, failed) || size > kLargest) return nullptr;
  const auto stamp = static_cast<int64_t>(fs::last_write_time(path, failed).time_since_epoch().count());
  std::unique_ptr<File>& file = files_[path];
  if (file && file->stamp == stamp && file->bytes == size) return file.get();
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!file) file = std::make_unique<File>();
  file->path = path, file->stamp = stamp, file->bytes = size;
  replace(*file, why_not_text(text).empty() ? std::move(text) : std::string());
  return file.get();
}

File* Workspace::find(const std::string& path) {
  const std::string& name = canonical(path);
  const auto found = files_.find(name);
  return found != files_.end() && found->second->open ? found->second.get() : look_at(name);
}

File* Workspace::look_at(const std::string& path) {
  const auto [found, fresh] = looked_at_.try_emplace(path);
  if (fresh) found->second = read(path);
  return found->second;
}

std::vector<File*> Workspace::open_files() {
  std::vector<File*> out;
  for (const auto& [path, file] : files_) {
    if (file && file->open) out.push_back(file.get());
  }
  return out;
}

std::vector<OpenText> Workspace::open_texts() {
  std::vector<OpenText> out;
  for (const File* file : open_files())
    out.push_back({file->path, std::make_shared<const std::string>(file->document.text())});
  return out;
}

std::string Workspace::resolve(const File& main, const std::string& name) {
  return join_path(fs::path(main.path).parent_path().string(), name);
}

bool Workspace::walk_file(const File& main, File& file, const Visit& visit, std::vector<const File*>& reading) {
  static const StatementRow* const include = find_statement("Include");
  if (reading.size() >= kIncludeDepth.most || ++walked_ > kIncludes.most) return true;
  reading.push_back(&file);
  for (size_t i = 0; i < file.index.items().size(); ++i) {
    if (!visit(file, i)) return false;
    const Item& item = file.index.items()[i];
    if (item.row != include) continue;
    const size_t name = file.index.first_mention(item.at.begin);
    if (name == file.index.mentions().size()) continue;
    File* included = find(resolve(main, file.index.mentions()[name].name));
    if (!included || std::find(reading.begin(), reading.end(), included) != reading.end()) continue;
    if (!walk_file(main, *included, visit, reading)) return false;
  }
  reading.pop_back();
  return true;
}

void Workspace::walk(File& main, const Visit& visit) {
  std::vector<const File*> reading;
  walked_ = 0;
  walk_file(main, main, visit, reading);
}

std::vector<File*> Workspace::files_of(File& main) {
  std::vector<File*> found{&main};
  std::unordered_set<const File*> known{&main};
  for (size_t i = 0; i < found.size(); ++i) {
    for (const Mention& m : found[i]->index.mentions()) {
      if (m.kind != NameKind::Include) continue;
      File* included = find(resolve(main, m.name));
      if (included && known.insert(included).second) found.push_back(included);
    }
  }
  return found;
}

bool Workspace::includes(File& main, const File& wanted) {
  const std::vector<File*> files = files_of(main);
  return std::find(files.begin() + 1, files.end(), &wanted) != files.end();
}

/// Scene files in the folders above a file, up to the workspace's.
std::vector<std::string> Workspace::candidates(const File& file) const {
  std::vector<std::string> out;
  fs::path folder = fs::path(file.path).parent_path();
  for (int up = 0; up < kMostFolders && !folder.empty(); ++up) {
    std::error_code failed;
    std::vector<std::string> here;
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed)) {
      if (i->path().extension() != ".pbrt" || i->path() == file.path || i->file_size(failed) > kLargestMain) continue;
      here.push_back(i->path().string());
    }
    std::sort(here.begin(), here.end());
    for (std::string& path : here) {
      if (out.size() < kMostCandidates) out.push_back(std::move(path));
    }
    const bool top = std::any_of(folders.begin(), folders.end(), [&](const auto& f) { return f == folder.string(); });
    const bool within =
        std::any_of(folders.begin(), folders.end(), [&](const auto& f) { return is_below(folder.string(), f); });
    // Outside of every workspace one step up is as far as is safe to look.
    if (top || (!within && up > 0) || folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  return out;
}

File* Workspace::main_of(File& file) {
  if (file.index.begins_world() && file.index.ends_world()) return &file;
  const auto known = main_of_.find(file.path);
  if (known != main_of_.end()) {
    File* main = find(known->second);
    if (main && includes(*main, file)) return main;
  }
  const auto remember = [&](File& main) {
    main_of_[file.path] = main.path;
    return &main;
  };
  const auto is_main = [&](File& other) { return other.index.begins_world() || !file.index.begins_world(); };
  std::vector<File*> others = open_files();
  // A whole scene rather than another piece of one.
  for (const bool whole : {true, false}) {
    for (File* other : others) {
      if (other != &file && other->index.begins_world() == whole && is_main(*other) && includes(*other, file))
        return remember(*other);
    }
    if (!whole) break;
    // Which files there are is asked once, until some may have come or gone.
    if (!alone_.insert(file.path).second) continue;
    for (const std::string& path : candidates(file)) {
      File* other = find(path);
      if (!other || !other->index.begins_world() || !includes(*other, file)) continue;
      alone_.erase(file.path);
      return remember(*other);
    }
  }
  return &file;
}

}  // namespace whit::author
