// The state of a film: what goes on from it has the bits of a film that was never stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "core/render/film_render.h"
#include "tests/render/film_world.h"

namespace whit {
namespace {

using test::film_world;
using test::kGaussian;
using World = test::FilmWorld;

std::string state_of(const FilmRender& film) {
  std::string state;
  ByteWriter out([&](const void* bytes, size_t size) { state.append(static_cast<const char*>(bytes), size); });
  film.save(out);
  return state;
}

bool restore(FilmRender& film, const std::string& state) {
  ByteReader in(state);
  return film.restore(in);
}

RenderOptions options_for(bool blocks, bool adaptive, bool aovs) {
  RenderOptions options;
  options.blocks = blocks, options.adaptive = adaptive;
  if (aovs) options.aovs.names = {"albedo", "P", "shape", "samples", "variance"};
  options.aovs.place = [](SourcePos) { return std::string("here"); };
  return options;
}

std::vector<float> values_of(const FilmRender& film) {
  const RenderResult result = film.result();
  std::vector<float> all = result.picture.rgb;
  for (const AovPicture::Channel& c : result.aovs.channels) all.insert(all.end(), c.values.begin(), c.values.end());
  return all;
}

class FilmState : public testing::TestWithParam<std::tuple<bool, bool, bool, const char*>> {
 protected:
  RenderOptions options() const {
    const auto [blocks, adaptive, aovs, filter] = GetParam();
    return options_for(blocks, adaptive, aovs);
  }
};

/// Stopped at every of its tiles and rounds in turn, by a progress that says no the k-th time.
TEST_P(FilmState, GoesOnWhereverItWasStopped) {
  const World of = film_world(std::get<3>(GetParam()), "sobol");
  FilmRender whole(of.scene(), options());
  ASSERT_TRUE(whole.extend(64) && whole.extend(128));
  const std::vector<float> wanted = values_of(whole);
  for (int stop = 1; stop < 40; stop += 3) {
    int asked = 0;
    RenderOptions stopping = options();
    stopping.threads = 1;
    stopping.progress = [&](double) { return ++asked < stop; };
    FilmRender first(of.scene(), stopping);
    const bool all = first.extend(64) && first.extend(128);
    FilmRender second(of.scene(), options());
    ASSERT_TRUE(restore(second, state_of(first)));
    EXPECT_TRUE(second.restored());
    // In which pass it was is in the state.
    ASSERT_TRUE(second.go_on());
    const bool more = second.wanted() < 128;
    ASSERT_TRUE(!more || second.extend(128));
    EXPECT_EQ(values_of(second), wanted) << "stopped when asked for the " << stop << "th time";
    EXPECT_EQ(second.result().statistics.camera_samples, whole.result().statistics.camera_samples) << stop;
    if (all) break;
  }
}

/// Numbers of samples for four passes: as many again for all; then for some, and others have a number that is no double; at
/// last for one, and for those that are beyond the picture.
std::vector<std::vector<uint32_t>> wants_of(const std::vector<FilmRender::Unit>& units) {
  std::vector<uint32_t> third(units.size()), last(units.size());
  for (size_t u = 0; u < units.size(); ++u) {
    third[u] = u % 3 == 0 ? 16 : u % 3 == 1 ? 11 : 0;
    last[u] = u == 0 || units[u].area() == 0 ? 32 : 0;
  }
  return {std::vector<uint32_t>(units.size(), 4), std::vector<uint32_t>(units.size(), 8), third, last};
}

std::vector<uint32_t> samples_of(const FilmRender& film) {
  std::vector<uint32_t> samples;
  for (const FilmRender::Unit& u : film.units()) samples.push_back(u.samples);
  return samples;
}

std::string pass_of(const FilmRender& film) {
  std::string pass;
  ByteWriter out([&](const void* bytes, size_t size) { pass.append(static_cast<const char*>(bytes), size); });
  film.save_pass(out);
  return pass;
}

bool take_share(FilmRender& film, const std::string& pass, size_t share, size_t of) {
  ByteReader in(pass);
  return film.take_share(in, share, of);
}

bool add_share(FilmRender& film, const std::string& state) {
  ByteReader in(state);
  return film.add_share(in);
}

/// What comes of a share.
std::string share_of(const World& of, const RenderOptions& options, const std::string& pass, size_t share, size_t n) {
  FilmRender film(of.scene(), options);
  EXPECT_TRUE(take_share(film, pass, share, n) && film.go_on());
  EXPECT_TRUE(film.result().picture.rgb.empty());
  return state_of(film);
}

TEST_P(FilmState, SharesOfAPassAreThePass) {
  const World of = film_world(std::get<3>(GetParam()), "sobol");
  for (const size_t n : {size_t{1}, size_t{2}, size_t{3}, size_t{15}}) {  // 15 are more than there are tiles
    FilmRender whole(of.scene(), options()), shared(of.scene(), options());
    for (const std::vector<uint32_t>& want : wants_of(whole.units())) {
      ASSERT_TRUE(whole.extend(want));
      shared.begin_pass(want);
      const std::string pass = pass_of(shared);
      for (size_t k = n; k-- > 0;)
        ASSERT_TRUE(add_share(shared, share_of(of, options(), pass, k, n))) << k << " of " << n;
      EXPECT_EQ(shared.rest().tiles, 0u);
      EXPECT_EQ(values_of(shared), values_of(whole)) << n;
      EXPECT_EQ(samples_of(shared), samples_of(whole)) << n;
      for (const int colour : {-1, 0, 1}) {
        if (!options().blocks) continue;
        EXPECT_EQ(shared.variance(colour), whole.variance(colour)) << n << " " << colour;
      }
      EXPECT_EQ(shared.result().statistics.camera_samples, whole.result().statistics.camera_samples);
    }
  }
}

/// The one who decides may have been stopped, and those who render too.
TEST_P(FilmState, SharesOfTheRestOfAPassAreThePass) {
  const World of = film_world(std::get<3>(GetParam()), "sobol");
  FilmRender whole(of.scene(), options());
  ASSERT_TRUE(whole.extend(64) && whole.extend(128));
  int asked = 0;
  RenderOptions stopping = options();
  stopping.threads = 1;
  stopping.progress = [&](double) { return ++asked < 9; };
  FilmRender first(of.scene(), stopping), second(of.scene(), options());
  if (first.extend(64)) first.extend(128);
  ASSERT_TRUE(restore(second, state_of(first)));
  const auto hand_out = [&] {
    const std::string pass = pass_of(second);
    for (size_t k = 0; k < 3; ++k) {
      asked = 0;
      FilmRender begun(of.scene(), stopping), on(of.scene(), options());
      ASSERT_TRUE(take_share(begun, pass, k, 3) && take_share(on, pass, k, 3));
      begun.go_on();
      ASSERT_TRUE(restore(on, state_of(begun)) && on.go_on());
      ASSERT_TRUE(add_share(second, state_of(on)));
    }
  };
  hand_out();
  second.begin_pass(std::vector<uint32_t>(second.units().size(), 128));
  hand_out();
  EXPECT_EQ(values_of(second), values_of(whole));
}

INSTANTIATE_TEST_SUITE_P(Kinds, FilmState,
                         testing::Combine(testing::Bool(), testing::Bool(), testing::Bool(),
                                          testing::Values("", kGaussian)));

TEST(FilmStates, AreSavedWhileOthersRender) {
  const World of = film_world(kGaussian, "random");
  FilmRender whole(of.scene(), {});
  ASSERT_TRUE(whole.extend(256));
  // Every state that is seen on the way leads to the same picture.
  std::vector<std::string> states;
  FilmRender* film = nullptr;
  RenderOptions saving;
  saving.progress = [&](double) {
    states.push_back(state_of(*film));
    return true;
  };
  FilmRender busy(of.scene(), saving);
  film = &busy;
  ASSERT_TRUE(busy.extend(256));
  ASSERT_GT(states.size(), 3u);
  for (size_t i = 0; i < states.size(); i += 1 + states.size() / 8) {
    FilmRender on(of.scene(), {});
    ASSERT_TRUE(restore(on, states[i]));
    ASSERT_TRUE(on.go_on());
    EXPECT_EQ(on.picture().rgb, whole.picture().rgb) << i << " of " << states.size();
  }
}

TEST(FilmStates, SixtyFourAndAsManyAgainAsMakeTwoHundredAndFiftySix) {
  for (const char* filter : {"", kGaussian}) {
    const World of = film_world(filter, "sobol");
    FilmRender once(of.scene(), {}), first(of.scene(), {}), second(of.scene(), {});
    ASSERT_TRUE(once.extend(256) && first.extend(64));
    ASSERT_TRUE(restore(second, state_of(first)));
    EXPECT_EQ(second.wanted(), 64u);
    ASSERT_TRUE(second.extend(64 + 192));
    EXPECT_EQ(second.picture().rgb, once.picture().rgb) << filter;
  }
}

/// The state of some samples of 100.
std::string part_of(const World& of, RenderOptions options, uint32_t first, uint32_t last) {
  options.part = SampleRange{first, last, 100};
  FilmRender film(of.scene(), options);
  EXPECT_TRUE(film.extend(100));
  return state_of(film);
}

bool merge(FilmRender& film, const std::string& state) {
  ByteReader in(state);
  return film.merge(in);
}

TEST(FilmStates, PartsAreOnePicture) {
  // Parts that begin and end anywhere, with all kinds of layers: the bits are those of one render.
  for (const char* filter : {"", kGaussian}) {
    const World of = film_world(filter, "random");
    for (const bool layers : {false, true}) {
      const RenderOptions options = options_for(layers, false, layers);
      FilmRender whole(of.scene(), options), merged(of.scene(), options);
      ASSERT_TRUE(whole.extend(100));
      for (const auto& [first, last] : {std::pair{0, 7}, {7, 64}, {64, 65}, {65, 100}})
        ASSERT_TRUE(merge(merged, part_of(of, options, static_cast<uint32_t>(first), static_cast<uint32_t>(last))));
      EXPECT_EQ(values_of(merged), values_of(whole)) << filter << layers;
      EXPECT_EQ(merged.result().statistics.camera_samples, whole.result().statistics.camera_samples);
      EXPECT_EQ(merged.result().samples_per_pixel, 100);
    }
  }
}

TEST(FilmStates, PartsThatDoNotFollowEachOtherAreRefused) {
  const World of = film_world("", "random"), filtered = film_world(kGaussian, "random");
  const std::string first = part_of(of, {}, 0, 20), third = part_of(of, {}, 30, 100);
  FilmRender missing(of.scene(), {}), twice(of.scene(), {}), other(filtered.scene(), {}), late(of.scene(), {});
  EXPECT_TRUE(merge(missing, first) && !merge(missing, third));
  EXPECT_TRUE(merge(twice, first) && !merge(twice, first));
  EXPECT_FALSE(merge(other, first));
  EXPECT_FALSE(merge(late, third));
  for (const size_t size : {size_t{0}, size_t{7}, first.size() / 2, first.size() - 1}) {
    FilmRender cut(of.scene(), {});
    EXPECT_FALSE(merge(cut, first.substr(0, size))) << size;
  }
}

TEST(FilmStates, APartIsAPictureOfItsSamples) {
  // Under a constant sky alone every sample of a pixel beside the ball is the sky's radiance, whichever are taken; and a
  // part can be stopped and gone on with as a whole can.
  const World of = film_world("", "random");
  RenderOptions options;
  options.part = SampleRange{30, 40, 100};
  FilmRender film(of.scene(), options), on(of.scene(), options), whole(of.scene(), {});
  ASSERT_TRUE(film.extend(100));
  const Picture picture = film.picture();
  EXPECT_EQ(RGB(picture.rgb[0], picture.rgb[1], picture.rgb[2]), RGB(1, 2, 3));
  EXPECT_EQ(film.result().samples_per_pixel, 10);
  EXPECT_EQ(film.result().share, 1);
  EXPECT_FALSE(restore(whole, state_of(film)));
  ASSERT_TRUE(restore(on, state_of(film)));
  ASSERT_TRUE(on.go_on() && on.extend(100));
  EXPECT_EQ(on.picture().rgb, picture.rgb);
}

TEST(FilmStates, SharesThatAreNoneOfThePassAreRefused) {
  const World of = film_world("", "sobol"), filtered = film_world(kGaussian, "sobol");
  const RenderOptions options = options_for(true, true, false);
  const auto begun = [&](const World& world, uint32_t samples, bool all) {
    auto film = std::make_unique<FilmRender>(world.scene(), options);
    film->begin_pass(std::vector<uint32_t>(film->units().size(), 4));
    if (!all) return film;
    EXPECT_TRUE(film->go_on());
    film->begin_pass(std::vector<uint32_t>(film->units().size(), samples));
    return film;
  };
  const std::string first = pass_of(*begun(of, 0, false)), second = pass_of(*begun(of, 8, true)),
                    other = pass_of(*begun(of, 7, true));
  const std::string good = share_of(of, options, second, 0, 2);
  const auto film = begun(of, 8, true);
  ASSERT_TRUE(add_share(*film, good));
  EXPECT_FALSE(add_share(*film, good));                                              // twice
  EXPECT_FALSE(add_share(*begun(of, 8, true), share_of(of, options, first, 0, 2)));  // of the pass before
  EXPECT_FALSE(add_share(*begun(of, 8, true), share_of(of, options, other, 0, 2)));  // fewer samples
  EXPECT_FALSE(add_share(*begun(filtered, 8, true), good));                          // another film
  FilmRender unfinished(of.scene(), options), another(filtered.scene(), options), bytes(of.scene(), options);
  ASSERT_TRUE(take_share(unfinished, second, 0, 2));
  EXPECT_FALSE(add_share(*begun(of, 8, true), state_of(unfinished)));
  EXPECT_FALSE(take_share(another, second, 0, 2));
  EXPECT_FALSE(take_share(bytes, second.substr(0, second.size() - 1), 0, 2));
  EXPECT_FALSE(take_share(bytes, second + "x", 0, 2));
  for (const size_t size : {size_t{0}, size_t{7}, good.size() / 2, good.size() - 1})
    EXPECT_FALSE(add_share(*begun(of, 8, true), good.substr(0, size))) << size;
}

TEST(FilmStates, SharesTakeAlike) {
  // Tiles are sorted by their samples and dealt in rounds. Between any two shares each round makes a difference of what its
  // largest has more than its smallest, all rounds together no more than the largest tile of all.
  const World of = film_world("", "sobol");
  const RenderOptions options = options_for(true, true, false);
  FilmRender film(of.scene(), options);
  std::vector<uint32_t> want(film.units().size());
  for (size_t u = 0; u < want.size(); ++u) want[u] = static_cast<uint32_t>(u * u % 97);
  film.begin_pass(want);
  const double largest = 16 * 16 * 96;
  for (const size_t n : {size_t{1}, size_t{2}, size_t{3}, size_t{5}}) {
    double least = 1e30, most = 0, all = 0;
    for (size_t k = 0; k < n; ++k) {
      FilmRender share(of.scene(), options);
      ASSERT_TRUE(take_share(share, pass_of(film), k, n));
      const double samples = share.rest().samples;
      least = std::min(least, samples), most = std::max(most, samples), all += samples;
    }
    EXPECT_LE(most - least, largest) << n;
    EXPECT_EQ(all, film.rest().samples) << n;
  }
}

TEST(FilmStates, WhatIsThereIsThePictureOfItsSamples) {
  // With gaps: samples 0 to 6 and 64 of 100, whatever is between.
  const World of = film_world("", "random");
  FilmRender gaps(of.scene(), {}), none(of.scene(), {});
  const std::string first = part_of(of, {}, 0, 7), second = part_of(of, {}, 64, 65);
  for (const std::string& part : {first, second}) {
    ByteReader in(part);
    ASSERT_TRUE(gaps.merge(in, FilmRender::Gaps::Allowed));
  }
  EXPECT_EQ(gaps.result().samples_per_pixel, 8);
  EXPECT_TRUE(merge(none, first) && !merge(none, second));
}

TEST(FilmStates, OthersAreRefused) {
  const World of = film_world("", "sobol"), filtered = film_world(kGaussian, "sobol");
  FilmRender film(of.scene(), {}), other(filtered.scene(), {}), adaptive(of.scene(), options_for(true, true, false)),
      layers(of.scene(), options_for(false, false, true));
  ASSERT_TRUE(film.extend(4));
  const std::string state = state_of(film);
  EXPECT_FALSE(restore(other, state));
  EXPECT_FALSE(restore(adaptive, state));
  EXPECT_FALSE(restore(layers, state));
  for (const size_t size : {size_t{0}, size_t{7}, state.size() / 2, state.size() - 1}) {
    FilmRender cut(of.scene(), {});
    EXPECT_FALSE(restore(cut, state.substr(0, size))) << size;
  }
  FilmRender more(of.scene(), {});
  EXPECT_FALSE(restore(more, state + "x"));
}

TEST(FilmStates, NotesComeBack) {
  const World of = film_world("", "sobol");
  FilmRender film(of.scene(), {}), on(of.scene(), {});
  ASSERT_TRUE(film.extend(std::vector<uint32_t>(film.units().size(), 4), "a note"));
  ASSERT_TRUE(restore(on, state_of(film)));
  EXPECT_EQ(on.note(), "a note");
}

}  // namespace
}  // namespace whit
