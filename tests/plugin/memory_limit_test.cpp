// How much memory a process may have, by files as the system has them, and what is said where it is not enough.
#include "core/plugin/memory_limit.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

class Cgroups : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(root); }
  void TearDown() override { std::filesystem::remove_all(root); }
  void put(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = root + path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text << "\n";
  }
  const std::string root = test::temp_folder() + "/whit_cgroups";
};

TEST_F(Cgroups, version_2_has_the_least_of_all_on_the_way) {
  put("/a/b/memory.max", "max");
  put("/a/memory.max", "5000000");
  EXPECT_EQ(cgroup_memory_limit("0::/a/b\n", root), 5000000u);
  EXPECT_EQ(cgroup_memory_limit("0::/c\n", root), UINT64_MAX);
  put("/memory.max", "4000000");  // of a container that shows its own as the root
  EXPECT_EQ(cgroup_memory_limit("0::/a/b\n", root), 4000000u);
  EXPECT_EQ(cgroup_memory_limit("0::/\n", root), 4000000u);
}

TEST_F(Cgroups, version_1_has_a_folder_for_each_controller) {
  put("/memory/docker/x/memory.limit_in_bytes", "3000000");
  put("/memory/memory.limit_in_bytes", "9223372036854771712");
  put("/cpu/docker/x/memory.limit_in_bytes", "1");
  const std::string cgroups = "5:cpu:/docker/x\n4:memory:/docker/x\n0::/\n";
  EXPECT_EQ(cgroup_memory_limit(cgroups, root), 3000000u);
  EXPECT_EQ(cgroup_memory_limit("4:hugetlb,memory:/docker/x\n", root), 3000000u);
  // Where its folder is not to be seen, that of the root counts.
  EXPECT_EQ(cgroup_memory_limit("4:memory:/elsewhere\n", root), 9223372036854771712u);
}

TEST_F(Cgroups, what_is_no_limit_is_none) {
  EXPECT_EQ(cgroup_memory_limit("", root), UINT64_MAX);
  EXPECT_EQ(cgroup_memory_limit("nonsense\n:\n::\n", root), UINT64_MAX);
  EXPECT_EQ(cgroup_memory_limit("0::/a\n", "/nowhere/at/all"), UINT64_MAX);
}

TEST(MemoryLimit, is_nine_tenths_of_the_machine_unless_set) {
  const uint64_t machine = memory_of_machine();
  EXPECT_GT(machine, uint64_t{64} << 20);
  EXPECT_EQ(memory_limit(), machine / 10 * 9);
}

TEST(MemoryLimit, what_is_too_much_is_refused_before_it_is_taken_with_the_figures) {
  const uint64_t before = memory_limit();
  set_memory_limit(uint64_t{2} << 30);
  EXPECT_NO_THROW(need_memory(uint64_t{1} << 30, "this"));
  try {
    need_memory(uint64_t{3} << 30, "this");
    FAIL();
  } catch (const std::bad_alloc& e) {
    const std::string text = e.what();
    EXPECT_EQ(text.rfind("this takes 3072 MiB of memory; of 2048 MiB at most (--max-memory) ", 0), 0u) << text;
  }
  set_memory_limit(1);  // Few bytes are let through, whatever there is: asking costs more than they do.
  EXPECT_NO_THROW(need_memory(uint64_t{1} << 20, "this"));
  set_memory_limit(before);
}

TEST(MemoryLimit, knows_what_is_resident_and_was_at_most) {
  const uint64_t before = resident_memory();
  {
    const std::vector<char> much(size_t{100} << 20, 1);
    EXPECT_GT(resident_memory(), before + (uint64_t{90} << 20));
  }
  EXPECT_GE(peak_memory(), before + (uint64_t{90} << 20));
}

TEST(MemoryLimit, sizes_as_messages_have_them) {
  EXPECT_EQ(bytes_text(2048), "2 KiB");
  EXPECT_EQ(bytes_text(812.0 * 1024 * 1024), "812 MiB");
  EXPECT_EQ(bytes_text(24.1 * 1024 * 1024 * 1024), "24.1 GiB");
}

}  // namespace
}  // namespace whit
