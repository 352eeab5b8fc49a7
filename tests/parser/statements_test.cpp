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
        Mistake{"SurfaceIntegrator \"whitted\"", 2, 1, "unknown directive", "it is Integrator"},
        Mistake{"Renderer \"sampler\"", 2, 1, "unknown directive", "it is Integrator"},
        Mistake{"ColorSpace \"srgb\"", 2, 1, "unknown directive", "pbrt-v4"},
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
        Mistake{"Texture \"wood\" \"float\" \"constant\"\nMaterial \"m\" \"texture Kd\" [ \"wodo\" ]", 3, 29,
                "no texture named \"wodo\"", "did you mean \"wood\"?"},
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
