// Mistakes of statements: each is one diagnostic at its place, and reading goes on behind it.
#include "parser/statements.h"

#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

struct Mistake {
  const char* body;  ///< The world; its first line is line 2.
  uint64_t line, column;
  const char* message;
  const char* remedy;
};

class StatementMistake : public testing::TestWithParam<Mistake> {};

TEST_P(StatementMistake, IsOneErrorAtItsPlace) {
  const Mistake& m = GetParam();
  const Parsed parsed(in_world(std::string(m.body) + "\nShape \"next\""));
  expect_only(parsed, Severity::Error, m.line, m.column, m.message, m.remedy);
  EXPECT_EQ(parsed.scene().shapes.back().plugin, "next");
}

INSTANTIATE_TEST_SUITE_P(
    All, StatementMistake,
    testing::Values(
        Mistake{"Spheer 1 2 3", 2, 1, "unknown directive \"Spheer\"", ""},
        Mistake{"Shap \"sphere\"", 2, 1, "unknown directive", "did you mean Shape?"},
        Mistake{"translate 0 0 1", 2, 1, "unknown directive", "case sensitive: write Translate"},
        Mistake{"SurfaceIntegrator \"whitted\"", 2, 1, "a pbrt-v2 file: pbrt-v3 has no statement SurfaceIntegrator",
                "it is Integrator"},
        Mistake{"Renderer \"sampler\"\nVolume \"homogeneous\"", 2, 1, "a pbrt-v2 file", "it is Integrator"},
        // Said once, whatever else shows it.
        Mistake{"ColorSpace \"srgb\"\nMaterial \"diffuse\"\nAttribute \"shape\" \"rgb r\" [1 1 1]\n"
                "Shape \"s\" \"bool b\" true\nOption \"x\" 1",
                2, 1, "a pbrt-v4 file: pbrt-v3 has no statement ColorSpace", "whit reads pbrt-v3"},
        // One mistake each: the numbers are all there, and the word is no number.
        Mistake{"Translate 0 0 5\nShpae \"sphere\"", 3, 1, "unknown directive \"Shpae\"", "did you mean Shape?"},
        Mistake{"Scale 1 1 1 # unit\nShpae \"sphere\"", 3, 1, "unknown directive", ""},
        Mistake{"Rotate 30 0 0 1\n  shape \"sphere\"", 3, 3, "unknown directive", "write Shape"},
        Mistake{"LookAt 0 0 5 0 0 0 0 1 0 Shpae \"sphere\"", 2, 26, "unknown directive", ""},
        Mistake{"ConcatTransform [ 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1 ]\nShpae \"s\"", 3, 1, "unknown directive", ""},
        Mistake{"Translate 0 0 5 five", 2, 17, "unknown directive \"five\"", ""},
        Mistake{"Translate 0 0 five", 2, 15, "\"five\" is not a number", "needs 3 numbers"},
        // What looks right and is not.
        Mistake{"Translate\xc2\xa0"
                "0 0 5",
                2, 1, "\"Translate\\u00a00\"", "no-break space, U+00A0"},
        Mistake{"Translate 0\xc2\xa0"
                "0 5",
                2, 11, "\"0\\u00a00\" is not a number", "no-break space, U+00A0"},
        Mistake{"Shape \"s\" \"float\xc2\xa0radius\" 1", 2, 11, "a type and a name", "no-break space, U+00A0"},
        Mistake{"\xe2\x80\x8bShape \"s\"", 2, 1, "\"\\u200bShape\"", "it holds \\u200b, which cannot be seen"},
        Mistake{"Shape \"s\" \xe2\x80\x9c"
                "float r\xe2\x80\x9d 1",
                2, 11, "unknown directive", "\xe2\x80\x9c is no quote here"},
        Mistake{"Shape 'sphere'", 2, 1, "Shape needs a name in quotes", "' is no quote here: write \""},
        Mistake{"Translate 0 0 \xe2\x88\x92"
                "5",
                2, 15, "is not a number", "write -"},
        Mistake{"// a comment of C", 2, 1, "unknown directive \"//\"", "comments begin with #"},
        Mistake{"//Shape \"s\"", 2, 1, "unknown directive \"//\"", "comments begin with #"},
        Mistake{"/* a comment of C */", 2, 1, "unknown directive", "comments begin with #"},
        Mistake{"Shape \"s\" \"float r\" [ 1 // one\n ]", 2, 25, "is not a number", "comments begin with #"},
        Mistake{"[ 1 2 ]", 2, 1, "unexpected [", ""}, Mistake{"]", 2, 1, "unexpected ]", ""},
        Mistake{"12", 2, 1, "unexpected number \"12\"", "directive"},
        Mistake{"\"sphere\"", 2, 1, "unexpected string \"sphere\"", "directive"},
        Mistake{"Identity 1", 2, 10, "unexpected number", ""},
        Mistake{"Translate 1 2", 2, 1, "needs 3 numbers, but there are 2", ""},
        Mistake{"Translate 1 2 3 4", 2, 1, "needs 3 numbers, but there are more", ""},
        Mistake{"Translate nan 0 0", 2, 11, "\"nan\" is not a number", ""},
        Mistake{"Translate 1.5x 0 0", 2, 11, "\"1.5x\" is not a number", ""},
        Mistake{"Translate \"a\" 0 0", 2, 1, "needs 3 numbers", ""},
        Mistake{"Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 ]", 2, 1, "16 numbers, but there are 15", ""},
        Mistake{"Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1", 2, 11, "list not closed", ""},
        Mistake{"Shape", 2, 1, "Shape needs a name in quotes", ""},
        Mistake{"Shape sphere", 2, 1, "Shape needs a name in quotes", ""},
        Mistake{"Texture \"a\" \"float\"", 2, 1, "needs 3 strings", ""},
        Mistake{"ActiveTransform \"All\"", 2, 1, "needs a word", ""},
        Mistake{"Material \"matte", 2, 10, "not closed before the end of the line", ""},
        Mistake{"Camera \"perspective\"", 2, 1, "Camera is not allowed inside the world block", "WorldBegin"},
        Mistake{"TransformTimes 0 1", 2, 1, "not allowed inside the world block", ""},
        Mistake{"WorldBegin", 2, 1, "not allowed inside the world block", "WorldEnd"},
        Mistake{"AttributeEnd", 2, 1, "AttributeEnd without AttributeBegin", ""},
        Mistake{"TransformEnd", 2, 1, "TransformEnd without TransformBegin", ""},
        Mistake{"ObjectEnd", 2, 1, "ObjectEnd without ObjectBegin", ""},
        Mistake{"AttributeBegin\nTransformEnd\nAttributeEnd", 3, 1, "TransformEnd without", "test.pbrt:2:1"},
        Mistake{"ObjectBegin \"o\"\nAttributeEnd\nObjectEnd", 3, 1, "AttributeEnd without", "test.pbrt:2:1"},
        Mistake{"ObjectBegin \"a\"\nObjectBegin \"b\"\nObjectEnd\nObjectEnd", 3, 1, "ObjectBegin inside an object",
                "test.pbrt:2:1"},
        Mistake{"ObjectBegin \"a\"\nObjectInstance \"a\"\nObjectEnd", 3, 1, "inside an object definition", ""},
        Mistake{"ObjectBegin \"tree\" ObjectEnd\nObjectInstance \"tere\"", 3, 16, "no object named \"tere\"",
                "did you mean \"tree\"?"},
        Mistake{"Texture \"t\" \"rgb\" \"constant\"", 2, 13, "cannot be of type \"rgb\"", "\"spectrum\""},
        Mistake{"Include \"none.pbrt\"", 2, 9, "cannot open \"/nowhere/none.pbrt\"", ""}));

TEST(Statements, UnclosedBlocksAreWarnings) {
  expect_only(Parsed(in_world("  AttributeBegin")), Severity::Warning, 2, 3, "never closed", "before WorldEnd");
  expect_only(Parsed(in_world("AttributeBegin\nTransformBegin\nAttributeEnd")), Severity::Warning, 3, 1,
              "TransformBegin is never closed", "before WorldEnd");
  expect_only(Parsed(in_world("ObjectBegin \"o\"\nAttributeBegin\nObjectEnd\nShape \"s\"")), Severity::Warning, 3, 1,
              "AttributeBegin is never closed", "closed by the ObjectEnd at test.pbrt:4:1");
  // Here it is the object that has no end: AttributeEnd takes what ObjectBegin remembered.
  expect_only(Parsed(in_world("AttributeBegin\nObjectBegin \"o\"\nAttributeEnd\nShape \"s\"")), Severity::Warning, 3, 1,
              "ObjectBegin is never closed", "closed by the AttributeEnd at test.pbrt:4:1");
  expect_only(Parsed(in_world("AttributeBegin\nObjectBegin \"o\"\nAttributeEnd\nAttributeEnd")), Severity::Warning, 3,
              1, "ObjectBegin is never closed", "before WorldEnd");
}

/// Mistakes that pbrt-v3 renders past: warnings, which `whit check` calls errors.
class ExcusedMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ExcusedMistake, IsOneWarningAtItsPlace) {
  const Mistake& m = GetParam();
  const Parsed parsed(in_world(std::string(m.body) + "\nShape \"next\""));
  expect_only(parsed, Severity::Warning, m.line, m.column, m.message, m.remedy);
  EXPECT_TRUE(parsed.all().at(0).excused);
  EXPECT_EQ(parsed.scene().shapes.back().plugin, "next");
}

INSTANTIATE_TEST_SUITE_P(
    All, ExcusedMistake,
    testing::Values(
        Mistake{"NamedMaterial \"nope\"", 2, 15, "no material named \"nope\"", "the current material stays"},
        Mistake{"MakeNamedMaterial \"wood\" \"string type\" \"glass\"\nNamedMaterial \"wodo\"", 3, 15,
                "no material named \"wodo\"", "did you mean \"wood\"?"},
        // Too early, and too late.
        Mistake{"NamedMaterial \"m\"\nMakeNamedMaterial \"m\" \"string type\" \"glass\"", 2, 15,
                "no material named \"m\"", "must come before"},
        Mistake{"AttributeBegin MakeNamedMaterial \"m\" \"string type\" \"glass\" AttributeEnd\nNamedMaterial \"m\"", 3,
                15, "no material named \"m\"", ""},
        Mistake{"Material \"mix\"\n\"string namedmaterial1\" [ \"nope\" ]", 3, 27, "no material named \"nope\"",
                "matte stands in for it"},
        // Said once, where it should have been made.
        Mistake{"MakeNamedMaterial \"m\" \"float x\" 1\nNamedMaterial \"m\"", 2, 1, "no parameter \"string type\"", ""},
        Mistake{"MakeNamedMaterial \"m\"\nMaterial \"mix\" \"string namedmaterial2\" \"m\"", 2, 1,
                "no parameter \"string type\"", ""},
        Mistake{"MakeNamedMedium \"m\"\nMediumInterface \"m\" \"\"", 2, 1, "no parameter \"string type\"", ""},
        Mistake{"MediumInterface \"\" \"fog\"\nMakeNamedMedium \"fig\" \"string type\" \"homogeneous\"", 2, 20,
                "no medium named \"fog\"", "did you mean \"fig\"?"}));

TEST(Statements, TheMaterialStaysWhereTheNamedOneIsUnknown) {
  const Parsed parsed(in_world(
      "Material \"mirror\" NamedMaterial \"m\" Shape \"s\"\nMakeNamedMaterial \"m\" \"string type\" \"glass\"\n"
      "Shape \"s\" NamedMaterial \"m\" Shape \"s\" NamedMaterial \"n\" Shape \"s\""));
  std::vector<std::string> materials;
  for (const ShapeDescription& s : parsed.scene().shapes)
    materials.push_back(parsed.scene().materials[static_cast<size_t>(s.material)].plugin);
  EXPECT_EQ(materials, (std::vector<std::string>{"mirror", "mirror", "glass", "glass"}));
}

TEST(Statements, PluginsOfAnotherVersionAreAWarning) {
  // Something may stand in for them, as in pbrt-v3; other statements decide whether the file can be read.
  expect_only(
      Parsed("Sampler \"zsobol\"\nFilm \"rgb\"\n" + in_world("MakeNamedMaterial \"m\" \"string type\" \"conductor\"")),
      Severity::Warning, 1, 9, "this is a pbrt-v4 file: pbrt-v3 has no Sampler \"zsobol\"");
  // pbrt-v4 has no WorldEnd.
  expect_only(Parsed("Film \"rgb\"\nWorldBegin\nShape \"s\"\n"), Severity::Error, 1, 6, "this is a pbrt-v4 file");
  // One of each version.
  EXPECT_EQ(Parsed(in_world("Renderer \"s\"\nOption \"x\" 1\nVolume \"v\"")).all().size(), 2u);
}

TEST(Statements, TwoMistakesAreTwoMessages) {
  // Numbers that are missing, and a directive that is misspelt.
  const Parsed parsed(in_world("Translate 0 0\nShpae \"s\""));
  ASSERT_EQ(parsed.all().size(), 2u) << parsed.messages();
  EXPECT_NE(parsed.all()[0].message.find("needs 3 numbers, but there are 2"), std::string::npos);
  EXPECT_NE(parsed.all()[1].message.find("unknown directive"), std::string::npos);
}

TEST(Statements, PathsAreShownToTheirEndWithAHint) {
  std::string folder = "/nowhere/";
  folder.append(200, 'a');
  const Parsed parsed(in_world("Include \"geometry/missing.pbrt\""), folder);
  ASSERT_EQ(parsed.all().size(), 1u);
  EXPECT_NE(parsed.all()[0].message.find("/geometry/missing.pbrt\": No such file"), std::string::npos);
  expect_only(Parsed(in_world("Include \"geometry\\\\b.pbrt\"")), Severity::Error, 2, 9, "cannot open",
              "write / between folders");
  // \b is a backspace: shown escaped, and explained.
  expect_only(Parsed(in_world("Include \"geometry\\b.pbrt\"")), Severity::Error, 2, 9, "geometry\\x08.pbrt",
              "write / between folders");
}

TEST(Statements, RedefinedNamedMaterialIsAWarning) {
  expect_only(
      Parsed(in_world(
          "MakeNamedMaterial \"m\" \"string type\" \"glass\"\nMakeNamedMaterial \"m\" \"string type\" \"mirror\"")),
      Severity::Warning, 3, 19, "defined again");
}

TEST(Statements, TheFrameOfAFile) {
  expect_only(Parsed(""), Severity::Error, 1, 1, "empty");
  expect_only(Parsed("# nothing\n"), Severity::Error, 1, 1, "no WorldBegin");
  expect_only(Parsed("\nWorldBegin\nShape \"s\"\n"), Severity::Error, 2, 1, "WorldBegin without WorldEnd",
              "add WorldEnd");
  expect_only(Parsed("Camera \"p\"\nShape \"s\"\nShape \"s\"\nWorldEnd\n"), Severity::Error, 2, 1,
              "Shape outside the world block", "is WorldBegin missing?");
  expect_only(Parsed("WorldBegin WorldEnd\nWorldEnd"), Severity::Error, 2, 1, "WorldEnd without WorldBegin");
  expect_only(Parsed(std::string("Shape\0\0\n\1\2", 10)), Severity::Error, 1, 1, "not a scene file");
}

TEST(Statements, EveryMistakeOfAFileIsReported) {
  const Parsed parsed(
      in_world("translate 1 0 0\ntranslate 1 0 0\nShape \"s\" \"float r\" [ 1\nScale 1 x 1\nFoo\nShape \"t\""));
  ASSERT_EQ(parsed.all().size(), 5u) << parsed.messages();
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(parsed.sources.place(parsed.all()[i].where).line, i + 2);
}

TEST(Statements, ErrorsAreCapped) {
  std::string body;
  for (int i = 0; i < 250; ++i) body += "ObjectInstance \"x\"\n";
  const Parsed parsed(in_world(body));
  ASSERT_EQ(parsed.all().size(), 101u);
  EXPECT_EQ(parsed.all().back().message, "and 150 more errors in this file, from here on");
  EXPECT_EQ(parsed.sources.place(parsed.all().back().where).line, 102u);
}

TEST(Statements, OneLineScene) {
  const Parsed parsed("WorldBegin Translate 1 2 Shape\"a\"\"float r\"1[]Shape \"b\" WorldEnd");
  // The missing number costs the Translate only; behind the stray bracket the line is lost.
  EXPECT_EQ(parsed.all().size(), 3u) << parsed.messages();
  EXPECT_EQ(parsed.scene().shapes.at(0).plugin, "a");
}

}  // namespace
}  // namespace whit
