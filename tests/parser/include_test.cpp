// Files of a scene that are not what a scene expects: without end, no scenes at all, or changing while they are read.
#include "parser/include.h"

#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/limits.h"
#include "core/base/mapped_file.h"
#include "parser/format.h"
#include "tests/base/temp_folder.h"
#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

class SceneFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(test::temp_folder()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  /// All that parsing a file says, and then all that formatting says with its includes expanded.
  std::string messages(const std::string& name) const {
    Sources parsed, formatted;
    const Diagnostics of_parser = parse_file(parsed, path(name)).diagnostics;
    std::string out;
    for (const Diagnostic& d : of_parser.all()) out += parsed.render_diagnostic(d, false);
    FormatOptions options;
    options.expand_includes = true;
    std::ostringstream text;
    const Diagnostics of_formatter = format_file(formatted, path(name), text, options);
    out += "fmt:\n";
    for (const Diagnostic& d : of_formatter.all()) out += formatted.render_diagnostic(d, false);
    return out;
  }

  fs::path folder_;
};

using IncludeLimits = SceneFiles;
using HiddenText = SceneFiles;
using ChangingScenes = SceneFiles;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST_F(IncludeLimits, FilesIncludeOneAnotherSoDeepAndNoDeeper) {
  // Number 0 is the main file.
  const int deepest = static_cast<int>(kIncludeDepth.most);
  for (int i = 0; i < deepest; ++i)
    write(std::to_string(i), i + 1 < deepest ? "Include \"" + std::to_string(i + 1) + "\"\n" : "Identity\n");
  EXPECT_FALSE(holds(messages("0"), "deep")) << messages("0");
  write(std::to_string(deepest - 1), "Identity Include \"" + std::to_string(deepest) + "\"\n");
  write(std::to_string(deepest), "Identity\n");
  const std::string said = messages("0");
  // The last that is read has the place, in both.
  const std::string line = path(std::to_string(deepest - 1)) +
                           ":1:18: error: files include one another more than 256 deep, the limit "
                           "include-depth";
  const size_t first = said.find(line);
  ASSERT_NE(first, said.npos) << said;
  EXPECT_NE(said.find(line, first + 1), said.npos) << said;
}

TEST_F(IncludeLimits, DoublingComesToAnEnd) {
  // Followed to their ends these are 2^39 files.
  for (int i = 0; i < 40; ++i) {
    const std::string next = i < 39 ? "Include \"" + std::to_string(i + 1) + "\"\n" : "Identity\n";
    write(std::to_string(i), next + next);
  }
  const std::string said = messages("0");
  const std::string line = "error: files are included more than 500000 times, the limit includes";
  const size_t first = said.find(line), second = said.find(line, first + 1);
  ASSERT_NE(first, said.npos) << said;
  ASSERT_NE(second, said.npos) << said;
  EXPECT_EQ(said.find(line, second + 1), said.npos) << "said once each";
}

TEST_F(IncludeLimits, OneFileMayBeIncludedVeryOften) {
  write("part", "Identity\n");
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "Include \"part\"\n";
  write("scene", text + "WorldBegin\nWorldEnd\n");
  EXPECT_EQ(messages("scene"), "fmt:\n");
}

TEST_F(IncludeLimits, WhatHasNoEndIsNotOpened) {
  write("scene",
        "Include \"pipe\"\nInclude \"/dev/zero\"\nInclude \"/dev/stdin\"\nInclude \".\"\nWorldBegin\nWorldEnd\n");
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  Sources sources;
  std::vector<std::string> said;
  const ParseResult result = parse_file(sources, path("scene"));
  for (const Diagnostic& d : result.diagnostics.all()) {
    EXPECT_EQ(d.error_class, ErrorClass::File);
    said.push_back(d.message);
    EXPECT_EQ(sources.place(d.where).line, said.size());
  }
  // Standard input of the tests may be a file; nothing is said of one then but that it is no scene.
  ASSERT_GE(said.size(), 3u);
  EXPECT_TRUE(said[0].ends_with("pipe\": it is not a regular file")) << said[0];
  EXPECT_TRUE(said[1].ends_with("/dev/zero\": it is not a regular file")) << said[1];
  EXPECT_TRUE(said.back().ends_with("Is a directory")) << said.back();
  EXPECT_TRUE(
      holds(messages("pipe"), "it is not a regular file\n  a scene can be read from standard input: name it -"));
}

TEST_F(HiddenText, OfFilesThatAreNoScenes) {
  const std::string secrets[] = {
      "root:$6$SECRET:19000:0:99999:7:::\ndaemon:*:19000\n",
      "# comment\n\n[SECRET]\nkey = value\n",
      "\"SECRET\" [ 1 2 3 ]\n",
      "-----BEGIN SECRET KEY-----\nabc\n",
      "// SECRET\n",
      "{\"auths\": {\"SECRET\": 1}}",
      "12345 SECRET\n",
      "machine SECRET login me\n",
      "ls SECRET\nShape \"sphere\"\n",
      std::string("SECRET\0", 7),
  };
  for (const std::string& secret : secrets) {
    write("secret", secret);
    write("scene", "Include \"secret\"\nWorldBegin\nInclude \"secret\"\nWorldEnd\n");
    for (const char* name : {"scene", "secret"}) {
      const std::string said = messages(name);
      EXPECT_FALSE(holds(said, "SECRET")) << said;
      EXPECT_TRUE(holds(said, std::string(name) + ":")) << said;
      EXPECT_TRUE(holds(said, "scene file: it ")) << said;
    }
  }
  // The line of the scene itself is shown, as ever.
  EXPECT_TRUE(holds(messages("scene"), "    Include \"secret\"\n"));
}

TEST_F(HiddenText, WhatBeginsLikeASceneIsShown) {
  for (const std::string first : {"Camra", "camera", "ColorSpace", "\xef\xbb\xbf# x\nShape", "Shap"}) {
    write("scene", first + " \"MISTAKE\n");
    EXPECT_TRUE(holds(messages("scene"), "MISTAKE\n")) << messages("scene");
  }
  // Text that is no file is the user's own.
  const Parsed own("nonsense MISTAKE\n");
  EXPECT_TRUE(holds(own.messages(), "    nonsense MISTAKE\n")) << own.messages();
}

/// Does something to the scene's files when they have been opened and before they are read.
class Meddler final : public ModelReader {
 public:
  explicit Meddler(std::function<void()> meddle) : meddle_(std::move(meddle)) {}
  void begin() override { meddle_(); }
  std::optional<ModelStatements> read(const ModelRequest&, Diagnostics&) override { return std::nullopt; }
  std::shared_ptr<const Attachment> attachment(const std::string&) const override { return nullptr; }

 private:
  std::function<void()> meddle_;
};

/// A scene that is mapped and not copied, with statements all through it.
std::string large_scene() {
  std::string text = "WorldBegin\n";
  while (text.size() < 4 * MappedFile::kCopied) text += "Shape \"sphere\" \"float radius\" [ 1 ]\n";
  return text + "WorldEnd\n";
}

void make_old(const std::string& path) {
  fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(1));
}

TEST_F(ChangingScenes, ChangedBetweenOpeningAndReading) {
  const std::function<void()> changes[] = {
      [&] { fs::resize_file(path("scene"), 100000); },
      [&] { fs::resize_file(path("scene"), 0); },
      [&] { std::ofstream(path("scene"), std::ios::app) << "# more\n"; },
      [&] { std::fstream(path("scene"), std::ios::in | std::ios::out) << "Identity\nWorldB"; },
  };
  for (const auto& change : changes) {
    write("scene", large_scene());
    make_old(path("scene"));
    Meddler meddler(change);
    Sources sources;
    const ParseResult result = parse_file(sources, path("scene"), {.models = &meddler});
    EXPECT_TRUE(result.scenes.empty());
    ASSERT_EQ(result.diagnostics.all().size(), 1u);
    const Diagnostic& d = result.diagnostics.all()[0];
    EXPECT_EQ(d.error_class, ErrorClass::File);
    EXPECT_EQ(sources.render_diagnostic(d, false),
              "error: " + path("scene") + ": it changed while it was read\n" + "  start again when it is complete\n");
  }
}

TEST_F(ChangingScenes, ChangedBetweenReadingAndQuoting) {
  const std::function<void()> changes[] = {
      [&] { fs::resize_file(path("scene"), 100); },
      [&] { std::fstream(path("scene"), std::ios::in | std::ios::out) << "\n\n\n\n\n\n\n\n\n\n"; },
  };
  for (const auto& change : changes) {
    write("scene", large_scene());
    make_old(path("scene"));
    Sources sources;
    const ParseResult result = parse_file(sources, path("scene"));
    ASSERT_EQ(result.scenes.size(), 1u);
    const SourcePos last = result.scenes[0].shapes.back().where;
    EXPECT_GT(sources.place(last).line, 1000u);
    change();
    const Diagnostic late{Severity::Error, ErrorClass::Scene, last, "wrong", "right it"};
    EXPECT_EQ(sources.render_diagnostic(late, false), path("scene") + " (changed since): error: wrong\n  right it\n");
    EXPECT_EQ(sources.place(last).line, 0u);
  }
}

TEST_F(ChangingScenes, WhatWasCopiedIsQuotedAsItWas) {
  write("scene", "WorldBegin\nShape \"sphere\"\nWorldEnd\n");
  Sources sources;
  const ParseResult result = parse_file(sources, path("scene"));
  ASSERT_EQ(result.scenes.size(), 1u);
  write("scene", "");
  const Diagnostic late{Severity::Error, ErrorClass::Scene, result.scenes[0].shapes[0].where, "wrong", ""};
  EXPECT_EQ(sources.render_diagnostic(late, false),
            path("scene") + ":2:1: error: wrong\n    Shape \"sphere\"\n    ^\n");
}

}  // namespace
}  // namespace whit
