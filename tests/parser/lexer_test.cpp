#include "parser/lexer.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

struct Lexed {
  explicit Lexed(std::string source) : text(std::move(source)), lexer(text, 0, reporter) {}
  std::string text;
  Diagnostics diagnostics;
  Reporter reporter{diagnostics};
  Lexer lexer;
};

std::vector<double> numbers(const std::string& text) {
  Lexed in(text);
  std::vector<double> out;
  EXPECT_TRUE(in.lexer.read_numbers(out)) << text;
  EXPECT_EQ(in.lexer.peek().kind, TokenKind::End) << text;
  return out;
}

TEST(Lexer, Tokens) {
  Lexed in("\xef\xbb\xbfShape\"sphere\"#comment\n[1]foo");
  const std::pair<TokenKind, std::string> expected[] = {
      {TokenKind::Word, "Shape"}, {TokenKind::String, "\"sphere\""}, {TokenKind::Open, "["}, {TokenKind::Number, "1"},
      {TokenKind::Close, "]"},    {TokenKind::Word, "foo"},          {TokenKind::End, ""}};
  for (const auto& [kind, text] : expected) {
    const Token token = in.lexer.next();
    EXPECT_EQ(token.kind, kind);
    EXPECT_EQ(token.text, text);
  }
}

TEST(Lexer, NumberForms) {
  EXPECT_EQ(numbers("1 +2 -3 .5 5. 1e5 1E-2 +.5e+1 -0"), (std::vector<double>{1, 2, -3, 0.5, 5, 1e5, 0.01, 5, 0}));
  EXPECT_EQ(numbers("1e-999 -1e-999"), (std::vector<double>{0, 0}));
  EXPECT_EQ(numbers("4.9e-324 1.7976931348623157e308"), (std::vector<double>{4.9e-324, 1.7976931348623157e308}));
  EXPECT_EQ(numbers("0.00000000000000000000000000000000000000001")[0], 1e-41);
}

TEST(Lexer, NumbersRoundTripExactly) {
  // The short cut for short numbers and the slow way must both round correctly: the shortest and the
  // 25-digit form of any double read back as that double.
  std::mt19937_64 random(7);
  for (int i = 0; i < 200000; ++i) {
    const uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (i % 2 == 0) value = static_cast<double>(static_cast<int64_t>(bits) >> 20) / 1e6;
    if (!std::isfinite(value)) continue;
    char text[64];
    *std::to_chars(text, text + 60, value).ptr = '\0';
    ASSERT_EQ(numbers(text)[0], value) << text;
    std::snprintf(text, sizeof text, "%.25e", value);
    ASSERT_EQ(numbers(text)[0], value) << text;
  }
}

TEST(Lexer, MalformedNumbers) {
  for (const char* bad : {"1.5x", "--1", "+", ".", "1e", "1e+", "1.2.3", "0x10", "-inf", "1e999", "1_000"}) {
    Lexed in(std::string("1 2 ") + bad + " 3");
    std::vector<double> out;
    EXPECT_FALSE(in.lexer.read_numbers(out)) << bad;
    ASSERT_EQ(in.diagnostics.all().size(), 1u) << bad;
    EXPECT_EQ(in.diagnostics.all()[0].where.offset, 4u) << bad;
    EXPECT_EQ(in.lexer.peek().text, bad);
  }
}

TEST(Lexer, Integers) {
  Lexed in("0 -1 +7 2147483647 -2147483648 1e3 5.0 2.75 -2.75");
  std::vector<int32_t> out;
  EXPECT_TRUE(in.lexer.read_integers(out));
  EXPECT_EQ(out, (std::vector<int32_t>{0, -1, 7, 2147483647, -2147483647 - 1, 1000, 5, 2, -2}));
  // One warning a list, at the first number that lost its fraction.
  ASSERT_EQ(in.diagnostics.all().size(), 1u);
  EXPECT_EQ(in.diagnostics.all()[0].severity, Severity::Warning);
  EXPECT_EQ(in.diagnostics.all()[0].where.offset, in.text.find("2.75"));
  for (const char* bad : {"2147483648", "-2147483649", "99999999999999999999", "1e10"}) {
    Lexed big(bad);
    EXPECT_FALSE(big.lexer.read_integers(out)) << bad;
    EXPECT_NE(big.diagnostics.all().at(0).message.find("out of range"), std::string::npos);
  }
}

TEST(Lexer, LongListsWithComments) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += std::to_string(i) + (i % 100 == 0 ? " # ] not the end\n" : " ");
  Lexed in(text + "]");
  std::vector<double> out;
  EXPECT_TRUE(in.lexer.read_numbers(out));
  ASSERT_EQ(out.size(), 5000u);
  EXPECT_EQ(out[4999], 4999);
  EXPECT_EQ(in.lexer.peek().kind, TokenKind::Close);
}

TEST(Lexer, Strings) {
  Lexed in(R"("a\n\t\"\\\'b" "C:\dir")");
  EXPECT_EQ(in.lexer.unquote(in.lexer.next()), "a\n\t\"\\'b");
  EXPECT_TRUE(in.diagnostics.all().empty());
  EXPECT_EQ(in.lexer.unquote(in.lexer.next()), "C:\\dir");
  ASSERT_EQ(in.diagnostics.all().size(), 1u);
  EXPECT_EQ(in.diagnostics.all()[0].where.offset, in.text.find("\\d"));
}

TEST(Lexer, EveryValueHasAPlace) {
  const Parsed parsed(
      in_world("Shape \"s\" \"float a\" [ 1 # one ]\n 22 333 ] \"string b\" \"x\" \"string c\" [\"y\"\"z\"]"));
  expect_clean(parsed);
  const ParameterList& p = parsed.scene().shapes.at(0).params;
  EXPECT_EQ(parsed.sources.location(value_position(parsed.sources, p.at(0), 0)), "test.pbrt:2:23");
  EXPECT_EQ(parsed.sources.location(value_position(parsed.sources, p.at(0), 1)), "test.pbrt:3:2");
  EXPECT_EQ(parsed.sources.location(value_position(parsed.sources, p.at(0), 2)), "test.pbrt:3:5");
  // No such value: where the list begins.
  EXPECT_EQ(parsed.sources.location(value_position(parsed.sources, p.at(0), 3)), "test.pbrt:2:21");
  EXPECT_EQ(parsed.sources.location(value_position(parsed.sources, p.at(1), 0)), "test.pbrt:3:22");
  EXPECT_EQ(parsed.sources.location(value_position(parsed.sources, p.at(2), 1)), "test.pbrt:3:41");
}

}  // namespace
}  // namespace whit
