// Every parameter type, and every mistake in a parameter list.
#include "parser/parameters.h"

#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

Parsed shape(const std::string& params) { return Parsed(in_world("Shape \"s\" " + params)); }

/// The only parameter of a shape that has it.
Parameter only(const std::string& text) {
  const Parsed parsed = Parsed(in_world("Texture \"t\" \"float\" \"constant\" Shape \"s\" " + text));
  expect_clean(parsed);
  const ParameterList& list = parsed.scene().shapes.at(0).params;
  EXPECT_EQ(list.size(), 1u);
  return list.at(0);
}

TEST(Parameters, NumericTypesAndAliases) {
  const std::pair<const char*, ParamType> three[] = {
      {"point", ParamType::Point3},    {"point3", ParamType::Point3},  {"vector", ParamType::Vector3},
      {"vector3", ParamType::Vector3}, {"normal", ParamType::Normal3}, {"normal3", ParamType::Normal3},
      {"rgb", ParamType::Rgb},         {"color", ParamType::Rgb},      {"xyz", ParamType::Xyz}};
  for (const auto& [name, type] : three) {
    const Parameter p = only(std::string("\"") + name + " x\" [ 1 2.5 -3 ]");
    EXPECT_EQ(p.type, type) << name;
    EXPECT_EQ(p.name, "x");
    EXPECT_EQ(p.numbers(), (std::vector<double>{1, 2.5, -3})) << name;
  }
  for (const char* two : {"point2", "vector2", "blackbody", "spectrum"})
    EXPECT_EQ(only(std::string("\"") + two + " x\" [ 400 1 ]").numbers(), (std::vector<double>{400, 1})) << two;
  EXPECT_EQ(only("\"float x\" [ 1 2 ]").numbers(), (std::vector<double>{1, 2}));
  EXPECT_EQ(only("\"float x\" .5").numbers(), (std::vector<double>{.5}));
  EXPECT_EQ(only("\"integer x\" 3").integers(), (std::vector<int32_t>{3}));
  EXPECT_EQ(only("\"integer x\" [ 3 4 ]").integers(), (std::vector<int32_t>{3, 4}));
}

TEST(Parameters, StringTypes) {
  EXPECT_EQ(only("\"bool x\" \"true\"").bools(), (std::vector<uint8_t>{1}));
  EXPECT_EQ(only("\"bool x\" [ \"true\" \"false\" ]").bools(), (std::vector<uint8_t>{1, 0}));
  EXPECT_EQ(only("\"string x\" \"a b\"").strings(), (std::vector<std::string>{"a b"}));
  EXPECT_EQ(only("\"string x\" [ \"a\" \"b\" ]").strings(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(only("\"spectrum x\" \"gold.spd\"").strings(), (std::vector<std::string>{"gold.spd"}));
  EXPECT_EQ(only("\"texture x\" \"t\"").textures().at(0).float_texture, 0);
}

TEST(Parameters, SpacesInDeclarationsAndPlaces) {
  const Parameter p = only("\"  float \t radius  \" [ 1 ]");
  EXPECT_EQ(p.name, "radius");
  // WorldBegin\n is 11 bytes, the texture 30 more, `Shape "s" ` ten more.
  EXPECT_EQ(p.where.offset, 11u + 30u + 1u + 10u);
  EXPECT_EQ(p.values_at.offset, p.where.offset + 21);
}

TEST(Parameters, FractionOfAnInteger) {
  const Parsed parsed = shape("\"integer n\" [ 1 2.5 3.5 ]");
  expect_only(parsed, Severity::Warning, 2, 27, "has a fraction", "2 is used");
  EXPECT_EQ(parsed.scene().shapes[0].params[0].integers(), (std::vector<int32_t>{1, 2, 3}));
}

TEST(Parameters, CommasBehindNumbers) {
  // strtod() of pbrt's stops at them; one warning a file is enough.
  const Parsed parsed(in_world("Translate 1, -2., 3\nShape \"s\" \"rgb c\" [ 1, .5, 2e1 ] \"integer n\" [ 1, 2, 3,]"));
  expect_only(parsed, Severity::Warning, 2, 11, "comma", "passed over");
  const ShapeDescription& shape = parsed.scene().shapes.at(0);
  EXPECT_EQ(shape.params.at(0).numbers(), (std::vector<double>{1, 0.5, 20}));
  EXPECT_EQ(shape.params.at(1).integers(), (std::vector<int32_t>{1, 2, 3}));
  EXPECT_EQ(transform_point(parsed.scene().transforms[1].start, {0, 0, 0}), Vec3d(1, -2, 3));
}

TEST(Parameters, StrangeBool) {
  const Parsed parsed = shape("\"bool b\" \"maybe\"");
  expect_only(parsed, Severity::Warning, 2, 20, "\"maybe\"", "\"false\" is used");
  EXPECT_EQ(parsed.scene().shapes[0].params[0].bools(), (std::vector<uint8_t>{0}));
}

TEST(Parameters, Duplicates) {
  const Parsed parsed = shape("\"float r\" 1 \"integer r\" 2 \"float r\" 3");
  expect_only(parsed, Severity::Warning, 2, 37, "given twice", "last one is used");
  const ParameterList& list = parsed.scene().shapes[0].params;
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].type, ParamType::Integer);
  EXPECT_EQ(list[1].numbers(), (std::vector<double>{3}));
  // An rgb replaces a spectrum, but a texture is another thing than a value.
  EXPECT_EQ(shape("\"spectrum k\" [400 1] \"rgb k\" [1 1 1]").scene().shapes[0].params.size(), 1u);
  // Exporters say the same twice; nothing is lost then.
  const Parsed same =
      shape("\"string mapping\" \"uv\" \"string mapping\" [\"uv\"] \"rgb c\" [1 2 3] \"color c\" [1 2 3]");
  expect_clean(same);
  EXPECT_EQ(same.scene().shapes[0].params.size(), 2u);
}

TEST(Parameters, WavelengthsAreSorted) {
  const Parsed parsed = shape("\"spectrum k\" [500 2 400 1 600 3 400 4]");
  expect_only(parsed, Severity::Warning, 2, 24, "do not increase", "sorted");
  EXPECT_EQ(parsed.scene().shapes[0].params[0].numbers(), (std::vector<double>{400, 1, 400, 4, 500, 2, 600, 3}));
}

TEST(Parameters, EmptyList) {
  // Whether it may be empty is the plugin's business.
  const Parsed parsed = shape("\"float r\" [ ] \"float q\" 1");
  EXPECT_TRUE(parsed.all().empty()) << parsed.messages();
  ASSERT_EQ(parsed.scene().shapes[0].params.size(), 2u);
  EXPECT_TRUE(parsed.scene().shapes[0].params[0].is_empty());
}

struct Mistake {
  const char* params;
  uint64_t column;  ///< With `Shape "s" ` in front, ten bytes.
  const char* message;
  const char* remedy;
};

class ParameterMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ParameterMistake, IsOneErrorAtItsPlace) {
  const Mistake& m = GetParam();
  const Parsed parsed = Parsed(in_world(std::string("Shape \"s\" ") + m.params + "\nShape \"next\""));
  expect_only(parsed, Severity::Error, 2, m.column, m.message, m.remedy);
  // Whatever was wrong, the next statement is read.
  EXPECT_EQ(parsed.scene().shapes.back().plugin, "next");
}

INSTANTIATE_TEST_SUITE_P(
    All, ParameterMistake,
    testing::Values(Mistake{"\"radius\" [ 1 ]", 11, "a type and a name", "float radius"},
                    Mistake{"\"float\" 1", 11, "a type and a name", ""}, Mistake{"\"\" 1", 11, "a type and a name", ""},
                    Mistake{"\"float a b\" 1", 11, "a type and a name", ""},
                    Mistake{"\"real r\" [ 1 ]", 11, "unknown parameter type \"real\"", "the types are integer, float"},
                    Mistake{"\"flaot r\" 1", 11, "unknown parameter type", "did you mean \"float\"?"},
                    Mistake{"\"real r\" [ [ 1 ] 2 ]", 11, "unknown parameter type", ""},
                    Mistake{"\"float r\"", 11, "has no value", "numbers"},
                    Mistake{"\"float r\" \"float q\" 1", 11, "has no value", ""},
                    Mistake{"\"string r\"", 11, "has no value", "strings"},
                    Mistake{"\"float r\" \"big\"", 21, "takes numbers, not the string \"big\"", ""},
                    Mistake{"\"float r\" [ \"big\" ]", 23, "takes numbers, not the string \"big\"", ""},
                    Mistake{"\"string r\" 12", 22, "takes strings in quotes, not the number \"12\"", ""},
                    Mistake{"\"texture r\" [ 12 ]", 25, "takes the name of a texture", ""},
                    Mistake{"\"bool r\" true", 20, "not \"true\"", "quotes"},
                    Mistake{"\"bool r\" [ 1 ]", 22, "not \"1\"", ""},
                    Mistake{"\"float r\" [ 1 \"two\" ]", 25, "numbers and strings", ""},
                    Mistake{"\"spectrum r\" [ \"two\" 1 ]", 32, "numbers and strings", ""},
                    Mistake{"\"string r\" [ \"two\" 1 ]", 30, "numbers and strings", ""},
                    Mistake{"\"float r\" [ [ 1 ] ]", 23, "a list inside a list", ""},
                    Mistake{"\"float r\" [ 1", 21, "list not closed", "closing ]"},
                    Mistake{"\"float r\" [ 1 abc ]", 25, "\"abc\" is not a number", ""},
                    Mistake{"\"float r\" [ 1 nan ]", 25, "\"nan\" is not a number", ""},
                    Mistake{"\"float r\" inf", 21, "\"inf\" is not a number", ""},
                    Mistake{"\"float r\" [ 1 1.5x ]", 25, "\"1.5x\" is not a number", ""},
                    Mistake{"\"float r\" [1,5 2]", 22, "\"1,5\" is not a number", "spaces"},
                    Mistake{"\"float r\" [1 1.5x, 2]", 24, "\"1.5x,\" is not a number", ""},
                    Mistake{"\"float r\" [1 , 2]", 24, "\",\" is not a number", ""},
                    Mistake{"\"float r\" 1e999", 21, "too large", ""},
                    Mistake{"\"integer r\" [ 1 3000000000 ]", 27, "out of range", ""},
                    Mistake{"\"float r\" 1 2", 21, "without brackets", "[ and ]"},
                    Mistake{"\"float r\" 1 ]", 23, "unexpected ]", ""},
                    Mistake{"\"float r\" [ 1 ] 2", 27, "unexpected number \"2\"", ""},
                    Mistake{"\"rgb r\" [ 1 2 ]", 19, "has 2 numbers, but one rgb is 3", ""},
                    Mistake{"\"rgb r\" 1", 19, "has 1 number, but one rgb is 3", ""},
                    Mistake{"\"point r\" [ 1 2 3 4 ]", 21, "one point3 is 3", ""},
                    Mistake{"\"point2 r\" [ 1 2 3 ]", 22, "one point2 is 2", ""},
                    Mistake{"\"blackbody r\" [ 3000 ]", 25, "pairs of temperature", ""},
                    Mistake{"\"spectrum r\" [ 400 1 500 ]", 24, "pairs of wavelength", ""},
                    Mistake{"\"string r\" \"open", 22, "string not closed", "closing \""},
                    Mistake{"\"string r\" [ \"open", 24, "string not closed", ""},
                    Mistake{"\"string r", 11, "string not closed", ""},
                    Mistake{"\"string r\" \"a\\qb\"", 24, "unknown escape", "backslash"}));

}  // namespace
}  // namespace whit
