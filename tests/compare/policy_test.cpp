#include "core/compare/policy.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace whit {
namespace {

namespace fs = std::filesystem;

class PolicyFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "whit-policy-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  Result<Policy> read(const std::string& text) const {
    std::ofstream(folder_ / "policy.json", std::ios::binary) << text;
    return read_policy((folder_ / "policy.json").string());
  }
  /// The policy of one rule for all pictures.
  Result<Policy> rule(const std::string& says) const { return read(R"({"rules": [{"match": "**", )" + says + "}]}"); }
  CompareSettings good(const std::string& says) const {
    const Result<Policy> policy = rule(says);
    EXPECT_EQ(policy.error, "") << says;
    return policy.value.settings_for("a.exr");
  }
  /// Every part is in the error, which begins with the file and the place.
  static void expect_error(const Result<Policy>& policy, const std::vector<std::string>& parts) {
    EXPECT_NE(policy.error.find("policy.json: "), std::string::npos) << policy.error;
    for (const std::string& part : parts) EXPECT_NE(policy.error.find(part), std::string::npos) << policy.error;
  }

  fs::path folder_;
};

TEST(MatchesPath, StarStaysWithinAFolder) {
  EXPECT_TRUE(matches_path("*.exr", "a.exr"));
  EXPECT_TRUE(matches_path("*.exr", ".exr"));
  EXPECT_TRUE(matches_path("a/*/c.exr", "a/b/c.exr"));
  EXPECT_TRUE(matches_path("*a*b*", "xxaxxbxx"));
  EXPECT_FALSE(matches_path("*.exr", "a/b.exr"));
  EXPECT_FALSE(matches_path("a/*", "a/b/c.exr"));
  EXPECT_FALSE(matches_path("*.exr", "a.exr.png"));
  EXPECT_FALSE(matches_path("a*b", "a/b"));
}

TEST(MatchesPath, TwoStarsCrossFolders) {
  for (const char* name : {"a.exr", "a/b.exr", "a/b/c.exr"}) {
    EXPECT_TRUE(matches_path("**", name));
    EXPECT_TRUE(matches_path("**/*.exr", name));
    EXPECT_TRUE(matches_path("**.exr", name));
    EXPECT_TRUE(matches_path("a**", name));
  }
  EXPECT_TRUE(matches_path("a/**/c.exr", "a/c.exr"));
  EXPECT_TRUE(matches_path("a/**/c.exr", "a/x/y/c.exr"));
  EXPECT_TRUE(matches_path("a/**", "a/x/y/c.exr"));
  EXPECT_FALSE(matches_path("a/**", "ab/c.exr"));
  EXPECT_FALSE(matches_path("a/**/c.exr", "a/xc.exr"));
  EXPECT_FALSE(matches_path("**/b.exr", "ab.exr"));
  EXPECT_FALSE(matches_path("a**/c", "ac"));  // ** are whole folders only where they stand alone
}

TEST(MatchesPath, QuestionMarkIsOneCharacter) {
  EXPECT_TRUE(matches_path("a?.exr", "ab.exr"));
  EXPECT_TRUE(matches_path("a?.exr", "a\xc3\xa4.exr"));  // a with two dots, two bytes
  EXPECT_TRUE(matches_path("a?.exr", "a\xff.exr"));
  EXPECT_FALSE(matches_path("a?.exr", "a.exr"));
  EXPECT_FALSE(matches_path("a?b", "a/b"));
  EXPECT_FALSE(matches_path("a?.exr", "abc.exr"));
}

TEST(MatchesPath, OthersStandForThemselves) {
  EXPECT_TRUE(matches_path("a[1].exr", "a[1].exr"));
  EXPECT_FALSE(matches_path("a.exr", "A.exr"));
  EXPECT_FALSE(matches_path("a.exr", "abexr"));
  EXPECT_TRUE(matches_path("", ""));
  EXPECT_FALSE(matches_path("", "a"));
}

TEST(MatchesPath, TakesNoTimeForManyStars) {
  std::string pattern;
  for (int i = 0; i < 50; ++i) pattern += "*a";
  EXPECT_FALSE(matches_path(pattern, std::string(1000, 'a') + "b"));
}

TEST_F(PolicyFile, SaysAllThatTheCommandLineCan) {
  const CompareSettings s = good(R"("comment": "why", "fail_above": {"relmse_robust": 0.02, "block": "off"},
      "fail_below": {"ssim": 0.98}, "fail_pixels": "1%", "pixel_error": 0.01, "hard_fail": 0.5, "channels": "R,G,B",
      "noise": true, "alpha": 0.002, "exact": false, "allow_nonfinite": true, "colorspace": "sRGB", "skip": "why")");
  EXPECT_EQ(s.limits.at("relmse_robust"), 0.02);
  EXPECT_TRUE(std::isinf(s.limits.at("block")));
  EXPECT_EQ(s.limits.at("ssim"), 0.98);
  EXPECT_EQ(s.skip, "why");
  CompareRequest request;
  s.apply(request);
  EXPECT_EQ(request.limits.of, s.limits);
  EXPECT_EQ(request.limits.fail_pixels, 0.01);
  EXPECT_EQ(request.limits.pixel_error, 0.01);
  EXPECT_EQ(request.limits.hard_fail, 0.5);
  EXPECT_EQ(request.limits.alpha, 0.002);
  EXPECT_TRUE(request.limits.noise);
  EXPECT_TRUE(request.limits.allow_nonfinite);
  EXPECT_FALSE(request.limits.exact);
  EXPECT_EQ(request.pair.channels, "R,G,B");
  EXPECT_EQ(request.pair.colour_space, "sRGB");
}

// No value is above infinity, and none below minus infinity.
TEST_F(PolicyFile, SwitchesLimitsOff) {
  const CompareSettings s = good(R"("fail_above": {"block": "off"}, "fail_below": {"ssim": "off"},
      "hard_fail": "off", "fail_pixels": "off")");
  EXPECT_EQ(s.hard_fail, std::numeric_limits<double>::infinity());
  EXPECT_EQ(s.fail_pixels, 1.0);
  EXPECT_EQ(s.limits.at("block"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(s.limits.at("ssim"), -std::numeric_limits<double>::infinity());
}

TEST_F(PolicyFile, LeavesAloneWhatItDoesNotSay) {
  CompareRequest request;
  request.limits.of["block"] = 0.5;
  request.limits.alpha = 0.01;
  request.pair.channels = "A";
  good(R"("fail_above": {"relmse": 1})").apply(request);
  EXPECT_EQ(request.limits.of, (std::map<std::string, double>{{"block", 0.5}, {"relmse", 1}}));
  EXPECT_EQ(request.limits.alpha, 0.01);
  EXPECT_EQ(request.pair.channels, "A");
}

TEST_F(PolicyFile, LaterRulesWinForWhatTheySay) {
  const Result<Policy> policy = read(R"({"comment": "c", "rules": [
      {"match": "**", "fail_above": {"relmse": 1, "block": 2}, "channels": "R", "skip": "not yet"},
      {"match": "n*/**", "fail_above": {"block": 3}, "skip": false},
      {"match": "*/b.exr", "fail_above": {"block": 4}}]})");
  ASSERT_EQ(policy.error, "");
  using Of = std::map<std::string, double>;
  EXPECT_EQ(policy.value.settings_for("a.exr").limits, (Of{{"relmse", 1}, {"block", 2}}));
  EXPECT_EQ(policy.value.settings_for("night/a.exr").limits, (Of{{"relmse", 1}, {"block", 3}}));
  EXPECT_EQ(policy.value.settings_for("night/b.exr").limits, (Of{{"relmse", 1}, {"block", 4}}));
  EXPECT_EQ(policy.value.settings_for("night/b.exr").channels, "R");
  EXPECT_EQ(policy.value.settings_for("a.exr").skip, "not yet");
  EXPECT_EQ(policy.value.settings_for("night/a.exr").skip, "");
}

TEST_F(PolicyFile, CommandLineWins) {
  CompareSettings settings = good(R"("fail_above": {"relmse": 1, "block": 2}, "noise": true)"), command_line;
  command_line.limits["block"] = 5;
  command_line.noise = false;
  settings.lay(command_line);
  EXPECT_EQ(settings.limits, (std::map<std::string, double>{{"relmse", 1}, {"block", 5}}));
  EXPECT_EQ(settings.noise, false);
}

// With --exact nothing else is asked: a limit that somebody writes afterwards would be void.
TEST_F(PolicyFile, ALimitTakesEqualityBack) {
  const Result<Policy> policy = read(R"({"rules": [{"match": "**", "exact": true},
      {"match": "soft/*", "fail_above": {"relmse": 1}}, {"match": "soft/hard.exr", "exact": true}]})");
  ASSERT_EQ(policy.error, "");
  EXPECT_EQ(policy.value.settings_for("a.exr").exact, true);
  EXPECT_EQ(policy.value.settings_for("soft/a.exr").exact, false);
  EXPECT_EQ(policy.value.settings_for("soft/hard.exr").exact, true);
  expect_error(rule(R"("exact": true, "hard_fail": 1)"), {"/rules/0: asks for equal pictures and for limits"});
  expect_error(rule(R"("exact": true, "noise": true)"), {"/rules/0: asks for equal pictures and for limits"});
  CompareSettings settings = policy.value.settings_for("a.exr"), noise;
  noise.noise = true;
  settings.lay(noise);
  EXPECT_EQ(settings.exact, false);
}

TEST_F(PolicyFile, RulesThatMatchNothingAreNamed) {
  const Result<Policy> policy = read(R"({"rules": [{"match": "**"}, {"match": "b.exr"}, {"match": "x/**"}]})");
  ASSERT_EQ(policy.error, "");
  const std::vector<std::string> said = policy.value.unmatched({"a/b.exr", "a/c.exr"});
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].find("/rules/1/match: no picture matches \"b.exr\"; did you mean \"**/b.exr\"?"), std::string::npos)
      << said[0];
  EXPECT_NE(said[1].find("/rules/2/match: no picture matches \"x/**\""), std::string::npos) << said[1];
  EXPECT_EQ(policy.value.unmatched({"b.exr", "x/a.exr"}).size(), 0u);
}

TEST_F(PolicyFile, NamesAReferenceAsTheFolderDoes) {
  const Result<Policy> policy = read(R"({"rules": []})");
  ASSERT_EQ(policy.error, "");
  fs::create_directories(folder_ / "sub");
  EXPECT_EQ(policy.value.name_of((folder_ / "sub/a.exr").string()), "sub/a.exr");
  EXPECT_EQ(policy.value.name_of((folder_ / "sub/../a.exr").string()), "a.exr");
  EXPECT_EQ(policy.value.name_of("/elsewhere/a.exr"), "a.exr");
  EXPECT_EQ(policy.value.name_of((folder_ / "..what.exr").string()), "..what.exr");
}

// Without a folder of references nobody knows what the rules' names are relative to.
TEST_F(PolicyFile, RulesThatMissAReferenceOutsideAreNamed) {
  const std::string outside = "/elsewhere/refs/x.exr", inside = (folder_ / "sub/x.exr").string();
  const auto missed = [&](const std::string& match, const std::string& reference) {
    const Result<Policy> policy = read(fmt::format(R"({{"rules": [{{"match": "{}"}}]}})", match));
    EXPECT_EQ(policy.error, "");
    const std::vector<std::string> said = policy.value.missed(reference);
    EXPECT_LE(said.size(), 1u);
    return said.empty() ? "" : said[0];
  };
  for (const char* match : {"refs/x.exr", "refs/**", "elsewhere/*/x.exr"})
    EXPECT_NE(missed(match, outside)
                  .find("/rules/0/match: \"" + std::string(match) +
                        "\" is not for this picture, whose "
                        "name is \"x.exr\""),
              std::string::npos)
        << missed(match, outside);
  for (const char* match : {"x.exr", "**", "**/x.exr"}) EXPECT_EQ(missed(match, outside), "");
  EXPECT_NE(missed("y.exr", outside).find("policy.json: no rule is for \"x.exr\""), std::string::npos);
  // Below its folder names are certain, and rules may be for others.
  for (const char* match : {"sub/x.exr", "sub/*", "y.exr"}) EXPECT_EQ(missed(match, inside), "");
  EXPECT_NE(missed(folder_.filename().string() + "/sub/x.exr", inside).find("whose name is \"sub/x.exr\""),
            std::string::npos);
}

TEST_F(PolicyFile, NamesTheLineOfBadJson) {
  expect_error(read("{\"rules\": [\n  {\"match\" \"**\"}]}"), {"not JSON", "line 2, column 15"});
  expect_error(rule(R"("hard_fail": NaN)"), {"not JSON", "line 1", "numbers are finite"});
  expect_error(read("{\"rules\": [] // none\n}"), {"not JSON", "line 1", "\"comment\""});
  expect_error(read("{\"rules\": [],}"), {"not JSON", "line 1", "no comma"});
  expect_error(rule(R"("hard_fail": 1e999)"), {"1e999"});
  expect_error(read(""), {"not JSON"});
  expect_error(read(std::string("v/1\x01\x00\x02", 6)), {"not JSON", "line 1, column 1"});
}

TEST_F(PolicyFile, NamesTheFileThatIsNotThere) {
  const std::string path = (folder_ / "none.json").string();
  EXPECT_EQ(read_policy(path).error, path + ": cannot be read: No such file or directory");
  EXPECT_NE(read_policy(folder_.string()).error, "");
}

TEST_F(PolicyFile, UnknownNamesAreMistakes) {
  expect_error(rule(R"("fail_abov": {})"), {"/rules/0/fail_abov: a rule has no \"fail_abov\"", "\"fail_above\"?"});
  expect_error(rule(R"("zzzzzzzz": 1)"), {"/rules/0/zzzzzzzz: ", "it may have match, comment, fail_above"});
  // Of what is no policy nothing is quoted.
  EXPECT_EQ(read(R"({"auths": {"SECRET": 1}})").error.find("auths"), std::string::npos);
  EXPECT_EQ(read(R"({"rules": SECRET})").error.find("SECRET"), std::string::npos);
  expect_error(read(R"({"rule": []})"), {"/rule: a policy has no \"rule\"", "did you mean \"rules\"?"});
  expect_error(rule(R"("fail_above": {"relmse_robst": 1})"),
               {"/rules/0/fail_above/relmse_robst: there is no measure", "did you mean \"relmse_robust\"?"});
  expect_error(rule(R"("fail_above": {"a/b~": 1})"), {"/rules/0/fail_above/a~1b~0: there is no measure"});
}

TEST_F(PolicyFile, MeasuresFailOnOneSide) {
  expect_error(rule(R"("fail_above": {"ssim": 0.9})"), {"/fail_above/ssim: lower is worse", "\"fail_below\""});
  expect_error(rule(R"("fail_below": {"relmse": 0.9})"), {"/fail_below/relmse: lower is better", "\"fail_above\""});
}

TEST_F(PolicyFile, WrongTypesAreMistakes) {
  for (const char* key : {"exact", "noise", "allow_nonfinite"}) {
    for (const char* value : {"1", "\"true\"", "null", "[]"})
      expect_error(rule(fmt::format(R"("{}": {})", key, value)),
                   {fmt::format("/rules/0/{}: ", key), "not true or false"});
  }
  for (const char* key : {"hard_fail", "pixel_error"}) {
    for (const char* value : {"-1", "\"1\"", "null", "true"})
      expect_error(rule(fmt::format(R"("{}": {})", key, value)),
                   {fmt::format("/rules/0/{}: ", key), "is not a number"});
  }
  // As --alpha: 1e-12 to 0.5.
  for (const char* value : {"0", "1e-13", "0.51", "0.9", "1", "-0.1", "\"0.5\"", "true"})
    expect_error(rule(fmt::format(R"("alpha": {})", value)), {"/rules/0/alpha: ", "from 1e-12 to 0.5"});
  for (const double alpha : {1e-12, 0.5}) EXPECT_EQ(good(fmt::format(R"("alpha": {})", alpha)).alpha, alpha);
  for (const char* value : {"-1", "1.1", "\"1\"", "\"%\"", "\"101%\"", "\"-1%\"", "\"nan%\"", "\"1 %x\"", "true", "{}"})
    expect_error(rule(fmt::format(R"("fail_pixels": {})", value)), {"/rules/0/fail_pixels: ", "share of the pixels"});
  for (const char* value : {"3", "true", "\"\"", "null"})
    expect_error(rule(fmt::format(R"("skip": {})", value)), {"/rules/0/skip: "});
  for (const char* value : {"\"1\"", "-1", "null", "true", "[1]"})
    expect_error(rule(fmt::format(R"("fail_above": {{"relmse": {}}})", value)), {"/fail_above/relmse: "});
  for (const char* value : {"3", "[]", "null"})
    expect_error(rule(fmt::format(R"("fail_above": {})", value)), {"/rules/0/fail_above: ", "object of measures"});
  for (const char* key : {"channels", "colorspace", "comment"})
    expect_error(rule(fmt::format(R"("{}": 3)", key)), {fmt::format("/rules/0/{}: 3 is not ", key)});
  expect_error(read("[]"), {"an array is not a policy"});
  expect_error(read("{}"), {"no \"rules\""});
  expect_error(read(R"({"rules": {}})"), {"/rules: an object is not an array"});
  expect_error(read(R"({"rules": ["**"]})"), {"/rules/0: \"**\" is not a rule"});
  expect_error(read(R"({"rules": [], "comment": 3})"), {"/comment: is not a text"});
}

TEST_F(PolicyFile, ColourSpacesThatThereAreNotAreMistakes) {
  for (const char* space : {"foo", "sRGBB", "gamma=", "gamma=-1"})
    expect_error(rule(fmt::format(R"("colorspace": "{}")", space)), {"/rules/0/colorspace: ", space});
  for (const char* space : {"srgb", "linear", "Rec709", "gamma=2.2"})
    EXPECT_EQ(good(fmt::format(R"("colorspace": "{}")", space)).colour_space, space);
}

TEST_F(PolicyFile, SharesArePercentToo) {
  EXPECT_EQ(good(R"("fail_pixels": "0.5%")").fail_pixels, 0.005);
  EXPECT_EQ(good(R"("fail_pixels": "100%")").fail_pixels, 1.0);
  EXPECT_EQ(good(R"("fail_pixels": 0)").fail_pixels, 0.0);
  expect_error(rule(R"("fail_pixels": 1)"), {"/rules/0/fail_pixels: 1 is all pixels", "write \"1%\""});
}

TEST_F(PolicyFile, PatternsThatCanMatchNothingAreMistakes) {
  for (const char* match : {"", "/a.exr", "./a.exr", "a/", "../a.exr", "a/../b.exr", "a//b.exr"})
    expect_error(read(fmt::format(R"({{"rules": [{{"match": "{}"}}]}})", match)),
                 {"/rules/0/match: ", "match nothing"});
  expect_error(read(R"({"rules": [{"exact": true}]})"), {"/rules/0: the rule has no \"match\""});
  expect_error(read(R"({"rules": [{"match": 3}]})"), {"/rules/0/match: 3 is not a pattern"});
}

// The parser would keep the second and say nothing.
TEST_F(PolicyFile, KeysThatAreThereTwiceAreMistakes) {
  expect_error(read(R"({"rules": [{"match": "**"}, {"match": "**", "exact": true, "exact": false}]})"),
               {"/rules/1/exact: is there twice"});
  expect_error(rule(R"("fail_above": {"block": 1, "relmse": 2, "block": 3})"),
               {"/rules/0/fail_above/block: is there twice"});
  expect_error(read(R"({"rules": [], "rules": []})"), {"/rules: is there twice"});
}

TEST_F(PolicyFile, NamesAllMistakesAtOnce) {
  const Result<Policy> policy = rule(R"("exact": 1, "noise": 2, "aplha": 0.1)");
  expect_error(policy, {"/rules/0/exact", "/rules/0/noise", "did you mean \"alpha\"?"});
  EXPECT_EQ(std::count(policy.error.begin(), policy.error.end(), '\n'), 2);
}

}  // namespace
}  // namespace whit
