// Names of files as URIs have them, and one name for each file.
#include "core/base/file_names.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

TEST(FileNames, GoToUrisAndBack) {
  // RFC 3986: a space is 0x20, a percent sign 0x25, and an umlaut the two bytes of its UTF-8.
  EXPECT_EQ(percent_encoded("/a b/100%/\xc3\xa4-._~.pbrt"), "/a%20b/100%25/%C3%A4-._~.pbrt");
  std::string every;
  for (int c = 0; c < 256; ++c) every += static_cast<char>(c);
  EXPECT_EQ(percent_decoded(percent_encoded(every)), every);
  // Small digits too; and what is no escape stays.
  EXPECT_EQ(percent_decoded("%c3%A4 %2 %zz %"), "\xc3\xa4 %2 %zz %");
}

TEST(FileNames, OneForEachFile) {
  const std::string folder = test::temp_folder() + "/file names";
  std::filesystem::create_directories(folder + "/far");
  std::filesystem::create_directory_symlink(folder + "/far", folder + "/link");
  const std::string name = std::filesystem::canonical(folder).string() + "/far/none yet";
  EXPECT_EQ(canonical_path(folder + "/link/../far/./none yet"), name);
  EXPECT_EQ(canonical_path(folder + "/link/none yet"), name);
}

}  // namespace
}  // namespace whit
