// Every parameter type, and what is said about every mistake.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/plugin/registry.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

template <class T>
class ConstantTexture : public Texture<T> {
 public:
  void evaluate(const ShadingBatch&, const typename Texture<T>::Lanes&) const override {}
};

/// A plugin with a parameter of every type. Not registered: the tests' registry holds what the program has.
struct Everything : Plugin {
  float f = 0;
  std::optional<float> maybe;
  std::optional<bool> flag_maybe;
  int i = 0;
  bool b = false;
  std::string s;
  RGB colour;
  Point point;
  Vector vector;
  FileName file;
  Choice mode;
  Tex<float> tf;
  Tex<RGB> ts;
  FloatList floats;
  IntegerList integers;
  Point2List points2;
  Point3List points3;
  Vector3List vectors;
  NormalList normals;
};

template <class... D>
PluginInfo make_info(const D&... declared) {
  PluginInfo info;
  info.category = "test", info.name = "everything";
  (info.params.push_back(declared.spec), ...);
  return info;
}

const PluginInfo& info() {
  using E = Everything;
  static const PluginInfo made =
      make_info(param(&E::f, "f", 1.5f, Unit::Degrees, "d", Range{0, 10}), param(&E::maybe, "maybe", Unit::None, "d"),
                param(&E::flag_maybe, "flagmaybe", Unit::None, "d"), param(&E::i, "i", 3, Unit::None, "d", kPositive),
                param(&E::b, "b", true, Unit::None, "d"), param(&E::s, "s", "text", Unit::None, "d"),
                param(&E::colour, "colour", RGB(0.25f), Unit::None, "d", kNonNegative),
                param(&E::point, "point", Point{{1, 2, 3}}, Unit::None, "d"),
                param(&E::vector, "vector", Vector{{0, 0, 1}}, Unit::None, "d"),
                param(&E::file, "file", Unit::None, "d"), choice(&E::mode, "mode", {"repeat", "black", "clamp"}, "d"),
                param(&E::tf, "tf", 0.5f, Unit::None, "d", kUnit), param(&E::ts, "ts", RGB(1.0f), Unit::None, "d"),
                param(&E::floats, "floats", Unit::None, "d", kUnit), param(&E::integers, "integers", Unit::None, "d"),
                param(&E::points2, "points2", Unit::None, "d"), param(&E::points3, "points3", Unit::None, "d"),
                param(&E::vectors, "vectors", Unit::None, "d"), param(&E::normals, "normals", Unit::None, "d"));
  return made;
}

template <class V>
Parameter make(ParamType type, const char* name, std::vector<V> values) {
  Parameter p;
  p.type = type, p.name = name, p.values = std::move(values);
  p.where = {0, 10}, p.values_at = {0, 20};
  return p;
}
Parameter numbers(ParamType type, const char* name, std::vector<double> v) { return make(type, name, std::move(v)); }
Parameter strings(const char* name, std::vector<std::string> v) { return make(ParamType::String, name, std::move(v)); }

class Binding : public ::testing::Test {
 protected:
  Binding() {
    ctx.diagnostics = &diagnostics;
    ctx.statement_name = "everything";
    ctx.folder = test::temp_folder();
    ctx.value_position = [](const Parameter& p, size_t i) { return SourcePos{0, p.values_at.offset + i}; };
    ctx.float_texture = [](int i, const std::string&) {
      return i == 0 ? std::make_shared<ConstantTexture<float>>() : nullptr;
    };
    ctx.spectrum_texture = [](int i, const std::string&) {
      return i == 0 ? std::make_shared<ConstantTexture<RGB>>() : nullptr;
    };
  }
  bool bind(Parameter p) { return bind(ParameterList{std::move(p)}); }
  bool bind(ParameterList list) {
    diagnostics = {};
    kept = std::move(list);
    return bind_parameters(info(), plugin, kept, ctx);
  }
  /// "error@offset: message / remedy" of the only diagnostic; "" when there is none.
  std::string said() const {
    if (diagnostics.all().empty()) return "";
    EXPECT_EQ(diagnostics.all().size(), 1u);
    const Diagnostic& d = diagnostics.all()[0];
    const char* kind = d.severity == Severity::Warning     ? "warning"
                       : d.error_class == ErrorClass::File ? "file error"
                                                           : "error";
    std::string text = std::string(kind) + '@' + std::to_string(d.where.offset) + ": " + d.message;
    return d.remedy.empty() ? text : text + " / " + d.remedy;
  }
  void fails(Parameter p, const std::string& expected) {
    EXPECT_FALSE(bind(std::move(p)));
    EXPECT_EQ(said(), expected);
  }
  void warns(Parameter p, const std::string& expected) {
    EXPECT_TRUE(bind(std::move(p)));
    EXPECT_EQ(said(), expected);
  }
  std::string write(const char* name, const std::string& text) {
    std::ofstream(std::filesystem::path(test::temp_folder()) / name) << text;
    return name;
  }

  Diagnostics diagnostics;
  BindContext ctx;
  Everything plugin;
  ParameterList kept;
};

TEST_F(Binding, EveryScalarType) {
  EXPECT_TRUE(bind({numbers(ParamType::Float, "f", {2.5}), numbers(ParamType::Float, "maybe", {7}),
                    make<uint8_t>(ParamType::Bool, "flagmaybe", {0}), make<int32_t>(ParamType::Integer, "i", {4}),
                    make<uint8_t>(ParamType::Bool, "b", {1}), strings("s", {"hello"}),
                    numbers(ParamType::Point3, "point", {1e6, 2, 3}), numbers(ParamType::Vector3, "vector", {4, 5, 6}),
                    strings("mode", {"clamp"})}));
  EXPECT_EQ(said(), "");
  EXPECT_EQ(plugin.f, 2.5f);
  EXPECT_EQ(plugin.maybe, 7.0f);
  EXPECT_EQ(plugin.flag_maybe, false);
  EXPECT_EQ(plugin.i, 4);
  EXPECT_TRUE(plugin.b);
  EXPECT_EQ(plugin.s, "hello");
  EXPECT_EQ(plugin.point.value, Vec3d(1e6, 2, 3));
  EXPECT_EQ(plugin.vector.value, Vec3d(4, 5, 6));
  EXPECT_EQ(plugin.mode.index, 2);
}

TEST_F(Binding, Lists) {
  EXPECT_TRUE(bind(
      {numbers(ParamType::Float, "floats", {0, 1, 0.5}), make<int32_t>(ParamType::Integer, "integers", {1, 2}),
       numbers(ParamType::Point2, "points2", {1, 2, 3, 4}), numbers(ParamType::Point3, "points3", {1, 2, 3}),
       numbers(ParamType::Vector3, "vectors", {1, 2, 3}), numbers(ParamType::Normal3, "normals", {1, 2, 3, 4, 5, 6})}));
  EXPECT_EQ(said(), "");
  EXPECT_EQ(plugin.floats.size(), 3u);
  EXPECT_EQ(plugin.integers.values[1], 2);
  EXPECT_EQ(plugin.points2.size(), 4u);
  EXPECT_EQ(plugin.normals.values[5], 6);
  EXPECT_TRUE(plugin.normals.given);
  EXPECT_EQ(plugin.normals.values.data(), kept[5].numbers().data()) << "lists are not copied";
  fails(numbers(ParamType::Point3, "points3", {1, 2, 3, 4}),
        "error@20: \"points3\" of everything has 4 numbers, not a multiple of 3");
  fails(numbers(ParamType::Float, "floats", {0, 2}),
        "error@21: \"floats\" of everything must be between 0 and 1, not 2");
}

TEST_F(Binding, Colours) {
  EXPECT_TRUE(bind(numbers(ParamType::Rgb, "colour", {0.5, 0.25, 1})));
  EXPECT_EQ(plugin.colour, RGB(0.5f, 0.25f, 1));
  // Row sums of the XYZ to Rec.709 matrix.
  EXPECT_TRUE(bind(numbers(ParamType::Xyz, "colour", {1, 1, 1})));
  EXPECT_NEAR(plugin.colour.x, 1.204794, 1e-6);
  EXPECT_TRUE(bind(numbers(ParamType::Blackbody, "colour", {6504, 2})));
  EXPECT_NEAR(luminance(plugin.colour), 1.8, 0.1);
  EXPECT_TRUE(bind(numbers(ParamType::Spectrum, "colour", {300, 2, 900, 2})));
  const RGB flat = plugin.colour;
  EXPECT_NEAR(luminance(flat), 2 * 470.0 / 471, 1e-3);
  EXPECT_TRUE(bind(make<std::string>(ParamType::Spectrum, "colour", {write("flat.spd", "300 2\n900 2")})));
  EXPECT_EQ(plugin.colour, flat);
  EXPECT_TRUE(bind(numbers(ParamType::Rgb, "ts", {0.5, 0.25, 1})));
  EXPECT_EQ(plugin.ts.value(), RGB(0.5f, 0.25f, 1));
}

TEST_F(Binding, ColourMistakes) {
  fails(numbers(ParamType::Rgb, "colour", {1, -1, 1}), "error@21: \"colour\" of everything must be at least 0, not -1");
  fails(numbers(ParamType::Rgb, "colour", {1, 1}),
        "error@20: \"colour\" of everything has 2 numbers, not a multiple of 3");
  fails(numbers(ParamType::Blackbody, "colour", {0, 1}),
        "error@20: \"colour\" of everything must be a temperature above 0 kelvin, not 0");
  fails(numbers(ParamType::Spectrum, "colour", {400, 1, 500}),
        "error@22: \"colour\" of everything has a wavelength without a value at its end");
  EXPECT_FALSE(bind(make<std::string>(ParamType::Spectrum, "colour", {"missing.spd"})));
  EXPECT_EQ(said().rfind("file error@20: cannot open missing.spd / ", 0), 0u) << said();
  fails(make<std::string>(ParamType::Spectrum, "colour", {write("bad.spd", "400 x")}),
        "file error@20: cannot read bad.spd: line 1: expected a number");
}

TEST_F(Binding, RangesAndFiniteness) {
  fails(numbers(ParamType::Float, "f", {11}), "error@20: \"f\" of everything must be between 0 and 10, not 11");
  fails(numbers(ParamType::Float, "maybe", {1e300}),
        "error@20: \"maybe\" of everything is not a finite number: 1e+300");
  fails(numbers(ParamType::Float, "f", {std::numeric_limits<double>::quiet_NaN()}),
        "error@20: \"f\" of everything is not a finite number: nan");
  fails(make<int32_t>(ParamType::Integer, "i", {0}), "error@20: \"i\" of everything must be above 0, not 0");
  fails(numbers(ParamType::Float, "tf", {2}), "error@20: \"tf\" of everything must be between 0 and 1, not 2");
  plugin.mode.index = 0;
  warns(strings("mode", {"clmp"}),
        "warning@20: \"mode\" of everything is \"clmp\", not one of \"repeat\", \"black\", \"clamp\" / did you mean "
        "\"clamp\"? \"repeat\" is used");
  EXPECT_EQ(plugin.mode.index, 0);
}

TEST_F(Binding, NumberOfValues) {
  plugin.f = 1.5f;
  for (const Parameter& none : {numbers(ParamType::Float, "f", {}), numbers(ParamType::Spectrum, "colour", {}),
                                numbers(ParamType::Rgb, "ts", {}), make<int32_t>(ParamType::Integer, "i", {}),
                                strings("mode", {}), numbers(ParamType::Point3, "point", {})}) {
    warns(none, "warning@20: parameter \"" + none.name +
                    "\" of everything has an empty list of values / the parameter is ignored");
  }
  EXPECT_EQ(plugin.f, 1.5f);
  // A list may be empty: whether it is missed is its plugin's business.
  warns(numbers(ParamType::Float, "floats", {}), "");
  EXPECT_FALSE(plugin.floats.given);
  // pbrt-v3's FindOneFloat looks only at parameters with exactly one value.
  warns(numbers(ParamType::Float, "f", {2, 3}),
        "warning@20: \"f\" of everything takes one value, not 2 / the parameter is ignored, as in pbrt-v3");
  EXPECT_EQ(plugin.f, 1.5f);
  // But its GetFloatTexture and GetSpectrumTexture take the first.
  warns(numbers(ParamType::Float, "tf", {0.25, 3}),
        "warning@20: \"tf\" of everything takes one value, not 2 / the first is used, as in pbrt-v3");
  EXPECT_EQ(plugin.tf.value(), 0.25f);
  warns(numbers(ParamType::Rgb, "ts", {1, 2, 3, 4, 5, 6}),
        "warning@20: \"ts\" of everything takes one value, not 2 / the first is used, as in pbrt-v3");
  EXPECT_EQ(plugin.ts.value(), RGB(1, 2, 3));
}

TEST_F(Binding, NameAndExactType) {
  warns(make<int32_t>(ParamType::Integer, "f", {20}),
        "warning@10: parameter \"f\" of everything is of type float, not integer / the default 1.5 is used");
  EXPECT_EQ(plugin.f, 0) << "untouched";
  warns(numbers(ParamType::Float, "colour", {1}),
        "warning@10: parameter \"colour\" of everything is of type rgb, xyz, blackbody or spectrum, not float / the "
        "default 0.25 0.25 0.25 is used");
  warns(numbers(ParamType::Float, "pont", {1}),
        "warning@10: everything has no parameter \"pont\" / did you mean \"point\"?");
  warns(numbers(ParamType::Float, "zzzzzzzz", {1}),
        "warning@10: everything has no parameter \"zzzzzzzz\" / it is ignored");
}

TEST_F(Binding, ParametersOfAnotherPluginAreKnown) {
  PluginInfo other;
  other.name = "other";
  other.params.push_back(info().params[0]);
  other.params[0].name = "theirs";
  kept = {numbers(ParamType::Float, "theirs", {1})};
  EXPECT_TRUE(bind_parameters(info(), plugin, kept, ctx, {&other}));
  EXPECT_EQ(said(), "");
}

TEST_F(Binding, Textures) {
  const auto reference = [](const char* name, int f, int s) {
    return make<TextureRef>(ParamType::Texture, name, {TextureRef{"wood", f, s}});
  };
  EXPECT_TRUE(bind(reference("tf", 0, -1)));
  EXPECT_FALSE(plugin.tf.is_constant());
  EXPECT_TRUE(bind(reference("ts", -1, 0)));
  EXPECT_FALSE(plugin.ts.is_constant());
  // Of the other kind: pbrt-v3 complains and renders without it.
  plugin.tf = Tex<float>(0.25f);
  warns(reference("tf", -1, 0),
        "warning@20: \"tf\" of everything needs a float texture; \"wood\" is a spectrum texture / it is ignored, as in "
        "pbrt-v3");
  EXPECT_EQ(plugin.tf.value(), 0.25f);
  warns(reference("ts", 0, -1),
        "warning@20: \"ts\" of everything needs a spectrum texture; \"wood\" is a float texture / it is ignored, as in "
        "pbrt-v3");
  fails(reference("tf", -1, -1), "error@20: no texture named \"wood\" / a texture must be defined before it is used");
  // The texture wins over the value of the same name, wherever it stands.
  plugin.tf = Tex<float>(0.0f);
  EXPECT_TRUE(bind({reference("tf", 0, -1), numbers(ParamType::Float, "tf", {1})}));
  EXPECT_FALSE(plugin.tf.is_constant());
}

TEST_F(Binding, FileNames) {
  EXPECT_TRUE(bind(strings("file", {write("there.txt", "x")})));
  EXPECT_EQ(said(), "");
  EXPECT_TRUE(std::filesystem::path(plugin.file.path).is_absolute());
  EXPECT_EQ(plugin.file.as_given, "there.txt");
  EXPECT_EQ(plugin.file.where.offset, 20u);
  EXPECT_FALSE(bind(strings("file", {"missing.png"})));
  EXPECT_EQ(said().rfind("file error@20: cannot open missing.png / ", 0), 0u) << said();
  EXPECT_NE(said().find("No such file"), std::string::npos);
  EXPECT_FALSE(bind(strings("file", {"/"})));
}

/// A kind of plugin of the test's own.
struct Tested : Plugin {
  static constexpr const char* kCategory = "registry test";
};

TEST(Registry, SecondPluginOfANameIsRefused) {
  const std::vector<std::string> alias{"uno"};
  const Register<Tested> one(alias, "one", "A test.");
  EXPECT_THROW(Register<Tested>("one", "The same name."), std::logic_error);
  EXPECT_THROW(Register<Tested>(alias, "two", "The same alias."), std::logic_error);
  EXPECT_EQ(find_plugin("registry test", "uno"), find_plugin("registry test", "one"));
  EXPECT_EQ(find_plugin("registry test", "two"), nullptr);
}

}  // namespace
}  // namespace whit
