// A folder of the test process's own, for the files its tests write.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace whit::test {

/// The path of a new, empty folder, without a slash at its end; the same one for the whole process, and removed when it
/// ends. ctest runs the tests of one program as processes side by side, so a fixed name in /tmp would be shared.
inline const std::string& temp_folder() {
  struct Folder {
    Folder() : path(testing::TempDir() + "/whit_test_XXXXXX") { made = mkdtemp(path.data()) != nullptr; }
    ~Folder() {
      std::error_code ignored;
      if (made) std::filesystem::remove_all(path, ignored);
    }
    std::string path;
    bool made = false;
  };
  static const Folder folder;
  EXPECT_TRUE(folder.made) << "cannot make " << folder.path;
  return folder.path;
}

/// The path of a file there.
inline std::string temp_path(const std::string& name) { return temp_folder() + "/" + name; }

/// Writes a file there; returns its path.
inline std::string write_temp(const std::string& name, const std::string& bytes) {
  std::ofstream(temp_path(name), std::ios::binary) << bytes;
  return temp_path(name);
}

}  // namespace whit::test
