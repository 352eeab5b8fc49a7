#include "tools/whit/sandbox.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/landlock.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>

#include "tools/whit/terminal.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

// ---- Landlock, for which the C library has no functions ----

constexpr uint64_t kReadFiles = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
/// Making a file, giving it a name, and putting it in the place of an older one.
constexpr uint64_t kWriteFiles = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_READ_FILE |
                                 LANDLOCK_ACCESS_FS_READ_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                                 LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE;
constexpr uint64_t kOfFirstVersion = (uint64_t{LANDLOCK_ACCESS_FS_MAKE_SYM} << 1) - 1;
// Of later versions, which older headers lack.
constexpr uint64_t kRefer = uint64_t{1} << 13, kTruncate = uint64_t{1} << 14, kControlDevices = uint64_t{1} << 15;

/// All rights that this kernel can take away; 0 where it has no Landlock.
uint64_t rights_of_kernel() {
  const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  uint64_t rights = version >= 1 ? kOfFirstVersion : 0;
  if (version >= 2) rights |= kRefer;
  if (version >= 3) rights |= kTruncate;
  if (version >= 5) rights |= kControlDevices;
  return rights;
}

/// Closes itself.
class Descriptor {
 public:
  explicit Descriptor(long fd) : fd_(static_cast<int>(fd)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

class FileRules {
 public:
  FileRules() : rights_(rights_of_kernel()), rules_(create()) {}

  bool usable() const { return rules_.get() >= 0; }

  /// Lets a file, or all below a folder, be used in some ways. What is not there needs no rule. False with errno.
  bool allow(const std::string& path, uint64_t rights) const {
    const Descriptor at(::open(path.c_str(), O_PATH | O_CLOEXEC));
    if (at.get() < 0) return errno == ENOENT;
    struct stat status = {};
    if (::fstat(at.get(), &status) != 0) return false;
    constexpr uint64_t kOfFiles = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate;
    const uint64_t possible = S_ISDIR(status.st_mode) ? rights_ : rights_ & kOfFiles;
    landlock_path_beneath_attr rule = {};
    rule.allowed_access = rights & possible, rule.parent_fd = at.get();
    return ::syscall(SYS_landlock_add_rule, rules_.get(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
  }

  bool enforce() const { return ::syscall(SYS_landlock_restrict_self, rules_.get(), 0) == 0; }

 private:
  long create() const {
    if (rights_ == 0) return -1;
    landlock_ruleset_attr attributes = {};
    attributes.handled_access_fs = rights_;
    return ::syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes.handled_access_fs, 0);
  }

  const uint64_t rights_;
  const Descriptor rules_;
};

// ---- seccomp ----

/// What nobody who renders asks of a kernel: other programs, other processes, its own configuration, and ways around.
constexpr std::array kForbidden{"execve",
                                "execveat",
                                "fork",
                                "vfork",
                                "ptrace",
                                "kill",
                                "tkill",
                                "pidfd_open",
                                "pidfd_getfd",
                                "process_vm_readv",
                                "process_vm_writev",
                                "io_uring_setup",
                                "io_uring_enter",
                                "bpf",
                                "perf_event_open",
                                "userfaultfd",
                                "keyctl",
                                "add_key",
                                "request_key",
                                "mount",
                                "umount2",
                                "move_mount",
                                "open_tree",
                                "fsopen",
                                "pivot_root",
                                "chroot",
                                "unshare",
                                "setns",
                                "reboot",
                                "kexec_load",
                                "init_module",
                                "finit_module",
                                "delete_module",
                                "swapon",
                                "swapoff",
                                "settimeofday",
                                "clock_settime",
                                "sethostname",
                                "setdomainname",
                                "personality",
                                "name_to_handle_at",
                                "open_by_handle_at",
                                "quotactl",
                                "acct",
                                "syslog",
                                "mknod",
                                "mknodat",
                                "symlink",
                                "symlinkat",
                                "truncate"};
constexpr std::array kCalls{"connect", "sendmsg", "sendmmsg", "socketpair"};
constexpr std::array kServing{"socket", "bind", "listen", "accept", "accept4"};

using Filter = std::unique_ptr<void, void (*)(scmp_filter_ctx)>;

/// A call that this processor does not have is none to forbid.
bool forbid(scmp_filter_ctx filter, const char* name) {
  const int number = ::seccomp_syscall_resolve_name(name);
  if (number == __NR_SCMP_ERROR || number < 0) return true;
  return ::seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), number, 0) == 0;
}

/// A server sends what it was asked for to those who are connected; it calls nobody.
std::string forbid_calls(bool serves) {
  const Filter filter(::seccomp_init(SCMP_ACT_ALLOW), [](scmp_filter_ctx f) { ::seccomp_release(f); });
  if (!filter) return "the library of system call filters failed";
  bool good = true;
  for (const char* name : kForbidden) good &= forbid(filter.get(), name);
  if (serves) {
    // Of what sends, only what has no address: to those who are connected.
    const scmp_arg_cmp has_address{4, SCMP_CMP_NE, 0, 0};
    good &= ::seccomp_rule_add_array(filter.get(), SCMP_ACT_ERRNO(EPERM), SCMP_SYS(sendto), 1, &has_address) == 0;
    for (const char* name : kCalls) good &= forbid(filter.get(), name);
  } else {
    good &= forbid(filter.get(), "sendto");
    for (const char* name : kCalls) good &= forbid(filter.get(), name);

    for (const char* name : kServing) good &= forbid(filter.get(), name);
  }
  if (!good || ::seccomp_load(filter.get()) != 0) return "this kernel has no filter of system calls (seccomp)";
  return {};
}

// ---- Both ----

/// Threads that run already would stay outside.
size_t threads_of_process() {
  std::error_code failed;
  return static_cast<size_t>(
      std::distance(fs::directory_iterator("/proc/self/task", failed), fs::directory_iterator()));
}

/// What the program reads of the machine: its own state, how much memory there is, the processors, random numbers.
constexpr std::array kOfMachine{"/proc/self",    "/proc/self/exe",      "/proc/meminfo",
                                "/proc/cpuinfo", "/sys/devices/system", "/sys/fs/cgroup",
                                "/dev/urandom",  "/etc/localtime",      "/usr/share/zoneinfo"};

/// Modules are loaded when they are first needed, with all the libraries that these need, some of which start threads at
/// once: too early for a sandbox. They may be read, as everybody may.
std::vector<std::string> libraries() {
  std::error_code failed;
  const fs::path folder = fs::read_symlink("/proc/self/exe", failed).parent_path();
  return {"/lib",
          "/lib64",
          "/usr/lib",
          "/usr/lib64",
          "/etc/ld.so.cache",
          (folder / "whit_oiio.so").string(),
          (folder / "whit_http.so").string(),
          (folder.parent_path() / "lib").string()};
}

std::string folder_to_write(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::string allow_all(const FileRules& rules, const SandboxFlags& flags, const SandboxRequest& request) {
  const auto problem = [](const std::string& path) {
    return fmt::format("cannot open \"{}\": {}", path, std::strerror(errno));
  };
  for (const char* path : kOfMachine) {
    if (!rules.allow(path, kReadFiles)) return problem(path);
  }
  if (!rules.allow("/dev/null", LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE))
    return problem("/dev/null");
  const std::vector<std::string> code = libraries();
  for (const auto* paths : {&code, &request.read, &flags.allow}) {
    for (const std::string& path : *paths) {
      if (!path.empty() && path != "-" && !rules.allow(path, kReadFiles)) return problem(path);
    }
  }
  for (const std::string& file : request.write) {
    if (file.empty() || file == "-") continue;
    if (!rules.allow(folder_to_write(file), kWriteFiles | kTruncate)) return problem(file);
  }
  return {};
}

}  // namespace

void add_sandbox_flags(CommandLine& command, SandboxFlags& flags) {
  command.flags.push_back({"--sandbox", &flags.on,
                           "For scenes of others: the kernel lets nothing be read but the scene's folder, nothing be "
                           "written but the outputs, and nobody be called"});
  command.flags.push_back({"--allow",
                           &flags.allow,
                           "With --sandbox: a file or folder that may be read too",
                           {.repeats = true, .files = ""}});
}

std::string usage_problem(const SandboxFlags& flags) {
  if (!flags.on && !flags.allow.empty()) return "--allow adds to what --sandbox lets be read, and that is not given";
  for (const std::string& path : flags.allow) {
    std::error_code failed;
    if (!fs::exists(path, failed)) return fmt::format("--allow: there is no \"{}\"", path);
  }
  return {};
}

std::string folder_to_read(const std::string& scene) {
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(scene, failed);
  return scene.empty() || scene == "-" || failed || !whole.has_parent_path() ? "." : whole.parent_path().string();
}

std::string enter_sandbox(const SandboxFlags& flags, const SandboxRequest& request) {
  if (!flags.on) return {};
  if (threads_of_process() != 1) return "--sandbox: there are threads already, which it would not hold";
  const FileRules rules;
  if (!rules.usable())
    return "--sandbox: this kernel cannot take files away (Landlock); without it nothing is rendered";
  if (std::string problem = allow_all(rules, flags, request); !problem.empty()) return "--sandbox: " + problem;
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || !rules.enforce())
    return fmt::format("--sandbox: {}", std::strerror(errno));
  if (std::string problem = forbid_calls(request.serves); !problem.empty()) return "--sandbox: " + problem;
  return {};
}

void explain_sandbox(const SandboxFlags& flags, int code) {
  if (!flags.on || code != kFileError) return;
  say("whit: in the sandbox a scene reads below its own folder only, and --allow PATH adds to that; pictures are "
      "written to "
      "the folder of --outfile, or to the current one");
}

}  // namespace whit
