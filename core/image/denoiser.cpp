#include "core/image/denoiser.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace whit {
namespace {

namespace fs = std::filesystem;

// Of OpenImageDenoise/oidn.h, what has not changed from version 1.4 to 2.
using Device = struct OidnDevice*;
using Filter = struct OidnFilter*;
constexpr int kCpu = 1;     // OIDN_DEVICE_TYPE_CPU: the picture is in main memory
constexpr int kFloat3 = 3;  // OIDN_FORMAT_FLOAT3

constexpr const char* kName = "libOpenImageDenoise.so";

}  // namespace

struct Denoiser::Functions {
  Device (*new_device)(int type);
  void (*set_device_int)(Device, const char* name, int value);
  int (*get_device_int)(Device, const char* name);
  void (*commit_device)(Device);
  int (*device_error)(Device, const char** message);
  void (*release_device)(Device);
  Filter (*new_filter)(Device, const char* type);
  void (*set_image)(Filter, const char* name, void* at, int format, size_t width, size_t height, size_t offset,
                    size_t pixel_stride, size_t row_stride);
  void (*set_bool)(Filter, const char* name, bool value);
  void (*set_int)(Filter, const char* name, int value);
  void (*commit_filter)(Filter);
  void (*execute_filter)(Filter);
  void (*release_filter)(Filter);
};

namespace {

/// Takes a function that a library has by one of two names: version 2 has given some another.
template <class Function>
bool take(void* library, Function& to, const char* name, const char* earlier = nullptr) {
  void* found = ::dlsym(library, name);
  if (!found && earlier) found = ::dlsym(library, earlier);
  to = reinterpret_cast<Function>(found);
  return found != nullptr;
}

template <class Functions>
bool take_all(void* library, Functions& f) {
  return take(library, f.new_device, "oidnNewDevice") &&
         take(library, f.set_device_int, "oidnSetDeviceInt", "oidnSetDevice1i") &&
         take(library, f.get_device_int, "oidnGetDeviceInt", "oidnGetDevice1i") &&
         take(library, f.commit_device, "oidnCommitDevice") && take(library, f.device_error, "oidnGetDeviceError") &&
         take(library, f.release_device, "oidnReleaseDevice") && take(library, f.new_filter, "oidnNewFilter") &&
         take(library, f.set_image, "oidnSetSharedFilterImage") &&
         take(library, f.set_bool, "oidnSetFilterBool", "oidnSetFilter1b") &&
         take(library, f.set_int, "oidnSetFilterInt", "oidnSetFilter1i") &&
         take(library, f.commit_filter, "oidnCommitFilter") && take(library, f.execute_filter, "oidnExecuteFilter") &&
         take(library, f.release_filter, "oidnReleaseFilter");
}

/// A library and the name it was found by; null with the reason.
struct Loaded {
  void* library = nullptr;
  std::string path, reason;
};

Loaded open_library(const std::string& path) {
  void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library) return {library, path, {}};
  return {nullptr, path, ::dlerror()};
}

/// The files of a folder whose names begin like that, the newest version first.
std::vector<std::string> files_of(const fs::path& folder, const std::string& beginning) {
  std::vector<std::string> files;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    if (entry.path().filename().string().starts_with(beginning)) files.push_back(entry.path().string());
  }
  std::sort(files.rbegin(), files.rend());
  return files;
}

/// The library of a folder that somebody has unpacked. What it needs of TBB is loaded already, or lies beside it.
Loaded open_in_folder(const fs::path& folder) {
  Loaded last{nullptr, {}, fmt::format("there is no {} in {}", kName, folder.string())};
  for (const std::string& path : files_of(folder, kName)) {
    last = open_library(path);
    if (last.library) return last;
    for (const std::string& tbb : files_of(folder, "libtbb.so")) {
      if (::dlopen(tbb.c_str(), RTLD_NOW | RTLD_LOCAL)) break;
    }
    last = open_library(path);
    if (last.library) return last;
  }
  return last;
}

/// Where Python keeps packages below a prefix.
void add_packages(const fs::path& prefix, std::vector<fs::path>& folders) {
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(prefix / "lib", failed)) {
    if (!entry.path().filename().string().starts_with("python3")) continue;
    folders.push_back(entry.path() / "site-packages");
    folders.push_back(entry.path() / "dist-packages");
  }
}

/// Folders in which PyPI's wheel puts the library.
std::vector<fs::path> folders_of_python() {
  std::vector<fs::path> packages;
  std::error_code failed;
  if (const char* active = std::getenv("VIRTUAL_ENV")) add_packages(active, packages);
  add_packages(fs::read_symlink("/proc/self/exe", failed).parent_path().parent_path(), packages);
  if (const char* home = std::getenv("HOME")) add_packages(fs::path(home) / ".local", packages);
  add_packages("/usr/local", packages);
  add_packages("/usr", packages);
  for (fs::path& folder : packages) folder = folder / "oidn" / "lib.linux.x64";
  return packages;
}

Loaded find_library() {
  if (const char* named = std::getenv("WHIT_OIDN"); named && *named) {
    std::error_code failed;
    Loaded found = fs::is_directory(named, failed) ? open_in_folder(named) : open_library(named);
    if (!found.library) found.reason = "WHIT_OIDN: " + found.reason;
    return found;
  }
  for (const char* version : {".2", ".1"}) {
    if (Loaded found = open_library(std::string(kName) + version); found.library) return found;
  }
  Loaded last{nullptr, {}, "neither the loader nor Python's packages have it"};
  for (const fs::path& folder : folders_of_python()) {
    std::error_code failed;
    if (!fs::is_directory(folder, failed)) continue;
    last = open_in_folder(folder);
    if (last.library) return last;
  }
  return last;
}

/// A device and a filter, which go with it.
template <class Functions>
class Run {
 public:
  Run(const Functions& f, int threads) : f_(f), device_(f.new_device(kCpu)) {
    if (!device_) return;
    if (threads > 0) f_.set_device_int(device_, "numThreads", threads);
    f_.set_device_int(device_, "setAffinity", 0);  // Others have their threads on these cores.
    f_.commit_device(device_);
    filter_ = f_.new_filter(device_, "RT");
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run() {
    if (filter_) f_.release_filter(filter_);
    if (device_) f_.release_device(device_);
  }

  void set_image(const char* name, const float* at, int width, int height) {
    // The library's interface has no const; it writes to "output" alone.
    if (filter_)
      f_.set_image(filter_, name, const_cast<float*>(at), kFloat3, static_cast<size_t>(width),
                   static_cast<size_t>(height), 0, 0, 0);
  }

  /// "" or what went wrong. `memory`: bytes that it may take.
  std::string execute(size_t memory) {
    if (filter_) {
      f_.set_bool(filter_, "hdr", true);
      f_.set_int(filter_, "maxMemoryMB", static_cast<int>(memory >> 20));
      f_.commit_filter(filter_);
      f_.execute_filter(filter_);
    }
    const char* message = nullptr;
    if (f_.device_error(device_, &message) != 0) return message ? message : "an error that it has no words for";
    return filter_ ? std::string() : "it has no filter for pictures of ray tracers";
  }

  int version() const { return device_ ? f_.get_device_int(device_, "version") : 0; }

 private:
  const Functions& f_;
  Device device_;
  Filter filter_ = nullptr;
};

}  // namespace

Denoiser::Denoiser(std::unique_ptr<const Functions> functions, std::string path)
    : functions_(std::move(functions)), path_(std::move(path)) {}
Denoiser::~Denoiser() = default;

Denoiser::Output Denoiser::denoise(const Input& input) const {
  Output out{std::vector<float>(input.rgb.size()), {}};
  Run run(*functions_, input.threads);
  for (const auto& [name, values] : {std::pair{"color", input.rgb.data()},
                                     {"albedo", input.albedo.data()},
                                     {"normal", input.normal.data()},
                                     {"output", static_cast<const float*>(out.rgb.data())}}) {
    run.set_image(name, values, input.width, input.height);
  }
  const size_t bytes = memory(static_cast<double>(input.width) * input.height);
  if (const std::string problem = run.execute(bytes); !problem.empty()) out.error = "OpenImageDenoise: " + problem;
  return out;
}

// The network has about 220 floats for each pixel of a tile; its weights and what they are brought into take some MiB.
size_t Denoiser::memory(double pixels) {
  constexpr double kLeast = 64 << 20, kMost = 1 << 30, kPixel = 880;
  return static_cast<size_t>(std::min(kLeast + kPixel * pixels, kMost));
}

std::string Denoiser::describe() const {
  const int version = Run(*functions_, 1).version();
  return fmt::format("OpenImageDenoise {}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

DenoiserResult load_denoiser() {
  Loaded found = find_library();
  auto functions = std::make_unique<Denoiser::Functions>();
  if (found.library && take_all(found.library, *functions))
    return {std::unique_ptr<const Denoiser>(new Denoiser(std::move(functions), std::move(found.path))), {}};
  const std::string reason =
      found.library ? fmt::format("{} lacks functions of version 1.4", found.path) : std::move(found.reason);
  return {nullptr, fmt::format("OpenImageDenoise cannot be loaded ({}); install it (`pip install oidn`, or a "
                               "distribution's libopenimagedenoise), or name its file or folder in WHIT_OIDN",
                               reason)};
}

}  // namespace whit
