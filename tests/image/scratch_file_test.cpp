// Texels in a file: they come back as they were, also after their memory has gone, and no folder is no disaster.
#include "core/image/scratch_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <string>

namespace whit {
namespace {

std::vector<std::byte> bytes(size_t n, int seed) {
  std::vector<std::byte> out(n);
  for (size_t i = 0; i < n; ++i) out[i] = static_cast<std::byte>(i * 7 + static_cast<size_t>(seed));
  return out;
}

TEST(ScratchFile, pieces_come_back_at_their_places_as_often_as_they_are_given_back) {
  ScratchFile file;
  // A page is 4096 bytes; pieces that end at, before and behind its end.
  std::vector<std::shared_ptr<const TexelBlock>> blocks;
  const std::array<size_t, 5> sizes{1, 64, 4096, 5000, 300000};
  for (size_t i = 0; i < sizes.size(); ++i) {
    const auto first = bytes(sizes[i], int(i)), second = bytes(100, int(i) + 50);
    blocks.push_back(file.write({first, second}));
    ASSERT_NE(blocks.back(), nullptr);
  }
  for (int round = 0; round < 3; ++round)
    for (size_t i = 0; i < sizes.size(); ++i) {
      const auto first = bytes(sizes[i], int(i)), second = bytes(100, int(i) + 50);
      const size_t at = (sizes[i] + 63) / 64 * 64;
      EXPECT_TRUE(std::equal(first.begin(), first.end(), blocks[i]->as<std::byte>())) << sizes[i];
      EXPECT_TRUE(std::equal(second.begin(), second.end(), blocks[i]->as<std::byte>(at))) << sizes[i];
      // A lookup may read a few bytes on.
      volatile const std::byte beyond = *blocks[i]->as<std::byte>(blocks[i]->size() + 7);
      static_cast<void>(beyond);
      blocks[i]->give_back();
    }
}

TEST(ScratchFile, room_keeps_what_is_written_to_it_also_when_memory_is_given_back) {
  ScratchFile file;
  const auto room = file.room(1000000), other = file.room(5000);
  ASSERT_NE(room, nullptr);
  const auto some = bytes(1000000, 3), few = bytes(5000, 4);
  std::copy(some.begin(), some.end(), room->as<std::byte>());
  room->give_back();
  std::copy(few.begin(), few.end(), other->as<std::byte>());
  EXPECT_TRUE(std::equal(some.begin(), some.end(), room->as<std::byte>()));
  EXPECT_TRUE(std::equal(few.begin(), few.end(), other->as<std::byte>()));
  // No disk has room for an exbibyte.
  EXPECT_EQ(file.room(size_t{1} << 60), nullptr);
}

TEST(ScratchFile, without_a_folder_there_is_none) {
  const char* const old = std::getenv("TMPDIR");
  const std::string before = old ? old : "";
  setenv("TMPDIR", "/nowhere/at/all", 1);
  ScratchFile file;
  const auto some = bytes(100, 1);
  EXPECT_EQ(file.write({some}), nullptr);
  EXPECT_EQ(file.write({some}), nullptr);
  EXPECT_EQ(file.room(100), nullptr);
  if (old) setenv("TMPDIR", before.c_str(), 1);
  else unsetenv("TMPDIR");
}

}  // namespace
}  // namespace whit
