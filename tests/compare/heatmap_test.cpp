#include "core/compare/heatmap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>

#include "core/image/image.h"
#include "tests/base/temp_folder.h"
#include "tests/compare/made_pair.h"

namespace whit {
namespace {

double waves(int x, int y, int c) { return 0.3 + 0.2 * std::sin(0.05 * x + 0.03 * y * (c + 1)); }

// The bytes of the picture that is written.
class Heatmap : public testing::Test {
 protected:
  // With WHIT_HEATMAPS=FOLDER the pictures stay there to be looked at.
  void write(const PicturePair& pair, HeatSign sign, double full = 0) {
    const char* kept = std::getenv("WHIT_HEATMAPS");
    const std::string path = (kept ? std::string(kept) : test::temp_folder()) + "/whit_heatmap_" +
                             testing::UnitTest::GetInstance()->current_test_info()->name() + ".png";
    ASSERT_EQ(write_heatmap(path, pair, sign, full), "");
    auto read = read_image(path);
    ASSERT_EQ(read.error, "");
    image_ = std::move(read.value);
  }
  ByteColour at(int x, int y) const {
    const float* p = image_.pixel(x, y);
    const auto byte = [&](size_t c) { return static_cast<uint8_t>(std::lround(p[c] * 255)); };
    return {byte(0), byte(1), byte(2)};
  }
  // Rows beneath the picture that have every colour of the map, in its order.
  int rows_of_bar(int picture_height, const ColourMap& map) const {
    int rows = 0;
    for (int y = picture_height; y < image_.height; ++y) {
      size_t next = 0;
      for (int x = 0; x < image_.width; ++x)
        while (next < map.size() && at(x, y) == map[next]) ++next;
      rows += next == map.size() ? 1 : 0;
    }
    return rows;
  }
  Image image_;
};

// A difference of the end of the scale in every channel is the map's last colour, half of it the middle one, none the
// first: 0.5 * 255 rounds to 128.
TEST_F(Heatmap, HasTheMapsColours) {
  const PicturePair pair = test::made_pair(500, 20, waves, [](int x, int y, int c) {
    return waves(x, y, c) - (x < 100 ? 0 : x < 200 ? 0.125 : 0.25);
  });
  write(pair, HeatSign::Absolute, 0.25);
  EXPECT_EQ(image_.width, 500);
  EXPECT_EQ(at(50, 10), kMagma[0]);
  EXPECT_EQ(at(150, 10), kMagma[128]);
  EXPECT_EQ(at(450, 10), kMagma[255]);
  EXPECT_GE(rows_of_bar(20, kMagma), 6);
}

// a - b = -0.25 is the first colour of "berlin", +0.25 the last.
TEST_F(Heatmap, HasSigns) {
  const PicturePair pair = test::made_pair(600, 20, waves, [](int x, int y, int c) {
    return waves(x, y, c) + (x < 200 ? 0.25 : x < 400 ? 0 : -0.25);
  });
  write(pair, HeatSign::Signed, 0.25);
  EXPECT_EQ(at(100, 10), kBerlin[0]);
  EXPECT_EQ(at(300, 10), kBerlin[128]);
  EXPECT_EQ(at(500, 10), kBerlin[255]);
  EXPECT_GE(rows_of_bar(20, kBerlin), 6);
}

// One pixel in 200 x 100 = 20000 is off by a thousand; 30 of them, more than one in a thousand, by 0.1: that is the end.
TEST_F(Heatmap, ScalesByAllButOneInAThousand) {
  const PicturePair pair = test::made_pair(
      200, 100,
      [](int x, int y, int) {
        return y == 50 ? (x == 0 ? 1000 : x <= 30 ? 0.1 : 0.05) : 0.0;
      },
      [](int, int, int) { return 0.0; });
  EXPECT_NEAR(heat_scale(difference_of(pair, shown_channels(pair), HeatSign::Absolute)), 0.1, 1e-6);
  EXPECT_EQ(heat_scale(std::vector<float>(5, 0.0f)), 1);
  EXPECT_EQ(heat_scale(std::vector<float>{0, 0, -3, NAN}), 3);
}

// 8 pixels wide: enlarged 50 times, to 400.
TEST_F(Heatmap, EnlargesSmallPictures) {
  const PicturePair pair = test::made_pair(
      8, 6, [](int x, int y, int) { return x == 3 && y == 2 ? 1 : 0; }, [](int, int, int) { return 0; });
  write(pair, HeatSign::Absolute);
  EXPECT_EQ(image_.width, 400);
  for (int dy : {0, 49})
    for (int dx : {0, 49}) EXPECT_EQ(at(3 * 50 + dx, 2 * 50 + dy), kMagma[255]);
  EXPECT_EQ(at(3 * 50 - 1, 2 * 50), kMagma[0]);
  EXPECT_EQ(at(3 * 50, 3 * 50), kMagma[0]);
}

// NaN and both infinities, in one channel of either picture, and an infinity in both.
TEST_F(Heatmap, MarksWhatIsNotFinite) {
  const PicturePair pair = test::made_pair(
      500, 40, [](int x, int, int c) { return x == 10 && c == 1 ? NAN
                                              : x == 30         ? -INFINITY
                                                                : 0.5; },
      [](int x, int, int c) { return x == 20 && c == 2 ? INFINITY
                                     : x == 30         ? -INFINITY
                                                       : 0.4; });
  for (HeatSign sign : {HeatSign::Absolute, HeatSign::Signed}) {
    write(pair, sign);
    for (int x : {10, 20, 30}) EXPECT_EQ(at(x, 3), kNanColour) << x;
    EXPECT_EQ(at(40, 3), heat_map(sign)[255]);
  }
  // No colour of a map is near to it.
  for (const ColourMap* map : {&kMagma, &kBerlin})
    for (const ByteColour& c : *map) {
      int apart = 0;
      for (size_t k = 0; k < 3; ++k) apart = std::max(apart, std::abs(c[k] - kNanColour[k]));
      EXPECT_GT(apart, 100);
    }
}

TEST_F(Heatmap, TakesAllNumbersWithoutABeauty) {
  PicturePair pair = test::made_pair(500, 10, waves, waves);
  pair.layers.clear();
  test::add_layer(
      pair, "Z", ChannelKind::Data, {"Z"}, [](int, int, int) { return 5; }, [](int, int, int) { return 4; });
  test::add_layer(
      pair, "id", ChannelKind::Id, {"shape.id"}, [](int, int, int) { return 9; }, waves);
  EXPECT_EQ(shown_channels(pair), std::vector<size_t>{3});
  write(pair, HeatSign::Signed, 2);
  EXPECT_EQ(at(250, 5), heat_colour(1, HeatSign::Signed, 2));
}

TEST_F(Heatmap, SaysWhyNot) {
  const PicturePair pair = test::made_pair(4, 4, waves, waves);
  EXPECT_NE(write_heatmap("/nowhere/at/all.png", pair, HeatSign::Absolute).find("/nowhere/at/all.png"),
            std::string::npos);
}

}  // namespace
}  // namespace whit
