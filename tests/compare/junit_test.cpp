#include "core/compare/junit.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>

namespace whit {
namespace {

constexpr const char* kTime = "2026-11-29T18:49:00";

/// Every kind of case, with all that XML has another spelling for or no place for.
std::vector<JUnitCase> all_kinds() {
  return {{"same.exr", 0.25, "", "", "", "relmse 0\nblock 0\n"},
          {"silent.exr", 0, "", "", "", ""},
          {"sub/differs.exr", 1.5, "relmse 0.03 is above 0.02", "", "", "relmse 0.03\nblock 0.01"},
          {"cannot.exr", 0.125, "", "sizes differ", "", ""},
          {"both.exr", 0, "differs", "cannot", "skipped", ""},
          {"skipped.exr", 0, "", "", "no GPU here", ""},
          {"<&>\"' .exr", 0, "<&>\"'", "", "", "]]> <![CDATA[ &amp; <!-- -->"},
          {"tab\tline\nreturn\r.exr", 0, "a\tb\nc\rd", "", "", "a\tb\nc\rd"},
          {std::string("control\0\x01\x1b[31m\x7f.exr", 19), 0, "\x1b[0m", "", "", "\x02"},
          {"bytes\xff\xc3(\xe2\x82.exr", 0, "\xf8\x88", "", "", "\xc0\x80 \xed\xa0\x80 \xf4\x90\x80\x80"},
          {"letters\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80\xef\xbf\xbe.exr", 0, "\xef\xbf\xbf", "", "", ""},
          {"", std::numeric_limits<double>::quiet_NaN(), "", "empty name", "", ""},
          {"endless.exr", std::numeric_limits<double>::infinity(), "", "", "", ""},
          {"back.exr", -1, "", "", "", ""}};
}

TEST(JUnit, CountsEachCaseOnce) {
  const std::string text = junit_text("refs", all_kinds(), kTime);
  EXPECT_NE(text.find("tests=\"14\" failures=\"6\" errors=\"3\" skipped=\"1\" time=\"1.875\""), std::string::npos)
      << text;
}

TEST(JUnit, WritesACaseForEachPicture) {
  EXPECT_EQ(junit_text("refs", {{"a.exr", 0.5, "relmse 1 is above 0", "", "", "relmse 1"}}, kTime),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<testsuites>\n"
            "  <testsuite name=\"refs\" package=\"whit\" id=\"0\" timestamp=\"2026-11-29T18:49:00\" "
            "hostname=\"localhost\" tests=\"1\" failures=\"1\" errors=\"0\" skipped=\"0\" time=\"0.500\">\n"
            "    <properties/>\n"
            "    <testcase classname=\"refs\" name=\"a.exr\" time=\"0.500\">\n"
            "      <failure type=\"differs\" message=\"relmse 1 is above 0\">relmse 1</failure>\n"
            "    </testcase>\n"
            "    <system-out></system-out>\n"
            "    <system-err/>\n"
            "  </testsuite>\n"
            "</testsuites>\n");
}

// Different names stay different.
TEST(JUnit, SpellsOutWhatXmlCannotHold) {
  const auto name = [](const std::string& of) {
    const std::string text = junit_text("s", {{of, 0, "", "", "", ""}}, kTime), before = "classname=\"s\" name=\"";
    const size_t start = text.find(before) + before.size();
    return text.substr(start, text.find('"', start) - start);
  };
  EXPECT_EQ(name("a\x01"
                 "b"),
            "a\\x01b");
  EXPECT_EQ(name("a\xff\xfe"), "a\\xff\\xfe");
  EXPECT_EQ(name("\xc3\xa4"), "\xc3\xa4");
  EXPECT_EQ(name("\xc3"), "\\xc3");                             // ends within a character
  EXPECT_EQ(name("\xc0\xaf"), "\\xc0\\xaf");                    // longer than need be
  EXPECT_EQ(name("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // half of a pair of UTF-16
  EXPECT_EQ(name("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  EXPECT_EQ(name("\xef\xbf\xbf"), "\\xef\\xbf\\xbf");           // U+FFFF
  EXPECT_EQ(name("\xf0\x9f\x98\x80"), "\xf0\x9f\x98\x80");
  EXPECT_EQ(name("<\"&\n"), "&#60;&#34;&#38;&#10;");
}

TEST(JUnit, NamesASuiteWithoutAName) {
  EXPECT_NE(junit_text("", {}, kTime).find("<testsuite name=\"whit diff\""), std::string::npos);
}

// For tests/compare/junit_test.py, which asks the schema.
TEST(JUnit, WritesFilesForTheSchemaTest) {
  const char* folder = std::getenv("WHIT_JUNIT_FILES");
  if (folder == nullptr) GTEST_SKIP() << "WHIT_JUNIT_FILES is not set";
  std::ofstream(std::string(folder) + "/all.xml") << junit_text("refs <&> \x07", all_kinds(), kTime);
  std::ofstream(std::string(folder) + "/none.xml") << junit_text("", {}, kTime);
}

}  // namespace
}  // namespace whit
