// A file that appears complete or not at all: what killed processes left, and long names.
#include "core/image/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

class Atomic : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::temp_path(testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  /// A file that was last written to so many seconds ago.
  std::string put(const std::string& name, int age) const {
    std::ofstream(path(name)) << "left";
    const timespec when{std::time(nullptr) - age, 0}, times[2] = {when, when};
    EXPECT_EQ(::utimensat(AT_FDCWD, path(name).c_str(), times, 0), 0);
    return path(name);
  }

  std::string write(const std::string& name) const {
    AtomicFile file(path(name));
    file.write_at("text", 4, 0);
    return file.commit();
  }

  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.insert(entry.path().filename().string());
    return all;
  }

  std::string folder_;
};

TEST_F(Atomic, WhatAKilledProcessLeftIsRemovedByTheNextWriterToThatName) {
  put(".picture.123.0.tmp.exr", 3600);
  put(".picture.99999999.12.tmp.exr", 3600);
  // Of other pictures, of no process, and of the user.
  const std::set<std::string> others{".other.123.0.tmp.exr",   ".picture.123.tmp.exr",       ".picture.a.0.tmp.exr",
                                     ".picture.123.0.tmp.png", ".picture.123.0.tmp.exr.bak", "picture.123.0.tmp.exr"};
  for (const std::string& name : others) put(name, 3600);
  EXPECT_EQ(write("picture.exr"), "");
  std::set<std::string> left = others;
  left.insert("picture.exr");
  EXPECT_EQ(names(), left);
}

TEST_F(Atomic, WhatSomebodyStillWritesStays) {
  // One that is locked, however old; one so young that its writer may not have come to lock it.
  const std::string held = put(".picture.1.0.tmp.exr", 3600);
  put(".picture.2.0.tmp.exr", 1);
  const int fd = ::open(held.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(fd, LOCK_EX | LOCK_NB), 0);
  EXPECT_EQ(write("picture.exr"), "");
  EXPECT_EQ(names(), (std::set<std::string>{".picture.1.0.tmp.exr", ".picture.2.0.tmp.exr", "picture.exr"}));
  ::close(fd);
}

TEST_F(Atomic, NothingIsSeenUntilItIsComplete) {
  AtomicFile file(path("picture.exr"));
  file.write_at("text", 4, 0);
  for (const std::string& name : names()) EXPECT_EQ(name.front(), '.') << name;
  EXPECT_EQ(file.commit(), "");
  EXPECT_EQ(names(), std::set<std::string>{"picture.exr"});
}

TEST_F(Atomic, NamesMayBeAsLongAsTheFileSystemTakes) {
  // 255 bytes for names, in all that Linux has but few.
  for (const size_t length : {size_t{250}, size_t{255}}) {
    EXPECT_EQ(write(std::string(length - 4, 'a') + ".exr"), "") << length;
    EXPECT_EQ(write("a." + std::string(length - 2, 'b')), "") << length;
  }
  EXPECT_EQ(names().size(), 4u);
  EXPECT_EQ(write(std::string(256, 'a')), "File name too long");
  EXPECT_EQ(names().size(), 4u);
}

}  // namespace
}  // namespace whit
