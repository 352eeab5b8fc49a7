// The film: sizes, crops, and what it refuses.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/plugin/film.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

Made<Film> make_film(ParameterList parameters = {}) {
  return make_plugin<Film>("film", "image", std::move(parameters));
}

std::array<double, 4> crop_of(const Film& film) {
  std::array<double, 4> c;
  film.crop_window(c.data());
  return c;
}

TEST(ImageFilm, Defaults) {
  const auto f = make_film();
  ASSERT_TRUE(f.silent());
  EXPECT_EQ(f->resolution(), Vec2i(1280, 720));
  EXPECT_EQ(crop_of(*f.plugin), (std::array<double, 4>{0, 1, 0, 1}));
  EXPECT_DOUBLE_EQ(f->diagonal_metres(), 0.035);
  EXPECT_EQ(f->scale(), 1);
  EXPECT_TRUE(std::isinf(f->max_sample_luminance()));
  EXPECT_EQ(f->file_name(), "");
  EXPECT_EQ(f->view(), "");
  EXPECT_EQ(f->exposure(), 0);
}

TEST(ImageFilm, CropsAreSortedAndClamped) {
  const auto f = make_film({floats("cropwindow", {0.75, 0.25, -1, 0.5})});
  ASSERT_TRUE(f.silent());
  EXPECT_EQ(crop_of(*f.plugin), (std::array<double, 4>{0.25, 0.75, 0, 0.5}));
}

TEST(ImageFilm, WrongParametersAreErrors) {
  EXPECT_FALSE(make_film({floats("cropwindow", {0, 1, 0})}).good());
  EXPECT_FALSE(make_film({floats("cropwindow", {0.5, 0.5, 0, 1})}).good());
  EXPECT_FALSE(make_film({floats("cropwindow", {2, 3, 0, 1})}).good());
  EXPECT_FALSE(make_film({integer("xresolution", 0)}).good());
  EXPECT_FALSE(make_film({integer("yresolution", -5)}).good());
  EXPECT_FALSE(make_film({integer("xresolution", 2000000000)}).good());
  EXPECT_TRUE(make_film({integer("xresolution", 65536)}).good());
}

}  // namespace
}  // namespace whit
