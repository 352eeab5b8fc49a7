#include "core/compare/report_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/compare/page_row.h"
#include "tests/compare/made_pair.h"

namespace whit {
namespace {

size_t times(const std::string& text, const std::string& what) {
  size_t n = 0;
  for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

constexpr int kWidth = 96, kHeight = 64;

// A ramp in each channel, in steps that floats and people can read: R grows to the right, G downwards.
double ramp(int x, int y, int c) { return c == 0 ? 0.01 * x : c == 1 ? 0.01 * y : 0.25; }

// The same with a patch from (40, 20) to (55, 31) that is brighter by a tenth in R, and (7, 5), which is much brighter.
double changed(int x, int y, int c) {
  if (x == 7 && y == 5) return ramp(x, y, c) + 0.5;
  return ramp(x, y, c) + (c == 0 && x >= 40 && x < 56 && y >= 20 && y < 32 ? 0.1 : 0);
}

// What the page's own test reads under the cursor.
struct Example {
  PicturePair pair;
  Comparison comparison;
};

Comparison comparison_of(const PicturePair& pair) {
  Comparison c;
  c.a_path = pair.a_path;
  c.b_path = pair.b_path;
  c.width = pair.width();
  c.height = pair.height();
  return c;
}

Example example() {
  Example e{test::made_pair(kWidth, kHeight, changed, ramp), {}};
  test::add_layer(
      e.pair, "N", ChannelKind::Data, {"N.X", "N.Y", "N.Z"},
      [](int x, int, int c) {
        return c == 0 ? -0.5 : c == 1 ? 0.5 : x < 48 ? 0.75 : 0.25;
      },
      [](int, int, int c) { return c == 0   ? -0.5
                                   : c == 1 ? 0.5
                                            : 0.75; });
  test::add_layer(
      e.pair, "shape", ChannelKind::Id, {"shape.id"}, [](int x, int, int) { return x < 20 ? 3 : 4; },
      [](int x, int, int) { return x < 24 ? 3 : 4; });
  Comparison& c = e.comparison = comparison_of(e.pair);
  c.differing_pixels = 193;
  c.measured = {{"relmse_robust", "", 0.031, "", {}, "the worst 6 pixels hold 61 % of relmse", 0.02},
                {"ratio", "", 1.004, "R", {}, "", 0.01},
                {"block", "", 0.21, "R", Vec2i(40, 24), "", 0.08},
                {"shift", "", 0, "", {}, "", 0.1},
                {"max", "", 0.5, "G", Vec2i(7, 5), ""}};
  c.failed = {{"block", "", 0.21, 0.08, "R", Vec2i(40, 24), ""}, {"relmse_robust", "", 0.031, 0.02, "", {}, ""}};
  NoiseVerdict noise;
  noise.same = false;
  noise.p = 3e-9;
  noise.alpha = 0.001;
  noise.how = "The noise is known from the files.";
  noise.regions = {{{{40, 20}, {55, 31}}, 0.1, "R", 3e-9, {"sphere <ball>.pbrt:12", "floor"}}};
  c.noise = noise;
  return e;
}

Comparison named(const std::string& name, const std::string& cannot = "") {
  Comparison c;
  c.a_path = "out/" + name;
  c.b_path = "ref/" + name;
  c.cannot = cannot;
  return c;
}

// A comparison whose worst failure is so many times over its limit.
Comparison failed_by(double times_over, const std::string& name) {
  Comparison c = named(name);
  c.failed = {{"relmse_robust", "", 0.02 * times_over, 0.02, "", {}, ""}};
  return c;
}

Example odd_example() {
  Example e{test::made_pair(
                30, 20, [](int x, int y, int) { return x == 3 && y == 4 ? NAN : 0.5; },
                [](int x, int y, int) { return x == 5 && y == 6 ? INFINITY : 1e6 * x; }),
            {}};
  e.pair.a_path = "out/</script><b>&\"'\xff\n.exr";
  e.pair.b_path = "ref/</script><b>&\"'\xff\n.exr";
  e.comparison = comparison_of(e.pair);
  e.comparison.measured = {{"relmse_robust", "", INFINITY, "", {}, "", 0.02}, {"ratio", "", NAN, "G", {}, "", 0.01}};
  e.comparison.failed = {{"nonfinite", "", 2, 0, "R", Vec2i(3, 4), "NaN <!-- "}};
  e.comparison.nonfinite = {{Side::A, "R", {3, 4}, NAN}, {Side::B, "G", {5, 6}, INFINITY}};
  e.comparison.nonfinite_count = 6;
  e.comparison.notes = {"<img src=x onerror=alert(1)> was taken to linear"};
  return e;
}

std::string page_of(const Example& e) {
  ReportPage page;
  page.add(e.comparison, &e.pair);
  return page.html("out against ref");
}

// The page without its own script and style, which are as they are.
std::string written_part(std::string page) {
  page.erase(0, page.find("</style>"));
  return page.substr(0, page.find("<script>\n\"use strict\""));
}

TEST(ReportPage, EscapesNames) {
  ReportPage both;
  const Example odd = odd_example();
  both.add(odd.comparison, &odd.pair);
  both.add(named("fine.exr"), nullptr);
  const std::string page = written_part(both.html("</title><script>"));
  EXPECT_EQ(page.find("<b>&\""), std::string::npos);
  EXPECT_EQ(page.find("<img src=x"), std::string::npos);
  EXPECT_EQ(page.find("<!--"), std::string::npos);
  EXPECT_NE(page.find("&lt;/script&gt;&lt;b&gt;&amp;&quot;&#39;? .exr"), std::string::npos);
  EXPECT_NE(page.find("\\u003c/script>"), std::string::npos);
  // Data of the layer, FLIP, the rows and the maps; no end of a script comes from a name.
  EXPECT_EQ(times(page, "<script"), 4u);
  EXPECT_EQ(times(page, "</script"), 4u);
}

TEST(ReportPage, NeedsNoNetwork) {
  const std::string page = page_of(example());
  for (const char* bad : {"http:", "https:", "//cdn", "url("}) EXPECT_EQ(page.find(bad), std::string::npos) << bad;
}

TEST(ReportPage, PutsTheWorstFirst) {
  ReportPage page;
  page.add(failed_by(1.5, "little.exr"), nullptr);
  page.add(named("fine.exr"), nullptr);
  page.add(failed_by(40, "much.exr"), nullptr);
  page.add(named("no.exr", "B has no alpha"), nullptr);
  const std::string html = page.html("t");
  std::vector<size_t> at;
  for (const char* name : {">no.exr<", ">much.exr<", ">little.exr<", ">fine.exr<"}) at.push_back(html.find(name));
  EXPECT_NE(at.back(), std::string::npos);
  EXPECT_TRUE(std::is_sorted(at.begin(), at.end()));
  EXPECT_NE(html.find("<b>2</b> differ<"), std::string::npos);
  EXPECT_NE(html.find("<b>1</b> is the same<"), std::string::npos);
  EXPECT_NE(html.find("<b>1</b> cannot be compared<"), std::string::npos);
  EXPECT_NE(html.find("B has no alpha"), std::string::npos);
}

// Three pictures of one size and noise that does not compress, a budget that holds the data of one and a half: the worst
// has its own. Thumbnails stay.
TEST(ReportPage, KeepsToTheBudget) {
  const auto noise = [](int x, int y, int c) {
    return std::fmod(std::sin(12.9898 * x + 78.233 * y + c) * 43758.5453, 1);
  };
  PicturePair pair = test::made_pair(kWidth, kHeight, noise, ramp);
  test::add_layer(pair, "N", ChannelKind::Data, {"N.X"}, noise, noise);
  ReportPage all;
  all.add(failed_by(2, "one.exr"), &pair);
  const size_t one = all.html("t").size(), empty = ReportPage(0).html("t").size();
  ReportPage page(one - empty);
  const char* names[] = {"a.exr", "b.exr", "c.exr"};
  for (int i : {0, 2, 1}) page.add(failed_by(2 + i, names[i]), &pair);
  const std::string html = page.html("t");
  EXPECT_NE(html.find("id=\"d0-0\""), std::string::npos);  // "c.exr", the worst
  EXPECT_NE(html.find("id=\"d0-flip\""), std::string::npos);
  for (const char* gone : {"id=\"d0-1\"", "id=\"d2-0\"", "id=\"d2-1\"", "id=\"d2-flip\""})
    EXPECT_EQ(html.find(gone), std::string::npos) << gone;
  EXPECT_EQ(times(html, "<img src=\"data:image/png"), 9u);
  EXPECT_GE(times(html, "which would be too large"), 2u);
}

TEST(ReportPage, NamesRows) {
  EXPECT_EQ(row_name("out/cornell/a.exr", "ref/cornell/a.exr"), "cornell/a.exr");
  EXPECT_EQ(row_name("out/a.exr", "ref/b.exr"), "a.exr against b.exr");
  EXPECT_EQ(row_name("a.exr", "a.exr"), "a.exr");
}

// Small float pictures stay floats; where halfs hold the same they are enough, and whole numbers for those of displays;
// large ones are rounded, and say so; what halfs cannot hold never is.
TEST(PageLayer, ChoosesHowNumbersAreStored) {
  const auto layer_of = [](int width, int height, const test::PixelOf& a) {
    const PicturePair pair = test::made_pair(width, height, a, a);
    return page_layer(pair, pair.layers[0], page_size(pair));
  };
  EXPECT_EQ(layer_of(8, 8, [](int, int, int) { return 0.3; }).numbers, PageNumbers::Float);
  EXPECT_EQ(layer_of(800, 800, [](int x, int, int) { return x % 256 / 255.0f; }).numbers, PageNumbers::Whole);
  EXPECT_EQ(layer_of(8, 8, [](int, int, int) { return 0.25; }).numbers, PageNumbers::Half);
  const PageLayer large = layer_of(600, 600, [](int, int, int) { return 0.3; });
  EXPECT_EQ(large.numbers, PageNumbers::Half);
  EXPECT_TRUE(large.rounded);
  EXPECT_EQ(layer_of(600, 600, [](int, int, int) { return 1e6; }).numbers, PageNumbers::Float);
  EXPECT_EQ(layer_of(8, 8, [](int, int, int) { return INFINITY; }).numbers, PageNumbers::Half);
}

// 3000 x 2000 is above 4 MiPixels: every other pixel.
TEST(PageLayer, ReducesLargePictures) {
  PicturePair pair;
  pair.window = {{0, 0}, {2999, 1998}};
  const PageSize size = page_size(pair);
  EXPECT_EQ(size.step, 2);
  EXPECT_EQ(size.width, 1500);
  EXPECT_EQ(size.height, 1000);
  EXPECT_EQ(page_size(test::made_pair(2, 2, ramp, ramp)).step, 1);
}

// For tests/compare/report_page_test.py, which opens them.
TEST(ReportPage, WritesPages) {
  const char* folder = std::getenv("WHIT_DIFF_PAGES");
  if (!folder) GTEST_SKIP() << "WHIT_DIFF_PAGES names no folder";
  std::ofstream(std::string(folder) + "/one.html") << page_of(example());
  const Example e = example(), odd = odd_example();
  PicturePair same = test::made_pair(kWidth, kHeight, ramp, ramp);
  same.a_path = "out/deep/down/same.exr";
  same.b_path = "ref/deep/down/same.exr";
  // A crop of pictures for a display.
  same.window = {{100, 50}, {100 + kWidth - 1, 50 + kHeight - 1}};
  same.scale = PairScale::Display;
  ReportPage page;
  page.add(e.comparison, &e.pair);
  page.add(comparison_of(same), &same);
  page.add(odd.comparison, &odd.pair);
  page.add(named("sized.exr", "A is 64 x 64, B 32 x 32 pixels"), nullptr);
  std::ofstream(std::string(folder) + "/folder.html") << page.html("out against ref");
}

}  // namespace
}  // namespace whit
