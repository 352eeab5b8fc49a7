// Making two pictures alike: which channels, which pixels, which scale.
#include "core/compare/pair.h"

#include <cmath>
#include <limits>

#include "tests/compare/pictures.h"

namespace whit {
namespace {

std::vector<std::string> layer_names(const PicturePair& pair) {
  std::vector<std::string> names;
  for (const ComparedLayer& layer : pair.layers) names.push_back(layer.name);
  return names;
}

PicturePlanes named(std::vector<std::string> names) {
  return picture(4, 4, std::move(names), [](size_t c, int, int) { return static_cast<float>(c); });
}

TEST(Pair, ChannelsMeetByName) {
  const PicturePair pair = pair_of(named({"R", "G", "B"}), named({"B", "G", "R"}));
  EXPECT_EQ(pair.find("R")->a[0], 0);
  EXPECT_EQ(pair.find("R")->b[0], 2);
  const ComparedLayer& beauty = *pair.beauty();
  EXPECT_EQ(pair.channels[beauty.channels[0]].name, "R");
}

TEST(Pair, LayersHaveOneKind) {
  const PicturePair pair = pair_of(named({"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "shape.id", "variance.R"}),
                                   named({"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "shape.id", "variance.R"}));
  EXPECT_EQ(layer_names(pair), (std::vector<std::string>{"", "A", "N", "Z", "shape"}));
  EXPECT_NE(pair.find("variance.R"), nullptr);  // It is there for the noise test.
  PairRequest all;
  all.channels = "*";
  EXPECT_EQ(layer_names(pair_of(named({"R", "variance.R"}), named({"R", "variance.R"}), all)),
            (std::vector<std::string>{"", "variance"}));
}

TEST(Pair, NamesWhatOneLacks) {
  EXPECT_EQ(
      pair_error(named({"R", "G", "B", "A"}), named({"R", "G", "B", "N.X"})),
      "they have not the same channels: \"a.exr\" alone has A, \"b.exr\" alone has N.X; --channels 'R,G,B' compares "
      "what both have");
  EXPECT_EQ(pair_error(named({"X", "Y", "Z"}), named({"R", "G", "B"})),
            "they have not the same channels: \"a.exr\" alone has X, Y, Z, \"b.exr\" alone has R, G, B");
  PairRequest colours;
  colours.channels = "R,G,B";
  EXPECT_EQ(pair_error(named({"R", "G", "B", "A"}), named({"R", "G", "B", "N.X"}), colours), "");
  colours.channels = "Q";
  EXPECT_EQ(pair_error(named({"R"}), named({"R"}), colours), "no channel is called Q: \"a.exr\" has R");
  colours.channels = "R, Green";  // Not R alone: a misspelt channel would never be looked at.
  EXPECT_EQ(pair_error(named({"R", "G"}), named({"R", "G"}), colours),
            "no channel is called Green: \"a.exr\" has R, G");
}

TEST(Pair, CropsMeetWhereBothArePixels) {
  const auto place = [](size_t, int x, int y) { return static_cast<float>(100 * y + x); };
  const PicturePlanes full = picture(20, 10, {"R"}, place);
  PicturePlanes crop = picture(5, 4, {"R"}, [&](size_t c, int x, int y) { return place(c, x + 7, y + 3); });
  crop.x = 7, crop.y = 3, crop.full_width = 20, crop.full_height = 10;
  for (const PicturePair& pair : {pair_of(full, crop), pair_of(crop, full)}) {
    EXPECT_EQ(pair.window, Box2i({7, 3}, {11, 6}));
    EXPECT_EQ(pair.channels[0].a, pair.channels[0].b);
    EXPECT_EQ(pair.channels[0].a[0], 307);
    EXPECT_EQ(pair.notes.size(), 1u);
  }
  PairRequest corner;
  corner.crop = true;
  corner.window = {{0, 0}, {8, 4}};
  EXPECT_EQ(pair_of(full, crop, corner).window, Box2i({7, 3}, {8, 4}));
  corner.window = {{0, 0}, {2, 2}};
  EXPECT_EQ(pair_error(full, crop, corner), "the crop has no pixel of theirs: they have x 7 to 11, y 3 to 6");
}

TEST(Pair, WindowsMayBeginAnywhere) {
  // The display window from (-5, 2): the same picture, told by other numbers.
  PicturePlanes a = grey(8, 8, 1), b = a;
  b.x = b.full_x = -5, b.y = b.full_y = 2;
  EXPECT_EQ(pair_of(a, b).window, Box2i({0, 0}, {7, 7}));
}

TEST(Pair, SizesMustBeEqual) {
  EXPECT_EQ(pair_error(grey(8, 8, 1), grey(8, 9, 1)),
            "they have different sizes: \"a.exr\" is 8 x 8, \"b.exr\" is 8 x 9 pixels");
}

PicturePlanes bytes(float value) {
  PicturePlanes p = grey(4, 4, value);
  p.format = SampleFormat::UInt8;
  p.formats.assign(3, SampleFormat::UInt8);
  p.metadata["oiio:ColorSpace"] = "sRGB";
  return p;
}

TEST(Pair, DisplayValuesBecomeLight) {
  // IEC 61966-2-1: 188/255 is ((0.7372549 + 0.055) / 1.055)^2.4 = 0.5028865.
  const PicturePair pair = pair_of(bytes(188.0f / 255), grey(4, 4, 0.5f));
  EXPECT_EQ(pair.scale, PairScale::Linear);
  EXPECT_NEAR(pair.channels[0].a[0], 0.5028865f, 1e-6);
  EXPECT_EQ(pair.notes, (std::vector<std::string>{"\"a.exr\" is taken from sRGB to linear light"}));
  // Two on one scale stay.
  const PicturePair display = pair_of(bytes(0.25f), bytes(0.5f));
  EXPECT_EQ(display.scale, PairScale::Display);
  EXPECT_EQ(display.channels[0].b[0], 0.5f);
  // A space that is asked for: 0.25^2.
  PairRequest gamma;
  gamma.colour_space = "gamma=2";
  EXPECT_NEAR(pair_of(bytes(0.25f), grey(4, 4, 1), gamma).channels[0].a[0], 0.0625f, 1e-7);
  gamma.colour_space = "log";
  EXPECT_NE(pair_error(bytes(0.25f), grey(4, 4, 1), gamma).find("unknown colour space \"log\"; there are linear"),
            std::string::npos);
}

TEST(Pair, LightIsCutWhereADisplayEnds) {
  const float inf = std::numeric_limits<float>::infinity();
  PicturePlanes light = grey(4, 4, 20);
  at(light, 0, 1, 1) = -0.5f;
  const PicturePair pair = pair_of(bytes(1), light);
  EXPECT_EQ(pair.find("G")->b[0], 1);
  EXPECT_EQ(pair.find("R")->b[5], 0);
  EXPECT_EQ(pair.notes.back(),
            "48 numbers of \"b.exr\" are beyond 0 and 1, which the other cannot hold, and are cut there");
  // NaN stays what it is, and infinity is no light that a display may stand for.
  at(light, 0, 0, 0) = std::nanf("");
  at(light, 1, 0, 0) = inf;
  const PicturePair broken = pair_of(bytes(1), light);
  EXPECT_TRUE(std::isnan(broken.find("R")->b[0]));
  EXPECT_EQ(broken.find("G")->b[0], inf);
}

TEST(Pair, FloatsAreLightWhateverTheirPrimaries) {
  // What OpenImageIO says of PFM files, and names of primaries.
  for (const char* space : {"Rec709", "lin_rec709", "ACEScg"}) {
    PicturePlanes p = grey(4, 4, 0.5f);
    say_in_header(p, "oiio:ColorSpace", space);
    const PicturePair pair = pair_of(p, grey(4, 4, 0.5f));
    EXPECT_EQ(pair.scale, PairScale::Linear) << space;
    EXPECT_EQ(pair.channels[0].a[0], 0.5f) << space;
  }
}

TEST(Pair, OnlyColoursHaveAScale) {
  PicturePlanes with_alpha = picture(2, 2, {"R", "G", "B", "A"}, [](size_t, int, int) { return 0.5f; });
  PicturePlanes display = with_alpha;
  display.format = SampleFormat::UInt8;
  const PicturePair pair = pair_of(display, with_alpha);
  EXPECT_LT(pair.find("R")->a[0], 0.3f);
  EXPECT_EQ(pair.find("A")->a[0], 0.5f);
}

}  // namespace
}  // namespace whit
