#include "core/image/data_address.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/image/image.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

std::vector<unsigned char> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

// The vectors of RFC 4648, section 10.
TEST(DataAddress, SpellsBytes) {
  EXPECT_EQ(base64(bytes_of("")), "");
  EXPECT_EQ(base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes_of("foobar")), "Zm9vYmFy");
}

// Python's zlib inflates it, and checks the sum at its end. Larger than the pieces that it is made in.
TEST(DataAddress, DeflatesAsZlibHasIt) {
  std::vector<unsigned char> bytes;
  for (unsigned i = 0; i < 3'000'001; ++i) bytes.push_back(static_cast<unsigned char>(i * i >> 7 & (i >> 12)));
  const std::string stem = test::temp_folder() + "/whit_deflated";
  for (const auto& [name, some] : {std::pair(stem, std::span<const unsigned char>(bytes)),
                                   std::pair(stem + "_none", std::span<const unsigned char>())}) {
    const auto packed = deflated(some);
    EXPECT_LT(packed.size(), some.size() / 2 + 20);
    std::ofstream(name, std::ios::binary).write(reinterpret_cast<const char*>(packed.data()), ptrdiff_t(packed.size()));
  }
  const std::string program =
      "import sys,zlib; s=sys.argv[1]; b=bytes((i*i>>7)&(i>>12)&255 for i in range(3000001)); "
      "sys.exit(zlib.decompress(open(s,'rb').read())!=b or zlib.decompress(open(s+'_none','rb').read())!=b'')";
  EXPECT_EQ(std::system(("python3 -c \"" + program + "\" '" + stem + "'").c_str()), 0);
}

// A flat colour survives JPEG to a step or two; the size is kept.
TEST(DataAddress, EncodesJpeg) {
  DisplayPixels pixels{37, 19, 8, {}};
  for (int i = 0; i < 37 * 19; ++i) pixels.bytes.insert(pixels.bytes.end(), {200, 90, 30});
  const std::string path = test::temp_folder() + "/whit_data_address.jpg";
  const auto bytes = encode_jpeg(pixels, 90);
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), ptrdiff_t(bytes.size()));
  const auto read = read_image(path);
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.value.width, 37);
  EXPECT_EQ(read.value.height, 19);
  const double expected[] = {200, 90, 30};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(read.value.pixel(30, 10)[c] * 255, expected[c], 2);
}

}  // namespace
}  // namespace whit
