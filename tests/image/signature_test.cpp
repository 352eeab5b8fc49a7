// First bytes: what OpenImageIO writes is recognised, and nothing that would be no picture.
#include "core/image/signature.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

using test::temp_path;
using test::write_temp;

TEST(Signature, of_pictures_of_all_common_kinds) {
  for (const int channels : {1, 3, 4})
    for (const char* name : {"a.png", "a.jpg", "a.JPEG", "a.tga", "b.TGA", "a.exr"}) {
      if (channels == 4 && (name[2] == 'j' || name[2] == 'J')) continue;
      const OIIO::ImageSpec spec(5, 3, channels, OIIO::TypeDesc::UINT8);
      const std::vector<unsigned char> pixels(5 * 3 * 4, 128);
      auto out = OIIO::ImageOutput::create(temp_path(name));
      ASSERT_TRUE(out && out->open(temp_path(name), spec) && out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
                  out->close());
      EXPECT_TRUE(begins_like_a_picture(temp_path(name))) << name << ' ' << channels;
    }
}

TEST(Signature, not_of_what_is_missing_short_or_something_else) {
  EXPECT_FALSE(begins_like_a_picture(temp_path("nowhere.png")));
  EXPECT_FALSE(begins_like_a_picture(test::temp_folder()));
  EXPECT_FALSE(begins_like_a_picture(write_temp("empty.png", "")));
  EXPECT_FALSE(begins_like_a_picture(write_temp("text.png", "WorldBegin Shape \"sphere\" WorldEnd")));
  EXPECT_FALSE(begins_like_a_picture(write_temp("text.tga", "WorldBegin Shape \"sphere\" WorldEnd")));
  // A PNG of 16 x 16 pixels of 8 bits, and what is left of it when its width is 0 or its header is cut.
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x10\0\0\0\x10\x08\x02\0\0\0", 29);
  EXPECT_TRUE(begins_like_a_picture(write_temp("whole.png", png)));
  EXPECT_FALSE(begins_like_a_picture(write_temp("cut.png", png.substr(0, 20))));
  std::string flat = png;
  flat[19] = 0;
  EXPECT_FALSE(begins_like_a_picture(write_temp("flat.png", flat)));
  // Kind 2 (true colour), 1 x 1 pixels of 24 bits, is a TGA by its name only; of 13 bits it is none.
  std::string tga(40, '\0');
  tga[2] = 2, tga[12] = 1, tga[14] = 1, tga[16] = 24;
  EXPECT_TRUE(begins_like_a_picture(write_temp("a.tga", tga)));
  EXPECT_FALSE(begins_like_a_picture(write_temp("a.dat", tga)));
  tga[16] = 13;
  EXPECT_FALSE(begins_like_a_picture(write_temp("odd.tga", tga)));
}

}  // namespace
}  // namespace whit
