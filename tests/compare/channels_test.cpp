#include "core/compare/channels.h"

#include <gtest/gtest.h>

#include <limits>

namespace whit {
namespace {

TEST(Channels, KindsByName) {
  for (const char* name : {"R", "G", "B", "Y", "Albedo.R", "beauty.key.B", "view.g"})
    EXPECT_EQ(channel_kind(name), ChannelKind::Colour) << name;
  for (const char* name : {"A", "Z", "N.X", "P.Y", "uv.U", "X"})
    EXPECT_EQ(channel_kind(name), ChannelKind::Data) << name;
  for (const char* name : {"shape.id", "CryptoShape00.r", "CryptoMaterial02.a", "id"})
    EXPECT_EQ(channel_kind(name), ChannelKind::Id) << name;
  for (const char* name : {"variance.R", "Variance.B", "view.variance.G", "samples"})
    EXPECT_EQ(channel_kind(name), ChannelKind::Statistic) << name;
}

TEST(Channels, LayersAreBeforeTheLastDot) {
  EXPECT_EQ(layer_of("R"), "");
  EXPECT_EQ(layer_of("Albedo.R"), "Albedo");
  EXPECT_EQ(layer_of("view.left.R"), "view.left");
}

TEST(Channels, SomeInfinitiesMeanSomething) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::string> all{"R", "Z", "left.Z", "depth.V", "N.X", "N.Z", "variance.R"};
  for (const char* name : {"Z", "left.Z", "depth", "depth.V", "variance.R"}) {
    EXPECT_FALSE(is_fault(name, all, inf)) << name;
    EXPECT_TRUE(is_fault(name, all, -inf)) << name;
    EXPECT_TRUE(is_fault(name, all, nan)) << name;
  }
  for (const char* name : {"R", "N.Z", "A"}) EXPECT_TRUE(is_fault(name, all, inf)) << name;
  EXPECT_FALSE(is_fault("R", all, 1e30f));
}

TEST(Channels, CryptomattesByAnyName) {
  for (const char* name : {"CryptoShape00.r", "crypto_object00.red", "ViewLayer.CryptoObject00.R"}) {
    EXPECT_EQ(channel_kind(name), ChannelKind::Id) << name;
    EXPECT_TRUE(is_first_matte_rank(name)) << name;
  }
  for (const char* name : {"CryptoShape00.g", "CryptoShape01.r", "cryptic.R", "R"})
    EXPECT_FALSE(is_first_matte_rank(name)) << name;
}

TEST(Channels, PatternsAreWhole) {
  EXPECT_TRUE(matches("Albedo.*", "Albedo.R"));
  EXPECT_FALSE(matches("Albedo", "Albedo.R"));
  EXPECT_TRUE(matches("?", "R"));
  EXPECT_FALSE(matches("?", "RG"));
  EXPECT_TRUE(matches("*.*.R", "view.left.R"));
}

TEST(Channels, ListsOfPatterns) {
  EXPECT_TRUE(matches_any("R,G,B", "G"));
  EXPECT_FALSE(matches_any("R,G,B", "A"));
  EXPECT_TRUE(matches_any("", "A"));  // No pattern is all.
  EXPECT_TRUE(matches_any("!variance.*", "R"));
  EXPECT_FALSE(matches_any("!variance.*", "variance.R"));
  EXPECT_FALSE(matches_any("*,!A", "A"));
  EXPECT_TRUE(matches_any("R, G , B", "G"));
  EXPECT_EQ(split_patterns(" R, ,!A"), (std::vector<std::string>{"R", "!A"}));
}

TEST(Channels, ManyStarsAreNoWork) {
  // One after another tried at every place of the text would be 200^12.
  EXPECT_FALSE(matches("*a*a*a*a*a*a*a*a*a*a*a*a*b", std::string(200, 'a')));
  EXPECT_TRUE(matches("*a*b*", "xxaxxbxx"));
}

}  // namespace
}  // namespace whit
