// What the kernel says in a sandbox: every answer here is errno, of calls that whit has no part in.
#include "tools/whit/sandbox.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/landlock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// errno of opening a file, 0 where it opens.
int opening(const std::string& path, int flags = O_RDONLY) {
  const int fd = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (fd < 0) return errno;
  ::close(fd);
  return 0;
}

int failure_of(long result) { return result < 0 ? errno : 0; }

class Sandbox : public testing::Test {
 protected:
  void SetUp() override {
    if (::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) < 1)
      GTEST_SKIP() << "this kernel has no Landlock";
    root_ = test::temp_path(testing::UnitTest::GetInstance()->current_test_info()->name());
    for (const char* folder : {"scene/sub", "out", "other"}) fs::create_directories(path(folder));
    for (const char* file : {"scene/scene.pbrt", "scene/sub/a.ply", "other/b.ply"}) std::ofstream(path(file)) << "text";
    fs::create_symlink("/etc/passwd", path("scene/link"));
    fs::create_symlink(path("scene/sub/a.ply"), path("scene/inner"));
  }
  void TearDown() override {
    if (!root_.empty()) fs::remove_all(root_);
  }

  std::string path(const std::string& name) const { return root_ + "/" + name; }

  /// What a call answers in a process that is in the sandbox, -1 where it could not be entered.
  int answer(const std::function<int()>& call, bool serves = false, const std::vector<std::string>& allow = {}) const {
    const pid_t child = ::fork();
    if (child == 0) {
      SandboxRequest request{{folder_to_read(path("scene/scene.pbrt"))}, {path("out/picture.exr")}};
      request.serves = serves;
      const std::string problem = enter_sandbox({true, allow}, request);
      if (!problem.empty()) ::perror(problem.c_str());
      ::_exit(problem.empty() ? call() : 255);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) != 255 ? WEXITSTATUS(status) : -1;
  }

  std::string root_;
};

TEST_F(Sandbox, ReadsBelowTheScenesFolder) {
  EXPECT_EQ(answer([&] { return opening(path("scene/scene.pbrt")); }), 0);
  EXPECT_EQ(answer([&] { return opening(path("scene/sub/a.ply")); }), 0);
  EXPECT_EQ(answer([&] { return opening(path("scene/inner")); }), 0);
  EXPECT_EQ(answer([&] { return opening("/etc/passwd"); }), EACCES);
  EXPECT_EQ(answer([&] { return opening(path("scene/link")); }), EACCES);
  EXPECT_EQ(answer([&] { return opening(path("scene/../other/b.ply")); }), EACCES);
  EXPECT_EQ(answer([&] { return opening(path("other/b.ply")); }), EACCES);
  EXPECT_EQ(answer([&] { return opening(path("other/b.ply")); }, false, {path("other")}), 0);
  EXPECT_EQ(answer([&] { return opening(path("other/b.ply")); }, false, {path("other/b.ply")}), 0);
  // The same without it, so that it is the sandbox that says no.
  EXPECT_EQ(opening("/etc/passwd"), 0);
  EXPECT_EQ(opening(path("scene/link")), 0);
}

TEST_F(Sandbox, WritesToTheOutputsFolder) {
  constexpr int kNew = O_WRONLY | O_CREAT;
  EXPECT_EQ(answer([&] { return opening(path("out/picture.exr"), kNew); }), 0);
  EXPECT_EQ(answer([&] { return failure_of(::rename(path("out/picture.exr").c_str(), path("out/b.exr").c_str())); }),
            0);
  EXPECT_EQ(answer([&] { return opening(path("other/picture.exr"), kNew); }), EACCES);
  EXPECT_EQ(answer([&] { return opening(path("scene/scene.pbrt"), O_WRONLY); }), EACCES);
  EXPECT_EQ(answer([&] { return opening("/tmp/picture.exr", kNew); }), EACCES);
  EXPECT_EQ(answer([&] { return failure_of(::unlink(path("scene/inner").c_str())); }), EACCES);
  EXPECT_EQ(answer([&] { return failure_of(::symlink("/etc/passwd", path("out/link").c_str())); }), EPERM);
}

TEST_F(Sandbox, CallsNobody) {
  const auto socket_of = [](int family, int type) { return failure_of(::socket(family, type, 0)); };
  EXPECT_EQ(answer([&] { return socket_of(AF_INET, SOCK_STREAM); }), EPERM);
  EXPECT_EQ(answer([&] { return socket_of(AF_UNIX, SOCK_STREAM); }), EPERM);
  const auto run_true = [] {
    char program[] = "/bin/true";
    char* const arguments[] = {program, nullptr};
    return failure_of(::execv(program, arguments));
  };
  EXPECT_EQ(answer(run_true), EPERM);
  EXPECT_EQ(answer(run_true, true), EPERM);
  // A server may open its port, but call nobody: not even by a packet.
  EXPECT_EQ(answer([&] { return socket_of(AF_INET, SOCK_STREAM); }, true), 0);
  sockaddr_in someone = {};
  someone.sin_family = AF_INET, someone.sin_port = htons(9), someone.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* address = reinterpret_cast<const sockaddr*>(&someone);
  EXPECT_EQ(
      answer([&] { return failure_of(::connect(::socket(AF_INET, SOCK_STREAM, 0), address, sizeof someone)); }, true),
      EPERM);
  EXPECT_EQ(answer(
                [&] {
                  const int udp = ::socket(AF_INET, SOCK_DGRAM, 0);
                  return failure_of(::sendto(udp, "x", 1, 0, address, sizeof someone));
                },
                true),
            EPERM);
}

TEST_F(Sandbox, HoldsForThreadsThatBeginThere) {
  EXPECT_EQ(answer([] {
              int found = 0;
              std::thread([&] { found = opening("/etc/passwd"); }).join();
              return found;
            }),
            EACCES);
}

TEST_F(Sandbox, IsRefusedWhereThreadsAreOutside) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::thread other([] { ::pause(); });
    ::_exit(enter_sandbox({true, {}}, {}).find("threads already") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(Sandbox, IsNoneWhereNobodyAsks) { EXPECT_EQ(enter_sandbox({}, {}), ""); }

}  // namespace
}  // namespace whit
