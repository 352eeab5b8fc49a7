// The state of a film: what goes on from it has the bits of a film that was never stopped.
#include <gtest/gtest.h>

#include <string>

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
