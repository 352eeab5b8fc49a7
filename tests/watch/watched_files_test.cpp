// Files that change are told of, by inotify and without.
#include "core/watch/watched_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

using Names = std::vector<std::string>;

void put(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// What was written in the tick of a mark counts as changed since.
void pass_a_tick() { std::this_thread::sleep_for(std::chrono::milliseconds(30)); }

/// Of each test its own.
class Folder {
 public:
  Folder() : path_(test::temp_path(testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::replace(path_.begin() + static_cast<long>(test::temp_folder().size()) + 1, path_.end(), '/', '-');
    std::filesystem::create_directory(path_);
  }
  std::string path(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

class Watched : public testing::TestWithParam<bool> {
 protected:
  FileWatch::Options options() const {
    return {.quiet_ms = 5, .look_ms = 60'000, .poll_ms = 20, .inotify = GetParam()};
  }
  /// Waits as long as it may take on a busy machine.
  static Names wait(FileWatch& watch) { return watch.wait(20'000); }
  Folder folder;
};

TEST_P(Watched, ChangesReplacementsAndFilesThatComeAndGo) {
  const std::string a = folder.path("a"), b = folder.path("b");
  put(a, "1");
  pass_a_tick();
  FileWatch watch(options());
  watch.watch({a, b}, FileWatch::now_mark());
  EXPECT_EQ(watch.wait(0), Names{});
  put(a, "longer");
  EXPECT_EQ(wait(watch), Names{a});
  put(folder.path("c"), "in the place of a");
  std::filesystem::rename(folder.path("c"), a);
  EXPECT_EQ(wait(watch), Names{a});
  put(b, "there now");
  EXPECT_EQ(wait(watch), Names{b});
  std::filesystem::remove(a);
  EXPECT_EQ(wait(watch), Names{a});
}

TEST_P(Watched, OtherFilesAreNobodysBusiness) {
  const std::string a = folder.path("a");
  put(a, "1");
  pass_a_tick();
  FileWatch watch(options());
  watch.watch({a}, FileWatch::now_mark());
  put(folder.path("other"), "1");
  EXPECT_EQ(watch.wait(150), Names{});
}

TEST_P(Watched, WhatALinkStandsForCounts) {
  std::filesystem::create_directory(folder.path("far"));
  const std::string real = folder.path("far/real"), link = folder.path("link");
  put(real, "1");
  std::filesystem::create_symlink(real, link);
  FileWatch watch(options());
  watch.watch({link}, FileWatch::now_mark());
  put(real, "longer");
  EXPECT_EQ(wait(watch), Names{link});
}

TEST_P(Watched, AChangeWhileItWasReadIsOne) {
  const std::string a = folder.path("a");
  put(a, "1");
  const long long began = FileWatch::now_mark();
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  put(a, "2");
  FileWatch watch(options());
  watch.watch({a}, began);
  EXPECT_EQ(wait(watch), Names{a});
  EXPECT_EQ(watch.wait(0), Names{});
}

TEST_P(Watched, WakesUp) {
  FileWatch watch(options());
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    watch.wake();
  });
  EXPECT_EQ(wait(watch), Names{});
  other.join();
}

INSTANTIATE_TEST_SUITE_P(Ways, Watched, testing::Bool(),
                         [](const auto& way) { return way.param ? "inotify" : "looking"; });

}  // namespace
}  // namespace whit
