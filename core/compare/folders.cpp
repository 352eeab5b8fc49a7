#include "core/compare/folders.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>

#include "core/base/mapped_file.h"
#include "core/base/plain_text.h"
#include "core/base/stopwatch.h"
#include "core/image/atomic_file.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

constexpr std::array kEndings{".exr", ".png", ".jpg",  ".jpeg", ".tga", ".tif", ".tiff", ".tx",
                              ".pfm", ".hdr", ".rgbe", ".webp", ".bmp", ".ppm", ".pgm",  ".pbm",
                              ".pnm", ".dpx", ".gif",  ".jp2",  ".psd", ".sgi"};
/// With more subfolders behind symbolic links than that, these lead to each other.
constexpr size_t kMostLinked = 10000;

bool is_picture(const fs::path& path) {
  const std::string ending = lower_case(path.extension().string());
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

/// A folder as the system knows it, whatever the way there.
struct FolderId {
  dev_t device = 0;
  ino_t inode = 0;
  bool operator==(const FolderId&) const = default;
};

std::string id_of(const fs::path& folder, FolderId& id) {
  struct stat status = {};
  if (::stat(folder.c_str(), &status) != 0) return std::strerror(errno);
  if (!S_ISDIR(status.st_mode)) return "it is not a folder";
  id = {status.st_dev, status.st_ino};
  return {};
}

/// Lists the pictures of a folder.
class Lister {
 public:
  Lister(fs::path root, FolderId left_out) : root_(std::move(root)), left_out_(left_out) {}

  Result<std::vector<std::string>> list() {
    visit(root_, "");
    std::sort(names_.begin(), names_.end());
    return {std::move(names_), std::move(error_)};
  }

 private:
  void fail(const fs::path& folder, const std::string& reason) {
    if (error_.empty()) error_ = fmt::format("cannot read the folder \"{}\": {}", folder.string(), reason);
  }
  void visit(const fs::path& folder, const std::string& prefix);
  void note(const fs::directory_entry& entry, const std::string& name);

  fs::path root_;
  FolderId left_out_;
  std::vector<FolderId> inside_;  ///< The folders that the one being visited is in.
  std::vector<std::string> names_;
  size_t links_ = 0;   ///< How many symbolic links there are on the way to the folder being visited.
  size_t linked_ = 0;  ///< How many folders with such on their ways there were.
  std::string error_;
};

void Lister::visit(const fs::path& folder, const std::string& prefix) {
  FolderId id;
  const std::string problem = id_of(folder, id);
  if (!problem.empty()) return fail(folder, problem);
  const bool again = std::find(inside_.begin(), inside_.end(), id) != inside_.end();
  if (again || (!inside_.empty() && id == left_out_)) return;
  if (links_ > 0 && ++linked_ > kMostLinked)
    return fail(root_, fmt::format("its symbolic links lead to more than {} folders; do they lead to each other?",
                                   kMostLinked));
  inside_.push_back(id);
  std::error_code failed;
  fs::directory_iterator entry(folder, failed);
  for (; !failed && error_.empty() && entry != fs::directory_iterator(); entry.increment(failed))
    note(*entry, prefix + entry->path().filename().string());
  if (failed) fail(folder, failed.message());
  inside_.pop_back();
}

void Lister::note(const fs::directory_entry& entry, const std::string& name) {
  if (entry.path().filename().string()[0] == '.') return;
  std::error_code failed;
  const fs::file_status status = entry.status(failed);
  if (fs::is_directory(status)) {
    const size_t link = entry.is_symlink(failed) ? 1 : 0;
    links_ += link;
    visit(entry.path(), name + "/");
    links_ -= link;
    return;
  }
  // A link to nowhere is a picture that cannot be read, and no picture less.
  if (is_picture(entry.path()) && (fs::is_regular_file(status) || (entry.is_symlink(failed) && !fs::exists(status))))
    names_.push_back(name);
}

/// What is the same of names that may stand for one picture.
std::string without_ending(const std::string& name) {
  return lower_case(fs::path(name).replace_extension().generic_string());
}

std::map<std::string, std::string> find_alike(const FolderPairs& pairs) {
  std::map<std::string, std::string> extra, alike;
  for (const std::string& name : pairs.extra) extra.emplace(without_ending(name), name);
  for (const std::string& name : pairs.missing)
    if (const auto found = extra.find(without_ending(name)); found != extra.end()) alike[name] = found->second;
  return alike;
}

/// A pair on its way through the pipeline.
struct Job {
  size_t index = 0;
  CompareRequest request;
  Comparison comparison;
  PicturePair pair;
  double seconds = 0;
};

void compare(const std::string& a, const std::string& b, const std::string& name, Job& job) {
  const Stopwatch watch;
  const std::string in = (fs::path(a) / name).string(), ref = (fs::path(b) / name).string();
  try {
    job.comparison = compare_files(in, ref, job.request, &job.pair);
  } catch (const std::bad_alloc&) {
    job.comparison = {};
    job.comparison.a_path = in;
    job.comparison.b_path = ref;
    job.comparison.cannot = "there is not enough memory";
    job.pair = {};
  }
  job.seconds = watch.elapsed().wall;
}

}  // namespace

Result<FolderPairs> pair_folders(const std::string& a, const std::string& b) {
  FolderId a_id, b_id;
  id_of(a, a_id);
  id_of(b, b_id);
  const Result<std::vector<std::string>> in = Lister(a, b_id).list(), refs = Lister(b, a_id).list();
  if (!in.ok()) return {{}, in.error};
  if (!refs.ok()) return {{}, refs.error};
  FolderPairs pairs;
  const auto &x = in.value, &y = refs.value;
  std::set_intersection(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(pairs.both));
  std::set_difference(y.begin(), y.end(), x.begin(), x.end(), std::back_inserter(pairs.missing));
  std::set_difference(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(pairs.extra));
  pairs.alike = find_alike(pairs);
  return {std::move(pairs), ""};
}

void compare_folders(const std::string& a, const std::string& b, const std::vector<std::string>& names,
                     const std::function<CompareRequest(const std::string& name)>& request,
                     const std::function<void(const ComparedPair&)>& done) {
  using JobPtr = std::shared_ptr<Job>;
  size_t next = 0;
  const auto start = [&](tbb::flow_control& flow) -> JobPtr {
    if (next == names.size()) return flow.stop(), nullptr;
    auto job = std::make_shared<Job>();
    job->index = next++;
    job->request = request(names[job->index]);
    return job;
  };
  // A pair is compared by several threads at once, too. Isolated, a thread that waits for the others does not begin
  // another pair meanwhile.
  const auto work = [&](JobPtr job) {
    tbb::this_task_arena::isolate([&] { compare(a, b, names[job->index], *job); });
    return job;
  };
  const auto finish = [&](const JobPtr& job) {
    tbb::this_task_arena::isolate([&] { done({names[job->index], job->comparison, job->pair, job->seconds}); });
  };
  const auto at_once = static_cast<size_t>(tbb::this_task_arena::max_concurrency());
  using Mode = tbb::filter_mode;
  tbb::parallel_pipeline(at_once, tbb::make_filter<void, JobPtr>(Mode::serial_in_order, start) &
                                      tbb::make_filter<JobPtr, JobPtr>(Mode::parallel, work) &
                                      tbb::make_filter<JobPtr, void>(Mode::serial_in_order, finish));
}

std::string replace_with(const std::string& from, const std::string& to) {
  const MappedFile source(from);
  if (!source.error().empty()) return fmt::format("\"{}\" cannot be read: {}", from, source.error());
  struct stat status = {};
  if (::stat(to.c_str(), &status) != 0) return std::strerror(errno);
  // Of a file that nobody may write to, the superuser neither: somebody meant it to stay.
  if ((status.st_mode & 0222) == 0) return "it is write-protected";
  AtomicFile target(to);
  target.keep_permissions();
  target.write_at(source.bytes().data(), source.bytes().size(), 0);
  if (const std::string changed = source.problem(); !changed.empty()) return fmt::format("\"{}\": {}", from, changed);
  return target.commit();
}

}  // namespace whit
