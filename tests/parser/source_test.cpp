#include "parser/source.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

TEST(Sources, PlaceCountsFromOneAndInCodePoints) {
  Sources sources;
  const uint32_t file = sources.add_text("a.pbrt", "one\nt\xc3\xa4!\n");
  EXPECT_EQ(sources.place({file, 0}).line, 1u);
  EXPECT_EQ(sources.place({file, 0}).column, 1u);
  // The '!' is the fourth byte of its line, but the third character.
  EXPECT_EQ(sources.place({file, 7}).line, 2u);
  EXPECT_EQ(sources.place({file, 7}).column, 3u);
  // Behind the end: the end.
  EXPECT_EQ(sources.location({file, 1000}), "a.pbrt:3:1");
  EXPECT_EQ(sources.location({}), "");
}

TEST(Sources, PlaceInAFileLongerThanABlock) {
  // Lines are counted in blocks of 1 MiB; 3 MB of lines of ten bytes cross several.
  std::string text;
  for (int i = 0; i < 300000; ++i) text += "123456789\n";
  Sources sources;
  const uint32_t file = sources.add_text("long", std::move(text));
  EXPECT_EQ(sources.place({file, 2999995}).line, 300000u);
  EXPECT_EQ(sources.place({file, 2999995}).column, 6u);
  EXPECT_EQ(sources.place({file, 25}).line, 3u);
}

TEST(Sources, OpensFilesOnce) {
  const std::string path = test::temp_folder() + "/whit_source_test.txt";
  std::ofstream(path) << "hello\n";
  Sources sources;
  std::string problem;
  const auto file = sources.open(path, problem);
  ASSERT_TRUE(file.has_value()) << problem;
  EXPECT_EQ(sources.text(*file), "hello\n");
  EXPECT_EQ(sources.name(*file), path);
  EXPECT_EQ(sources.open(path, problem), file);
  EXPECT_EQ(sources.size(), 1u);
  std::filesystem::remove(path);
}

TEST(Sources, WhatIsReleasedCanBeReadAgain) {
  const std::string path = test::temp_folder() + "/whit_source_release.txt";
  std::string text;
  for (int i = 0; i < 5000; ++i) text += std::to_string(i) + "\n";  // 24 KB: more than one page, whatever its size is
  std::ofstream(path) << text;
  Sources sources;
  std::string problem;
  const auto file = sources.open(path, problem);
  ASSERT_TRUE(file.has_value()) << problem;
  const uint32_t own = sources.add_text("own", text);
  for (const uint32_t f : {*file, own, 7u}) {
    sources.release(f, 0, 10000);
    sources.release(f, 10000, text.size() + 1000000);
  }
  EXPECT_EQ(sources.text(*file), text);
  EXPECT_EQ(sources.text(own), text);
  std::filesystem::remove(path);
}

TEST(Sources, EmptyFileMissingFileAndFolder) {
  const std::string path = test::temp_folder() + "/whit_source_empty.txt";
  std::ofstream(path).close();
  Sources sources;
  std::string problem;
  const auto file = sources.open(path, problem);
  ASSERT_TRUE(file.has_value()) << problem;
  EXPECT_EQ(sources.text(*file), "");
  std::filesystem::remove(path);
  EXPECT_FALSE(sources.open(path, problem).has_value());
  EXPECT_EQ(problem, "No such file or directory");
  EXPECT_FALSE(sources.open(test::temp_folder(), problem).has_value());
  EXPECT_EQ(problem, "Is a directory");
  // A device may have no end.
  EXPECT_FALSE(sources.open("/dev/zero", problem).has_value());
  EXPECT_EQ(problem, "it is not a regular file");
}

TEST(RenderDiagnostic, PlaceLineCaretAndRemedy) {
  Sources sources;
  const uint32_t file = sources.add_text("scene.pbrt", "\nShape \"sphere\" \"float raduis\" [1]\n");
  const Diagnostic d{
      Severity::Error, ErrorClass::Scene, {file, 16}, "sphere has no parameter \"raduis\"", "did you mean \"radius\"?"};
  EXPECT_EQ(sources.render_diagnostic(d, false),
            "scene.pbrt:2:16: error: sphere has no parameter \"raduis\"\n"
            "    Shape \"sphere\" \"float raduis\" [1]\n"
            "                   ^\n"
            "  did you mean \"radius\"?\n");
  EXPECT_NE(sources.render_diagnostic(d, true).find("\033[1;31merror:\033[0m"), std::string::npos);
}

TEST(RenderDiagnostic, WithoutAPlace) {
  const Diagnostic d{Severity::Warning, ErrorClass::Scene, {}, "odd", ""};
  EXPECT_EQ(Sources().render_diagnostic(d, false), "warning: odd\n");
}

TEST(RenderDiagnostic, TabsAndBinaryBytesKeepTheCaretInPlace) {
  Sources sources;
  const uint32_t file = sources.add_text("t", "\t\x01\xff\xc3\xa4x");
  const Diagnostic d{Severity::Error, ErrorClass::Scene, {file, 5}, "m", ""};
  // A tab is four columns, \x01 and \xff are four each, the umlaut is one: the caret is in column 13.
  EXPECT_EQ(sources.render_diagnostic(d, false), "t:1:5: error: m\n        \\x01\\xff\xc3\xa4x\n                 ^\n");
}

TEST(RenderDiagnostic, LongLinesAreWindowed) {
  Sources sources;
  const std::string text = std::string(5000, 'a') + "!" + std::string(5000, 'b') + "\n";
  const uint32_t file = sources.add_text("t", text);
  const Diagnostic d{Severity::Error, ErrorClass::Scene, {file, 5000}, "m", ""};
  EXPECT_EQ(sources.render_diagnostic(d, false), "t:1:5001: error: m\n    ... " + std::string(50, 'a') + "!" +
                                                     std::string(49, 'b') + " ...\n        " + std::string(50, ' ') +
                                                     "^\n");
  const Diagnostic first{Severity::Error, ErrorClass::Scene, {file, 0}, "m", ""};
  EXPECT_EQ(sources.render_diagnostic(first, false), "t:1:1: error: m\n    " + std::string(100, 'a') + " ...\n    ^\n");
}

TEST(WhyNotText, KnowsWhatIsNoScene) {
  EXPECT_EQ(why_not_text("WorldBegin # \xc3\xa4\n"), "");
  EXPECT_EQ(why_not_text("# Latin-1: caf\xe9, na\xefve\nWorldBegin\n"), "");
  EXPECT_EQ(why_not_text(std::string_view("ab\0c", 4)), "it holds binary data");
  EXPECT_EQ(why_not_text("\x01\x02\x03\x04"), "it holds binary data");
  EXPECT_EQ(why_not_text("\x1f\x8b\x08"), "it is compressed with gzip");
  EXPECT_EQ(why_not_text("\xff\xfeW"), "it is UTF-16 text, not UTF-8");
}

TEST(InQuotes, EscapesAndCuts) {
  EXPECT_EQ(in_quotes("a\x07"), "\"a\\x07\"");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), fmt::format("\"{:x<60}...\"", ""));
}

TEST(DidYouMean, FindsSlips) {
  const std::vector<std::string> names = {"radius", "zmin", "zmax", "phimax", "Kd"};
  EXPECT_EQ(did_you_mean("raduis", names), "did you mean \"radius\"?");
  EXPECT_EQ(nearest_name("Radius", names), "radius");
  EXPECT_EQ(nearest_name("kd", names), "Kd");
  EXPECT_EQ(nearest_name("RADIUS", names), "radius");  // More than a third of the letters, but the same ones.
  EXPECT_EQ(nearest_name("Ks", names), "");
  EXPECT_EQ(nearest_name("banana", names), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), names), "");
}

TEST(Sources, NothingReachesATerminalRaw) {
  // Colours, a title, C1 controls and a change of direction: in names of files, messages and remedies.
  const std::string hostile = "\x1b[31m\x1b]0;t\x07\xc2\x9b\xe2\x80\xae.\r\n";
  const std::string shown = "\\x1b[31m\\x1b]0;t\\x07\\xc2\\x9b\\u202e.\\x0d\\x0a";
  EXPECT_EQ(printable(hostile), shown);
  EXPECT_EQ(in_quotes(hostile), '"' + shown + '"');
  EXPECT_EQ(quoted_path(hostile), '"' + shown + '"');
  Sources sources;
  const uint32_t file = sources.add_text(hostile, hostile);
  Diagnostic d{Severity::Error, ErrorClass::Scene, {file, 0}, hostile, hostile};
  d.other = {file, 3};
  for (const char c : sources.render_diagnostic(d, false)) EXPECT_TRUE(c == '\n' || (c >= ' ' && c < 0x7f));
  EXPECT_EQ(printable("caf\xc3\xa9 \xe6\x9c\xa8"), "caf\xc3\xa9 \xe6\x9c\xa8");  // Letters stay.
}

TEST(Sources, APathKeepsItsEnd) {
  EXPECT_EQ(quoted_path("/a/b.pbrt"), "\"/a/b.pbrt\"");
  const std::string folders = '/' + std::string(990, 'x');
  EXPECT_EQ(quoted_path(folders + "/b.pbrt"), '"' + folders + "/b.pbrt\"");
  const std::string cut = quoted_path(std::string(5000, 'x') + "/b.pbrt");
  EXPECT_EQ(cut.size(), 1005u);
  EXPECT_EQ(cut.substr(0, 5), "\"...x");
  EXPECT_EQ(cut.substr(cut.size() - 8), "/b.pbrt\"");
  // Not in the middle of a letter.
  std::string letters;
  for (int i = 0; i < 1000; ++i) letters += "\xc3\xa9";
  EXPECT_EQ(quoted_path(letters + "x").substr(0, 6), "\"...\xc3\xa9");
}

}  // namespace
}  // namespace whit
