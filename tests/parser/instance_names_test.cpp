// The look ahead for placed objects, and the files that need not be read because of it.
#include "parser/instance_names.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/limits.h"
#include "tests/base/temp_folder.h"
#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

/// No scene file, so that reading it shows.
constexpr const char* kGarbage = "Spheer 1 2 3\n";

class UnplacedFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(test::temp_folder()) /
              (std::string("whit_unplaced_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_ / "sub");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// A world of this folder.
  Parsed parse(const std::string& body, bool read_unplaced = false) const {
    return Parsed(in_world(body), folder_.string(), {.read_unplaced = read_unplaced});
  }

  /// What the look ahead finds in text behind an Include in an object; "?" for a doubt.
  std::vector<std::string> names(const std::string& text) {
    Sources sources;
    const uint32_t file = sources.add_text("ahead", text);
    const auto found = names_of_instances(sources, folder_.string(), {{file, 0}});
    if (!found) return {"?"};
    std::vector<std::string> sorted(found->begin(), found->end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

  /// Whether the file of an Include in object "o", with `behind` the object, is left unread by a world without mistakes.
  void expect_unread(const std::string& behind) {
    write("o.pbrt", kGarbage);
    const Parsed parsed = parse("ObjectBegin \"o\"\nInclude \"o.pbrt\"\nObjectEnd\n" + behind);
    expect_clean(parsed);
    ASSERT_EQ(parsed.scene().unread_files.size(), 1u) << behind;
    EXPECT_EQ(parsed.sources.location(parsed.scene().unread_files[0].where), "test.pbrt:3:9");
  }
  void expect_read(const std::string& behind) {
    write("o.pbrt", "Shape \"of the file\"");
    const Parsed parsed = parse("ObjectBegin \"o\"\nInclude \"o.pbrt\"\nObjectEnd\n" + behind);
    EXPECT_TRUE(parsed.scene().unread_files.empty()) << behind;
    ASSERT_FALSE(parsed.scene().shapes.empty()) << behind;
    EXPECT_EQ(parsed.scene().shapes[0].plugin, "of the file");
  }

  std::filesystem::path folder_;
};

using Names = std::vector<std::string>;
const Names kDoubt = {"?"};

TEST_F(UnplacedFiles, NamesUpToTheEndOfTheWorld) {
  EXPECT_EQ(names("ObjectEnd WorldEnd"), Names{});
  EXPECT_EQ(names("ObjectEnd ObjectInstance \"b\" ObjectInstance\n# comment\n\"a\" WorldEnd ObjectInstance \"c\""),
            (Names{"a", "b"}));
  EXPECT_EQ(names("Shape \"s\" ObjectEnd ObjectBegin \"c\" ObjectEnd ObjectInstance \"c\" WorldEnd"), Names{"c"});
}

TEST_F(UnplacedFiles, NamesAreUnescapedAsTheParserDoes) {
  EXPECT_EQ(names(R"(ObjectEnd ObjectInstance "a\"b\\c\td" WorldEnd)"), Names{"a\"b\\c\td"});
}

TEST_F(UnplacedFiles, WhatOnlyLooksLikeAnInstance) {
  EXPECT_EQ(names("ObjectEnd # ObjectInstance \"a\"\nMaterial \"ObjectInstance \\\"b\\\"\" \"string x\" "
                  "[ \"ObjectInstance ] \" \"[\" # ] ObjectInstance \"c\" [\n] \"string y\" \"WorldEnd\"\n"
                  "ObjectInstance \"d\" WorldEnd"),
            Names{"d"});
}

TEST_F(UnplacedFiles, ListsOfAllLengthsAreSkipped) {
  // The end of the list at every place in a block of 64 bytes and on both sides of its edges, once behind a comment and
  // a string that hide brackets.
  for (size_t n = 0; n < 200; ++n) {
    const std::string list = "Shape \"s\" \"float x\" [" + std::string(n, '1');
    EXPECT_EQ(names("ObjectEnd " + list + "] ObjectInstance \"a\" WorldEnd"), Names{"a"}) << n;
    EXPECT_EQ(names("ObjectEnd " + list + " \"]\" # ]\n" + std::string(n, ' ') + "] ObjectInstance \"a\" WorldEnd"),
              Names{"a"})
        << n;
    EXPECT_EQ(names("ObjectEnd " + list), kDoubt) << n;
  }
}

TEST_F(UnplacedFiles, DoubtsAreToldFromAnswers) {
  const std::string fine = "ObjectEnd ObjectInstance \"a\" WorldEnd";
  EXPECT_EQ(names(fine), Names{"a"});
  EXPECT_EQ(names("ObjectEnd ObjectInstance \"a\""), kDoubt);  // No WorldEnd.
  EXPECT_EQ(names("ObjectInstance \"a\" WorldEnd"), kDoubt);   // The object does not end.
  EXPECT_EQ(names("ObjectEnd " + fine), kDoubt);               // It ends twice.
  EXPECT_EQ(names("ObjectBegin \"b\" " + fine), kDoubt);       // Another one in it.
  EXPECT_EQ(names("ObjectEnd ObjectInstance a WorldEnd"), kDoubt);
  EXPECT_EQ(names("ObjectEnd ObjectInstance \"a\\q\" WorldEnd"), kDoubt);  // An escape that does not exist.
  EXPECT_EQ(names("Material \"matte\n" + fine), kDoubt);
  EXPECT_EQ(names("Scale [ 1 1 1\n" + fine + " ]"), kDoubt);
  EXPECT_EQ(names("Scale [ 1 1 1\nShape \"s\" \"float x\" [ 1 ] " + fine), kDoubt);
  EXPECT_EQ(names("Scale [ 1 1 1\nInclude \"x\" ] " + fine), kDoubt);
  EXPECT_EQ(names("ObjectEnd Include \"none.pbrt\" WorldEnd"), kDoubt);
  EXPECT_EQ(names("ObjectEnd Include \"sub\" WorldEnd"), kDoubt);  // A folder.
  EXPECT_EQ(names("Include \"none.pbrt\" " + fine), Names{"a"});   // Part of the object: not looked at.
}

TEST_F(UnplacedFiles, IncludedFilesAreLookedInto) {
  write("sub/b.pbrt", "ObjectInstance \"in b\" Include \"c.pbrt\"");  // Paths start at the main file's folder.
  write("c.pbrt", "ObjectInstance \"in c\"");
  EXPECT_EQ(names("ObjectEnd Include \"sub/b.pbrt\" ObjectInstance \"a\" WorldEnd"), (Names{"a", "in b", "in c"}));
  write("ends.pbrt", "WorldEnd ObjectInstance \"behind\"");
  EXPECT_EQ(names("ObjectEnd Include \"ends.pbrt\" ObjectInstance \"a\" WorldEnd"), Names{});
  write("opens.pbrt", "ObjectBegin \"o\"");
  EXPECT_EQ(names("ObjectEnd Include \"opens.pbrt\" ObjectEnd WorldEnd"), kDoubt);
}

TEST_F(UnplacedFiles, FilesThatIncludeOneAnotherAreLookedIntoOnce) {
  // If every Include were followed, 2^64 of them.
  for (int i = 0; i < 64; ++i) {
    const std::string next = "Include \"" + std::to_string((i + 1) % 64) + ".pbrt\"\n";
    write(std::to_string(i) + ".pbrt", "ObjectInstance \"" + std::to_string(i) + "\"\n" + next + next);
  }
  EXPECT_EQ(names("ObjectEnd Include \"0.pbrt\" Include \"0.pbrt\" WorldEnd").size(), 64u);
}

TEST_F(UnplacedFiles, ChainsOfIncludesMayBeAsLongAsTheParserReadsThem) {
  // Each file is open while the next is looked into. The main file counts too.
  constexpr int kFiles = static_cast<int>(kIncludeDepth.most) - 1;
  for (int i = 0; i < kFiles; ++i)
    write(std::to_string(i), i + 1 == kFiles ? "ObjectInstance \"last\"" : "Include \"" + std::to_string(i + 1) + "\"");
  EXPECT_EQ(names("ObjectEnd Include \"0\" WorldEnd"), Names{"last"});
  write("before", "Include \"0\"");
  EXPECT_EQ(names("ObjectEnd Include \"before\" WorldEnd"), kDoubt);
}

TEST_F(UnplacedFiles, OpenFilesAreGoneThroughToTheirEnds) {
  Sources sources;
  const std::string outer = "ObjectInstance \"before\" ObjectInstance \"outer\" WorldEnd";
  const uint32_t a = sources.add_text("outer", outer);
  const uint32_t b = sources.add_text("inner", "ObjectEnd ObjectInstance \"inner\"");
  const auto found = names_of_instances(sources, folder_.string(), {{a, outer.find("ObjectInstance \"outer")}, {b, 0}});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(*found, (InstanceNames{"inner", "outer"}));
}

TEST_F(UnplacedFiles, AreNotRead) {
  expect_unread("");
  expect_unread("Shape \"s\"");
  expect_unread("# ObjectInstance \"o\"\nMaterial \"m\" \"string x\" \"ObjectInstance o\"");
  expect_unread("ObjectBegin \"p\" ObjectEnd ObjectInstance \"p\"");
  // In the next world "o" is another object.
  expect_unread("WorldEnd WorldBegin ObjectBegin \"o\" ObjectEnd ObjectInstance \"o\"");
}

TEST_F(UnplacedFiles, OfPlacedObjectsAreRead) {
  expect_read("ObjectInstance \"o\"");
  expect_read("AttributeBegin Translate 1 2 3 ObjectInstance \"\\o\" AttributeEnd");  // A mistake, so a doubt.
  expect_read("ObjectBegin \"o\" ObjectEnd ObjectInstance \"o\"");  // Another one of that name is placed.
  write("sub/place.pbrt", "ObjectInstance \"o\"");
  expect_read("Include \"sub/place.pbrt\"");
  expect_read("ObjectEnd");
}

TEST_F(UnplacedFiles, OfAnObjectInAnIncludedFile) {
  // The file with the object stands between the main file and that of the object; both may place it.
  write("o.pbrt", "Shape \"s\"");
  for (const bool inside : {false, true}) {
    for (const bool outside : {false, true}) {
      write("objects.pbrt",
            std::string("ObjectBegin \"o\" Include \"o.pbrt\" ObjectEnd\n") + (inside ? "ObjectInstance \"o\"" : ""));
      const Parsed parsed = parse(std::string("Include \"objects.pbrt\"\n") + (outside ? "ObjectInstance \"o\"" : ""));
      expect_clean(parsed);
      EXPECT_EQ(parsed.scene().unread_files.size(), inside || outside ? 0u : 1u);
      EXPECT_EQ(parsed.scene().shapes.size(), inside || outside ? 1u : 0u);
    }
  }
}

TEST_F(UnplacedFiles, AreListedWithTheirObject) {
  write("o.pbrt", kGarbage);
  const Parsed parsed = parse(
      "ObjectBegin \"placed\" ObjectEnd ObjectInstance \"placed\"\n"
      "ObjectBegin \"o\" AttributeBegin\n"
      "  Include \"o.pbrt\" Translate 1 2 3\n  Include \"sub/../o.pbrt\"\n"
      "AttributeEnd ObjectEnd Shape \"s\"");
  expect_clean(parsed);
  const auto& unread = parsed.scene().unread_files;
  ASSERT_EQ(unread.size(), 2u);
  EXPECT_EQ(unread[0].path, path("o.pbrt"));
  EXPECT_EQ(unread[1].path, path("sub/../o.pbrt"));
  EXPECT_EQ(parsed.sources.location(unread[1].where), "test.pbrt:5:11");
  EXPECT_EQ(unread[0].object, 1);
  EXPECT_EQ(unread[1].object, 1);
  EXPECT_EQ(parsed.sources.size(), 1u);  // Nothing but the main text is open.
  ASSERT_EQ(parsed.scene().shapes.size(), 1u);
  EXPECT_EQ(parsed.scene().shapes[0].object, -1);
  EXPECT_EQ(parsed.scene().shapes[0].transform, 0);  // What the object says of transforms ends with it.
}

TEST_F(UnplacedFiles, WhatBuildsOnThemGoesWithThem) {
  // Everything here that has no meaning without the file has one with it. The light is the world's, and stays.
  write("o.pbrt",
        "MakeNamedMaterial \"m\" \"string type\" \"glass\" Texture \"t\" \"float\" \"constant\" "
        "CoordinateSystem \"here\"");
  const std::string body =
      "TransformBegin Translate 1 0 0 ObjectBegin \"o\" Include \"o.pbrt\" \"texture alpha\" \"t\"\n"
      "NamedMaterial \"m\" Material \"mix\" \"string namedmaterial1\" \"m\" CoordSysTransform \"here\"\n"
      "Shape \"sphere\" \"texture alpha\" \"t\" LightSource \"point\"\n"
      "ObjectEnd Shape \"s\" TransformEnd Shape \"t\"";
  const Parsed parsed = parse(body);
  expect_clean(parsed);
  EXPECT_EQ(parsed.scene().unread_files.size(), 1u);
  EXPECT_EQ(parsed.scene().lights.size(), 1u);
  EXPECT_EQ(parsed.scene().materials.size(), 1u);
  ASSERT_EQ(parsed.scene().shapes.size(), 2u);
  const auto x = [&](size_t shape) {
    const auto transform = static_cast<size_t>(parsed.scene().shapes[shape].transform);
    return parsed.scene().transforms[transform].start[3][0];
  };
  EXPECT_EQ(x(0), 1);
  EXPECT_EQ(x(1), 0);
}

TEST_F(UnplacedFiles, BlocksThatTheyMayOpenDoNotCloseThoseAround) {
  write("o.pbrt", "TransformBegin");
  const Parsed parsed = parse(
      "TransformBegin Translate 1 0 0\n"
      "ObjectBegin \"o\" Include \"o.pbrt\" TransformEnd ObjectEnd\nShape \"s\"\nTransformEnd");
  expect_clean(parsed);
  EXPECT_EQ(parsed.scene().transforms[static_cast<size_t>(parsed.scene().shapes.at(0).transform)].start[3][0], 1);
}

TEST_F(UnplacedFiles, BlocksThatDoNotFitWithoutThemAreADoubt) {
  // The file may hold the other half of a block, or the blocks may cross: only reading it tells.
  const auto expect_all_read = [&](const std::string& file, const std::string& body) {
    write("o.pbrt", file);
    const Parsed parsed = parse(body), all = parse(body, true);
    EXPECT_EQ(dump(parsed.scene()), dump(all.scene())) << body;
    EXPECT_EQ(parsed.messages(), all.messages());
    EXPECT_TRUE(parsed.scene().unread_files.empty()) << body;
  };
  expect_all_read("AttributeBegin", "ObjectBegin \"o\" Include \"o.pbrt\" AttributeEnd ObjectEnd Shape \"s\"");
  expect_all_read("AttributeEnd", "ObjectBegin \"o\" AttributeBegin Include \"o.pbrt\" ObjectEnd Shape \"s\"");
  expect_all_read(
      "Shape \"t\"",
      "AttributeBegin Translate 1 0 0 ObjectBegin \"o\" Include \"o.pbrt\" AttributeEnd ObjectEnd Shape \"s\"");
  expect_all_read("ObjectEnd", "ObjectBegin \"o\" Include \"o.pbrt\"");
}

TEST_F(UnplacedFiles, MistakesInTheNextObjectAreFound) {
  // With any mistake everything is read, for it might be none with what is left unread.
  write("o.pbrt", "Shape \"s\"");
  expect_only(parse("ObjectBegin \"o\" Include \"o.pbrt\" ObjectEnd\nObjectBegin \"p\"\nNamedMaterial \"m\" ObjectEnd"),
              Severity::Warning, 4, 15, "no material named \"m\"");
}

TEST_F(UnplacedFiles, MayHoldObjectEnd) {
  // Unread, the object goes on to its own ObjectEnd; without one in sight there is a doubt, and the file is read.
  write("o.pbrt", "Shape \"s\" ObjectEnd");
  EXPECT_EQ(parse("ObjectBegin \"o\" Include \"o.pbrt\" ObjectEnd").scene().unread_files.size(), 1u);
  const Parsed ended_there = parse("ObjectBegin \"o\" Include \"o.pbrt\" Shape \"in the world\"");
  expect_clean(ended_there);
  ASSERT_EQ(ended_there.scene().shapes.size(), 2u);
  EXPECT_EQ(ended_there.scene().shapes[1].object, -1);
}

TEST_F(UnplacedFiles, TheirParametersGoWithThem) {
  write("o.pbrt", kGarbage);
  const Parsed parsed = parse(
      "ObjectBegin \"o\" Include \"o.pbrt\" \"float r\" 4 \"texture t\" \"none\" ObjectEnd\n"
      "Shape \"s\"");
  expect_clean(parsed);
  EXPECT_TRUE(parsed.scene().shapes.at(0).params.empty());
}

TEST_F(UnplacedFiles, MustBeThere) {
  for (const std::string name : {"none.pbrt", "sub"}) {
    const std::string body = "ObjectBegin \"o\"\nInclude \"" + name + "\" ObjectEnd";
    const Parsed unread = parse(body), read = parse(body, true);
    expect_only(unread, Severity::Error, 3, 9, "cannot open");
    EXPECT_EQ(unread.messages(), read.messages());
    EXPECT_EQ(unread.all().at(0).error_class, ErrorClass::File);
    EXPECT_TRUE(unread.scene().unread_files.empty());
  }
}

TEST_F(UnplacedFiles, CoordinateSystemsThatMayBeThere) {
  write("o.pbrt", "CoordinateSystem \"here\"");
  expect_only(parse("ObjectBegin \"o\" Include \"o.pbrt\" ObjectEnd\nCoordSysTransform \"here\""), Severity::Warning, 3,
              19, "no coordinate system named \"here\"", "is it defined in one of them?");
}

TEST_F(UnplacedFiles, AreReadWhenAskedFor) {
  write("o.pbrt", kGarbage);
  expect_only(parse("ObjectBegin \"o\" Include \"o.pbrt\" ObjectEnd", true), Severity::Error, 2, 25,
              "does not begin with a statement");
}

TEST_F(UnplacedFiles, AreNoneWhereAllIsPlaced) {
  write("o.pbrt", "Material \"glass\" Shape \"s\" Include \"p.pbrt\"\nLightSource \"point\"");
  write("p.pbrt", "Translate 1 2 3 Shape \"t\"\nCoordinateSystem \"here\"");
  const std::string body =
      "ObjectBegin \"o\" Include \"o.pbrt\" \"float x\" 1 NamedMaterial \"none\" ObjectEnd\n"
      "ObjectBegin \"p\" AttributeBegin Include \"p.pbrt\" AttributeEnd Include \"o.pbrt\" ObjectEnd\n"
      "ObjectInstance \"p\" CoordSysTransform \"here\" ObjectInstance \"o\"";
  const Parsed looked_ahead = parse(body), all = parse(body, true);
  EXPECT_EQ(dump(looked_ahead.scene()), dump(all.scene()));
  EXPECT_EQ(looked_ahead.messages(), all.messages());
  EXPECT_EQ(looked_ahead.scene().shapes.size(), 5u);  // o: s, t; p: t, then s, t of o.pbrt.
}

TEST_F(UnplacedFiles, AreOfNoPlacedObjectInAnyText) {
  // Random statements: of those texts that have no mistake, an object with an unread file is never placed.
  write("o.pbrt", "Shape \"s\"");
  write("ends.pbrt", "ObjectEnd");
  write("places.pbrt", "ObjectInstance \"a\"");
  const std::vector<std::string> pieces = {"ObjectBegin \"a\" Include \"o.pbrt\"",
                                           "ObjectBegin \"b\" Include \"o.pbrt\"",
                                           "ObjectBegin \"a\"",
                                           "ObjectEnd",
                                           "ObjectEnd",
                                           "ObjectEnd",
                                           "ObjectInstance \"a\"",
                                           "ObjectInstance \"b\"",
                                           "Include \"o.pbrt\"",
                                           "Include \"ends.pbrt\"",
                                           "Include \"places.pbrt\"",
                                           "WorldEnd\nWorldBegin\n",
                                           "# ObjectEnd\n"};
  uint32_t state = 1;
  size_t with_unread = 0, with_instances = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string body;
    for (int i = 0; i < 7; ++i) {
      state = state * 1664525u + 1013904223u;  // Numerical Recipes' generator; the high bits are the random ones.
      body += pieces[(state >> 16) % pieces.size()] + " ";
    }
    const Parsed parsed = parse(body);
    if (parsed.result.diagnostics.has_errors()) continue;
    for (const SceneDescription& scene : parsed.result.scenes) {
      with_unread += scene.unread_files.empty() ? 0 : 1;
      with_instances += scene.instances.empty() ? 0 : 1;
      for (const UnreadFile& file : scene.unread_files)
        for (const InstanceDescription& instance : scene.instances) EXPECT_NE(instance.object, file.object) << body;
    }
  }
  EXPECT_GT(with_unread, 100u) << with_instances;
  EXPECT_GT(with_instances, 100u) << with_unread;
}

TEST_F(UnplacedFiles, EachWorldIsLookedAheadInAnew) {
  write("o.pbrt", "Shape \"s\"");
  const std::string object = "ObjectBegin \"o\" Include \"o.pbrt\" ObjectEnd\n", place = "ObjectInstance \"o\"\n";
  const std::string next = "WorldEnd WorldBegin\n";
  const Parsed parsed = parse(object + next + object + place + next + object);
  expect_clean(parsed);
  ASSERT_EQ(parsed.result.scenes.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(parsed.result.scenes[i].shapes.size(), i == 1 ? 1u : 0u) << i;
}

}  // namespace
}  // namespace whit
