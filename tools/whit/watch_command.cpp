// `whit watch`: a scene on a page, or in the terminal, while it is written.

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "core/watch/preview.h"
#include "core/watch/watch_server.h"
#include "tools/whit/command_line.h"
#include "tools/whit/effect_flags.h"
#include "tools/whit/memory_flags.h"
#include "tools/whit/model_flags.h"
#include "tools/whit/sandbox.h"
#include "tools/whit/terminal.h"
#include "tools/whit/watch_terminal.h"

extern char** environ;

namespace whit {
namespace {

struct WatchFlags {
  std::string scene, reference, view, ocio, graphics = "auto";
  int port = 0, spp = 0, threads = 0;
  double texture_memory = 1024;
  bool open = false, terminal = false, quick = false;
  EffectFlags effects;
  ModelFlags model;
  SandboxFlags sandbox;
  MemoryFlags memory;
};

bool read_flags(const Arguments& given, WatchFlags& flags, int& code) {
  CommandLine command{
      "whit watch",
      "Shows a scene on a page of the browser while it is written: rendered again whenever one of its files is saved, "
      "coarse at first and finer while nothing happens. Prints the page's address, which is of this machine alone and "
      "holds a secret. Ctrl-C ends it.",
      {{"scene", &flags.scene, "A scene file or a glTF model", {.required = true}},
       {"--port", &flags.port, "Of 127.0.0.1; without it one that is free", {.least = 1, .most = 65535}},
       {"--open", &flags.open, "Open the page in the browser"},
       {"--reference", &flags.reference, "A picture to blink with and to compare with"},
       {"--terminal", &flags.terminal, "No page: draw in the terminal. --terminal=sixel and so on, as --graphics"},
       {"--graphics",
        &flags.graphics,
        "How the terminal draws: half blocks with colours, kitty's protocol, sixels, or what it is known to do",
        {.choices = {"auto", "blocks", "kitty", "sixel"}}},
       {"--spp", &flags.spp, "Samples per pixel, instead of the scene's", {.least = 1, .most = 1 << 20}},
       {"--threads,-j", &flags.threads, "Threads, 0 for one per core", {.least = 0, .most = 4096}},
       {"--quick", &flags.quick, "A quarter of the resolution, one sample"},
       {"--view", &flags.view, "Of the terminal's picture, and what the page shows at first; as for 'whit render'"},
       {"--ocio", &flags.ocio, "An OpenColorIO configuration"},
       {"--texture-memory", &flags.texture_memory, "MiB for textures", {.least = 1, .most = 1e9}},
       memory_flag(flags.memory)}};
  add_effect_flags(command, flags.effects);
  add_model_flags(command, flags.model);
  add_sandbox_flags(command, flags.sandbox);
  Arguments args;
  for (const std::string& arg : given) {
    const bool kind = arg.rfind("--terminal=", 0) == 0;
    args.push_back(kind ? "--graphics=" + arg.substr(11) : arg);
    flags.terminal |= kind;
  }
  return parse_arguments(command, args, code);
}

std::string problem_of(const WatchFlags& flags) {
  if (flags.scene == "-") return "standard input cannot be watched; name a file";
  if (std::string problem = usage_problem(flags.effects); !problem.empty()) return problem;
  if (std::string problem = usage_problem(flags.model); !problem.empty()) return problem;
  if (flags.sandbox.on && flags.open)
    return "--open starts a browser, which --sandbox forbids; open the address yourself";
  if (std::string problem = usage_problem(flags.sandbox); !problem.empty()) return problem;
  if (std::string problem = usage_problem(flags.memory); !problem.empty()) return problem;
  return usage_problem(flags.model, flags.scene);
}

PreviewRequest request_of(const WatchFlags& flags) {
  PreviewRequest request;
  request.path = flags.scene;
  request.read = read_options(flags.model);
  request.overrides = flags.effects.overrides;
  request.off = plan_options(flags.effects).off;
  request.build.samples_per_pixel = flags.spp;
  request.build.quick = flags.quick;
  request.threads = flags.threads;
  request.texture_bytes = static_cast<size_t>(flags.texture_memory * 1024 * 1024);
  request.measure = !flags.terminal;
  return request;
}

/// SIGINT, SIGTERM and SIGHUP are for wait() and come(), in all threads that begin while this is there. After the first a
/// second one ends the program at once: a large scene that is being built is not left in the middle.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&set_);
    for (const int s : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set_, s);
    pthread_sigmask(SIG_BLOCK, &set_, &before_);
    // A page that is closed while it is answered is no reason to end.
    std::signal(SIGPIPE, SIG_IGN);
  }
  ~EndSignals() { restore(); }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  void wait() const {
    int which = 0;
    sigwait(&set_, &which);
    restore();
  }
  /// Whether one has come.
  bool come() const {
    const timespec now{0, 0};
    if (sigtimedwait(&set_, nullptr, &now) <= 0) return false;
    restore();
    return true;
  }

 private:
  void restore() const { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  sigset_t set_{}, before_{};
};

/// In a process group of its own, which Ctrl-C here does not end, and with signals as any program expects them.
void open_browser(const std::string& address) {
  std::string program = "xdg-open", page = address;
  std::array<char*, 3> args{program.data(), page.data(), nullptr};
  pid_t child = 0;
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&quiet, STDOUT_FILENO, STDERR_FILENO);
  sigset_t none, plain;
  sigemptyset(&none);
  sigemptyset(&plain);
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) sigaddset(&plain, s);
  posix_spawnattr_t as_usual;
  posix_spawnattr_init(&as_usual);
  posix_spawnattr_setsigmask(&as_usual, &none);
  posix_spawnattr_setsigdefault(&as_usual, &plain);
  posix_spawnattr_setpgroup(&as_usual, 0);
  posix_spawnattr_setflags(&as_usual, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  if (posix_spawnp(&child, program.c_str(), &quiet, &as_usual, args.data(), environ) != 0)
    say("whit watch: there is no xdg-open; open the address yourself");
  else std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
  posix_spawnattr_destroy(&as_usual);
  posix_spawn_file_actions_destroy(&quiet);
}

/// Ends the preview, or the program: a large scene that is being built cannot be stopped in the middle, and nothing of it is
/// kept.
int ended(Preview& preview, int code) {
  constexpr int kMoment = 300;
  if (preview.end(kMoment)) return code;
  std::fflush(nullptr);
  ::_exit(code);
}

}  // namespace

int watch_command(const Arguments& args) {
  WatchFlags flags;
  int code = kDone;
  if (!read_flags(args, flags, code)) return code;
  if (const std::string problem = problem_of(flags); !problem.empty()) {
    say("whit watch: " + problem);
    return kUsage;
  }
  std::error_code failed;
  if (!std::filesystem::exists(flags.scene, failed)) {
    say(fmt::format("whit watch: cannot open {}: there is no such file", flags.scene));
    return kFileError;
  }
  // What is seen is written to the scene's own file, when somebody asks for it.
  const SandboxRequest files{
      {folder_to_read(flags.scene), flags.reference, flags.ocio}, {flags.scene}, !flags.terminal};
  if (const std::string problem = enter_sandbox(flags.sandbox, files); !problem.empty()) {
    say("whit watch: " + problem);
    return kFileError;
  }
  set_memory_limit(flags.memory);
  const EndSignals signals;
  Preview preview(request_of(flags));
  if (flags.terminal) {
    const WatchTerminal terminal{flags.graphics, flags.view, flags.ocio, [&signals] { return signals.come(); }};
    return ended(preview, watch_in_terminal(preview, terminal));
  }
  WatchServer server(preview, {flags.port, flags.reference, flags.view, flags.ocio});
  if (const std::string problem = server.listen(); !problem.empty()) {
    say("whit watch: " + problem);
    return kFileError;
  }
  fmt::print("{}\n", server.address());
  std::fflush(stdout);
  say(fmt::format("watching {}; Ctrl-C ends it", flags.scene));
  if (flags.open) open_browser(server.address());
  signals.wait();
  server.stop();
  return ended(preview, kDone);
}

}  // namespace whit
