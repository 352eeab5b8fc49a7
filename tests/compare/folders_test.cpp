#include "core/compare/folders.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>

#include "core/image/write.h"

namespace whit {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class Folders : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "whit-folders-XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    fs::create_directories(root_ / "a");
    fs::create_directories(root_ / "b");
  }
  void TearDown() override {
    for (const auto& entry : fs::directory_iterator(root_)) fs::permissions(entry, fs::perms::owner_all);
    fs::remove_all(root_);
  }

  std::string path(const std::string& name) const { return (root_ / name).string(); }
  /// Files with a text in them; parents are made.
  void touch(const std::string& name, const std::string& text = "") const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name, std::ios::binary) << (text.empty() ? name : text);
  }
  std::string text(const std::string& name) const {
    std::ifstream file(root_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// A picture of one value.
  void picture(const std::string& name, float value, int size = 8) const {
    const std::vector<float> rgb(static_cast<size_t>(size) * size * 3, value);
    fs::create_directories((root_ / name).parent_path());
    ASSERT_EQ(write_image(path(name), {.width = size, .height = size, .rgb = rgb}).error, "");
  }
  FolderPairs pairs() const {
    const Result<FolderPairs> found = pair_folders(path("a"), path("b"));
    EXPECT_EQ(found.error, "");
    return found.value;
  }

  fs::path root_;
};

TEST_F(Folders, ArePairedByRelativeNames) {
  for (const char* name : {"a/x.exr", "a/sub/deep/y.png", "a/sub/new.tif", "b/x.exr", "b/sub/deep/y.png", "b/y.png"})
    touch(name);
  const FolderPairs p = pairs();
  EXPECT_EQ(p.both, (Names{"sub/deep/y.png", "x.exr"}));
  EXPECT_EQ(p.missing, (Names{"y.png"}));
  EXPECT_EQ(p.extra, (Names{"sub/new.tif"}));
  EXPECT_TRUE(p.alike.empty());
}

TEST_F(Folders, HavePicturesAlone) {
  for (const char* name : {"notes.txt", "policy.json", "exr", "noending", ".hidden.exr", ".x.12.0.tmp.exr",
                           ".git/a.png", "a.exr.bak", "a.exr.Xa3fd2"})
    touch(std::string("a/") + name);
  fs::create_directories(root_ / "a/folder.exr");
  ASSERT_EQ(::mkfifo(path("a/pipe.exr").c_str(), 0600), 0);
  EXPECT_EQ(pairs().extra, Names{});
  for (const char* name : {"A.EXR", "a.Jpg", "a.jpeg", "a.tga", "a.tiff", "a.pfm", "a.hdr", "a.webp", "a.bmp"})
    touch(std::string("b/") + name);
  EXPECT_EQ(pairs().missing,
            (Names{"A.EXR", "a.Jpg", "a.bmp", "a.hdr", "a.jpeg", "a.pfm", "a.tga", "a.tiff", "a.webp"}));
}

TEST_F(Folders, NameWhatMayBeMeant) {
  for (const char* name : {"a/x.exr", "b/x.png", "a/sub/Y.exr", "b/sub/y.EXR", "a/other/z.exr", "b/z.exr"}) touch(name);
  const FolderPairs p = pairs();
  EXPECT_EQ(p.both, Names{});
  EXPECT_EQ(p.alike, (std::map<std::string, std::string>{{"x.png", "x.exr"}, {"sub/y.EXR", "sub/Y.exr"}}));
}

TEST_F(Folders, FollowLinksButNotInCircles) {
  touch("elsewhere/x.exr");
  touch("a/top.exr");
  fs::create_directory_symlink("../elsewhere", root_ / "a/linked");
  fs::create_directory_symlink("..", root_ / "elsewhere/up");  // to what has both, and so to itself again
  fs::create_directory_symlink(".", root_ / "a/self");
  fs::create_symlink("top.exr", root_ / "a/link.exr");
  fs::create_symlink("nowhere.exr", root_ / "a/broken.exr");
  fs::create_symlink("circle.exr", root_ / "a/circle.exr");
  const Names extra = pairs().extra;
  // Through linked/up there is the folder of the two, of which a and linked are left out as they are around it, and b as
  // the other side.
  EXPECT_EQ(extra, (Names{"broken.exr", "circle.exr", "link.exr", "linked/x.exr", "top.exr"}));
}

TEST_F(Folders, EndWhereLinksMultiply) {
  for (int i = 0; i < 12; ++i) {
    const fs::path folder = root_ / fmt::format("a/{}", i);
    fs::create_directories(folder);
    for (int k = 0; k < 12; ++k) fs::create_directory_symlink(fmt::format("../{}", k), folder / fmt::format("{}", k));
  }
  EXPECT_NE(pair_folders(path("a"), path("b")).error.find("symbolic links"), std::string::npos);
}

// whit diff out out/references
TEST_F(Folders, MayLieInEachOther) {
  touch("a/x.exr");
  touch("a/references/x.exr");
  const Result<FolderPairs> p = pair_folders(path("a"), path("a/references"));
  EXPECT_EQ(p.value.both, (Names{"x.exr"}));
  EXPECT_EQ(p.value.extra, Names{});
  const Result<FolderPairs> q = pair_folders(path("a/references"), path("a"));
  EXPECT_EQ(q.value.both, (Names{"x.exr"}));
  EXPECT_EQ(q.value.missing, Names{});
  EXPECT_EQ(pair_folders(path("a"), path("a")).value.both, (Names{"references/x.exr", "x.exr"}));
}

TEST_F(Folders, ThatCannotBeReadAreNamed) {
  touch("file.exr");
  EXPECT_NE(pair_folders(path("a"), path("none")).error.find("none\": No such file"), std::string::npos);
  EXPECT_NE(pair_folders(path("file.exr"), path("b")).error.find("it is not a folder"), std::string::npos);
  if (::geteuid() == 0) return;  // the superuser reads all
  fs::create_directories(root_ / "a/closed");
  fs::permissions(root_ / "a/closed", fs::perms::none);
  EXPECT_NE(pair_folders(path("a"), path("b")).error.find("closed\": Permission denied"), std::string::npos);
  fs::permissions(root_ / "a/closed", fs::perms::owner_all);
}

TEST_F(Folders, AreComparedInOrderWithAsManyAtOnceAsThreads) {
  Names names;
  for (int i = 0; i < 40; ++i) {
    names.push_back(fmt::format("{:02}.exr", i));
    picture("a/" + names.back(), i % 3 == 0 ? 0.75f : 0.5f, i % 5 == 0 ? 64 : 8);
    picture("b/" + names.back(), 0.5f, i == 7 ? 4 : i % 5 == 0 ? 64 : 8);
  }
  fs::remove(root_ / "b/11.exr");
  std::atomic<int> started = 0, ended = 0, at_once = 0;
  std::atomic<bool> busy = false;
  Names seen, bad;
  compare_folders(
      path("a"), path("b"), names,
      [&](const std::string& name) {
        at_once = std::max<int>(at_once, ++started - ended);
        CompareRequest request;
        request.limits.exact = name != "00.exr";  // 0.75 against 0.5 is beyond the defaults, too
        return request;
      },
      [&](const ComparedPair& pair) {
        EXPECT_FALSE(busy.exchange(true));
        seen.push_back(pair.name);
        if (!pair.comparison.same()) bad.push_back(pair.name);
        EXPECT_EQ(pair.comparison.a_path, path("a/" + pair.name));
        EXPECT_EQ(pair.comparison.cannot.empty(), pair.name != "07.exr" && pair.name != "11.exr") << pair.name;
        EXPECT_GT(pair.seconds, 0);
        ++ended;
        busy = false;
      });
  EXPECT_EQ(seen, names);
  EXPECT_EQ(bad, (Names{"00.exr", "03.exr", "06.exr", "07.exr", "09.exr", "11.exr", "12.exr", "15.exr", "18.exr",
                        "21.exr", "24.exr", "27.exr", "30.exr", "33.exr", "36.exr", "39.exr"}));
  EXPECT_LE(at_once, tbb::this_task_arena::max_concurrency());
}

TEST_F(Folders, NoPairsAreNoWork) {
  compare_folders(
      path("a"), path("b"), {}, [](const std::string&) { return CompareRequest(); },
      [](const ComparedPair&) { FAIL(); });
}

TEST_F(Folders, AFileIsReplacedWithItsPermissions) {
  touch("a/x.exr", "new");
  touch("b/x.exr", "older and longer");
  fs::permissions(root_ / "b/x.exr", fs::perms(0640));
  fs::permissions(root_ / "a/x.exr", fs::perms(0600));
  EXPECT_EQ(replace_with(path("a/x.exr"), path("b/x.exr")), "");
  EXPECT_EQ(text("b/x.exr"), "new");
  EXPECT_EQ(fs::status(root_ / "b/x.exr").permissions(), fs::perms(0640));
  EXPECT_EQ(text("a/x.exr"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "b"), {}), 1);
}

TEST_F(Folders, ReplacingFollowsALink) {
  touch("a/x.exr", "new");
  touch("stored/x.exr", "old");
  fs::create_symlink("../stored/x.exr", root_ / "b/x.exr");
  EXPECT_EQ(replace_with(path("a/x.exr"), path("b/x.exr")), "");
  EXPECT_TRUE(fs::is_symlink(root_ / "b/x.exr"));
  EXPECT_EQ(text("stored/x.exr"), "new");
}

// Other names of the same file, as of a store that shares equal files, keep what they have.
TEST_F(Folders, ReplacingLeavesOtherNamesAlone) {
  touch("a/x.exr", "new");
  touch("b/x.exr", "old");
  fs::create_hard_link(root_ / "b/x.exr", root_ / "b/y.exr");
  EXPECT_EQ(replace_with(path("a/x.exr"), path("b/x.exr")), "");
  EXPECT_EQ(text("b/x.exr"), "new");
  EXPECT_EQ(text("b/y.exr"), "old");
}

TEST_F(Folders, ReplacingWorksAcrossFileSystems) {
  std::string other = "/dev/shm/whit-folders-XXXXXX";
  if (!fs::is_directory("/dev/shm") || ::mkdtemp(other.data()) == nullptr) GTEST_SKIP() << "no /dev/shm";
  std::ofstream(other + "/x.exr") << "old";
  touch("a/x.exr", "new");
  EXPECT_EQ(replace_with(path("a/x.exr"), other + "/x.exr"), "");
  std::ifstream file(other + "/x.exr");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "new");
  fs::remove_all(other);
}

TEST_F(Folders, WhatCannotBeReplacedStays) {
  touch("a/x.exr", "new");
  touch("b/x.exr", "old");
  EXPECT_NE(replace_with(path("a/none.exr"), path("b/x.exr")).find("cannot be read"), std::string::npos);
  EXPECT_NE(replace_with(path("a"), path("b/x.exr")), "");
  EXPECT_NE(replace_with(path("a/x.exr"), path("b")), "");
  EXPECT_NE(replace_with(path("a/x.exr"), path("b/none.exr")), "");
  EXPECT_FALSE(fs::exists(root_ / "b/none.exr"));
  fs::permissions(root_ / "b/x.exr", fs::perms(0444));
  EXPECT_EQ(replace_with(path("a/x.exr"), path("b/x.exr")), "it is write-protected");
  EXPECT_EQ(text("b/x.exr"), "old");
}

}  // namespace
}  // namespace whit
