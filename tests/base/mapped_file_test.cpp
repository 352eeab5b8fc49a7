// Files that change while they are read: what is there is told from what is not, and nobody is killed.
#include "core/base/mapped_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <numeric>
#include <thread>
#include <vector>

#include "core/base/limits.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// More than one page of any machine, and more than what is copied.
constexpr size_t kLarge = 4 * MappedFile::kCopied;

/// A file that was last written to long ago: whatever is done to it now changes its time, on clocks of any fineness.
std::string old_file(const std::string& name, size_t bytes) {
  const std::string path = test::write_temp(name, std::string(bytes, 'x'));
  fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(1));
  return path;
}

size_t count_x(std::string_view bytes) { return static_cast<size_t>(std::count(bytes.begin(), bytes.end(), 'x')); }

void overwrite(const std::string& path, const std::string& bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(::pwrite(file, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  ::close(file);
}

TEST(MappedFile, UnchangedIsNoProblem) {
  for (const size_t bytes : {size_t{0}, size_t{1}, MappedFile::kCopied, MappedFile::kCopied + 1, kLarge}) {
    const MappedFile file(old_file("same", bytes));
    EXPECT_EQ(file.error(), "");
    EXPECT_EQ(count_x(file.bytes()), bytes);
    file.release(0, bytes);
    EXPECT_EQ(count_x(file.bytes()), bytes);
    EXPECT_EQ(file.problem(), "");
  }
}

TEST(MappedFile, ShortenedBetweenOpeningAndReading) {
  const std::string path = old_file("short", kLarge);
  const MappedFile file(path);
  fs::resize_file(path, kLarge / 4);
  // Before the handler, SIGBUS. What is there is still there; the rest are zeros.
  EXPECT_EQ(file.bytes().size(), kLarge);
  EXPECT_EQ(count_x(file.bytes()), kLarge / 4);
  EXPECT_EQ(file.problem(), kChangedWhileRead);
}

TEST(MappedFile, LengthenedAgainIsAProblemStill) {
  const std::string path = old_file("again", kLarge);
  const auto before = fs::last_write_time(path);
  const MappedFile file(path);
  fs::resize_file(path, 0);
  EXPECT_EQ(count_x(file.bytes()), 0u);
  test::write_temp("again", std::string(kLarge, 'x'));
  fs::last_write_time(path, before);
  // Size and time are what they were, and pages were lost all the same.
  EXPECT_NE(file.problem(), "");
}

TEST(MappedFile, OverwrittenGrownAndRemoved) {
  const std::string path = old_file("changing", kLarge);
  {
    const MappedFile file(path);
    overwrite(path, "y");
    EXPECT_EQ(file.problem(), kChangedWhileRead) << "overwritten, of the same size";
  }
  {
    const MappedFile file(old_file("changing", kLarge));
    fs::resize_file(path, kLarge + 1);
    EXPECT_EQ(file.problem(), kChangedWhileRead) << "grown";
  }
  {
    // The old file stays, for whoever has it, when another one is put in its place or its name goes.
    const MappedFile file(old_file("changing", kLarge));
    fs::rename(old_file("new", 10), path);
    EXPECT_EQ(file.problem(), "") << "replaced";
    fs::remove(path);
    EXPECT_EQ(count_x(file.bytes()), kLarge);
    EXPECT_EQ(file.problem(), "") << "removed";
  }
}

TEST(MappedFile, OfACopyNothingChanges) {
  const std::string path = old_file("copied", 1000);
  const MappedFile small(path), large(old_file("copied_large", kLarge), kLarge);
  fs::resize_file(path, 0);
  fs::resize_file(test::temp_path("copied_large"), 0);
  EXPECT_EQ(count_x(small.bytes()), 1000u);
  EXPECT_EQ(count_x(large.bytes()), kLarge);
  EXPECT_EQ(small.problem() + large.problem(), "");
}

TEST(MappedFile, ManyThreadsReadManyShortenedFiles) {
  constexpr int kFiles = 8, kThreads = 4;
  std::vector<std::string> paths;
  std::vector<std::unique_ptr<MappedFile>> files;
  for (int i = 0; i < kFiles; ++i) {
    paths.push_back(old_file("many" + std::to_string(i), kLarge));
    files.push_back(std::make_unique<MappedFile>(paths.back()));
  }
  std::vector<std::thread> threads;
  std::vector<size_t> counted(kThreads);
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (const auto& file : files) counted[static_cast<size_t>(t)] += count_x(file->bytes());
      // Others come and go meanwhile, at addresses that were others' before.
      for (int i = 0; i < 100; ++i) count_x(MappedFile(test::temp_path("many0")).bytes());
    });
  }
  for (const std::string& path : paths) fs::resize_file(path, 0);
  for (std::thread& thread : threads) thread.join();
  for (const auto& file : files) {
    EXPECT_EQ(count_x(file->bytes()), 0u);
    EXPECT_EQ(file->problem(), kChangedWhileRead);
  }
  for (const size_t n : counted) EXPECT_LE(n, kFiles * kLarge);
}

TEST(MappedFile, MoreFilesThanAreWatchedAreCopied) {
  const std::string path = old_file("crowd", MappedFile::kCopied + 1);
  std::vector<std::unique_ptr<MappedFile>> files;
  for (size_t i = 0; i <= LostPages::kMost; ++i) files.push_back(std::make_unique<MappedFile>(path));
  fs::resize_file(path, 0);
  // The last is a copy: whatever happens, it has what it had.
  EXPECT_EQ(count_x(files.back()->bytes()), MappedFile::kCopied + 1);
  EXPECT_EQ(files.back()->problem(), "");
  EXPECT_EQ(count_x(files.front()->bytes()), 0u);
  EXPECT_NE(files.front()->problem(), "");
}

// What is not in a mapping of ours ends the program, as it did before.
TEST(LostPagesDeathTest, OthersAreNotSaved) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const std::string path = old_file("foreign", kLarge), ours = old_file("ours", kLarge);
  EXPECT_DEATH(
      {
        const MappedFile installs(ours);
        const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
        const auto* pages = static_cast<const char*>(::mmap(nullptr, kLarge, PROT_READ, MAP_PRIVATE, file, 0));
        fs::resize_file(path, 0);
        ::_exit(pages[0] == 'x' ? 1 : 0);
      },
      "");
}

TEST(MappedFile, WhatIsNoRegularFileIsNotWaitedFor) {
  const std::string pipe = test::temp_path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero")}) {
    EXPECT_EQ(MappedFile(path).error(), kNotRegular);
    EXPECT_EQ(why_unreadable(path), kNotRegular);
  }
  EXPECT_EQ(MappedFile(test::temp_folder()).error(), "Is a directory");
  EXPECT_EQ(why_unreadable(test::temp_folder()), "Is a directory");
  EXPECT_EQ(why_unreadable(test::temp_path("none")), "No such file or directory");
  EXPECT_EQ(why_unreadable(test::write_temp("some", "x")), "");
}

TEST(ReadFile, AsFarAsTheLimit) {
  constexpr Limit kTen{"ten", 10};
  std::string problem;
  EXPECT_EQ(read_file(test::write_temp("ten", "0123456789"), kTen, problem), "0123456789");
  EXPECT_EQ(problem, "");
  EXPECT_EQ(read_file(test::write_temp("eleven", "0123456789a"), kTen, problem), std::nullopt);
  EXPECT_EQ(problem, "it has more than 10 bytes, the limit ten");
  // Five gigabytes of nothing: refused before anything of it is read.
  fs::resize_file(test::temp_path("eleven"), uintmax_t{5} << 30);
  EXPECT_EQ(read_file(test::temp_path("eleven"), kSpectrumBytes, problem), std::nullopt);
  EXPECT_EQ(problem, "it has more than 67108864 bytes, the limit spectrum-bytes");
  EXPECT_EQ(read_file("/dev/zero", kTen, problem), std::nullopt);
  EXPECT_EQ(problem, kNotRegular);
}

}  // namespace
}  // namespace whit
