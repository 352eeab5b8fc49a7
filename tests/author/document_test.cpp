#include "core/author/document.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace whit::author {
namespace {

TEST(Document, CountsInUnitsOfUtf16) {
  // One byte, two bytes, three bytes, four bytes that are two units.
  const Document d("a\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80z\n", Encoding::Utf16);
  EXPECT_EQ(d.position(0), (Position{0, 0}));
  EXPECT_EQ(d.position(1), (Position{0, 1}));
  EXPECT_EQ(d.position(3), (Position{0, 2}));
  EXPECT_EQ(d.position(6), (Position{0, 3}));
  EXPECT_EQ(d.position(10), (Position{0, 5}));
  EXPECT_EQ(d.offset({0, 5}), 10u);
  // Between the halves of a character.
  EXPECT_EQ(d.offset({0, 4}), 6u);
}

TEST(Document, CountsBytesWhereAskedTo) {
  const Document d("\xc3\xa9z", Encoding::Utf8);
  EXPECT_EQ(d.position(2), (Position{0, 2}));
  EXPECT_EQ(d.offset({0, 2}), 2u);
}

TEST(Document, KnowsAllEndsOfLines) {
  const Document d("a\r\nb\rc\nd", Encoding::Utf16);
  EXPECT_EQ(d.lines(), 4u);
  EXPECT_EQ(d.position(3), (Position{1, 0}));
  EXPECT_EQ(d.position(5), (Position{2, 0}));
  EXPECT_EQ(d.position(7), (Position{3, 0}));
  EXPECT_EQ(d.line(0), (Span{0, 1}));
  EXPECT_EQ(d.line(1), (Span{3, 4}));
  EXPECT_EQ(d.line(3), (Span{7, 8}));
}

TEST(Document, TakesPositionsBehindTheEnd) {
  const Document d("ab\ncd", Encoding::Utf16);
  EXPECT_EQ(d.offset({0, 99}), 2u);
  EXPECT_EQ(d.offset({9, 0}), 5u);
  EXPECT_EQ(d.position(99), (Position{1, 2}));
  EXPECT_EQ(Document("", Encoding::Utf16).offset({0, 1}), 0u);
}

TEST(Document, TakesBytesThatAreNoUtf8) {
  const Document d("\xff\xc3", Encoding::Utf16);
  EXPECT_EQ(d.position(2), (Position{0, 2}));
  EXPECT_EQ(utf16_length("\xf0\x9f"), 2u);
}

TEST(Document, EditsJoinAndPartLines) {
  Document d("a\r\nb", Encoding::Utf16);
  d.replace({1, 2}, "");
  EXPECT_EQ(d.text(), "a\nb");
  d.replace({1, 1}, "\r");
  EXPECT_EQ(d.lines(), 2u);
  d.replace({1, 3}, "");
  EXPECT_EQ(d.lines(), 1u);
}

TEST(Document, PositionsGoThereAndBack) {
  std::mt19937 random(1);
  const std::string pieces[] = {"a", "\n", "\r\n", "\xc3\xa9", "\xf0\x9f\x98\x80", " "};
  for (int run = 0; run < 50; ++run) {
    std::string text;
    std::vector<size_t> starts;
    for (int i = 0; i < 40; ++i) {
      starts.push_back(text.size());
      text += pieces[random() % std::size(pieces)];
    }
    for (const Encoding encoding : {Encoding::Utf8, Encoding::Utf16}) {
      const Document d(text, encoding);
      for (const size_t at : starts) EXPECT_EQ(d.offset(d.position(at)), at);
    }
  }
}

}  // namespace
}  // namespace whit::author
