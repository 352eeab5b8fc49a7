// A plugin's parameters, declared once: the table that feeds binding, checks, help, docs and did-you-mean.
//
//   param(&Matte::sigma, "sigma", 0.0f, Unit::Degrees, "Oren-Nayar roughness; 0 is Lambertian.")
//
// The type of the parameter in a scene file is inferred from the member: float, int, bool, std::string, RGB,
// Point, Vector, Choice, FileName, lists of them as spans, Tex<float>, Tex<RGB> for texturable ones, and
// std::shared_ptr<Material> for the name of a material.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/diagnostics.h"
#include "core/base/parameter.h"
#include "core/base/vec.h"
#include "core/plugin/texture.h"

namespace whit {

/// What a parameter's number means; shown in help and docs.
enum class Unit : uint8_t { None, Degrees, Length, Radiance, Intensity, Irradiance, Seconds, Millimetres, Pixels };
const char* unit_name(Unit unit);  ///< "degrees", "scene length", ...; "" for None.

/// Closed range of allowed numbers. Values outside are errors at the value's own place, or where `excused` mistakes that
/// are rendered past as pbrt-v3 does (Diagnostic::excused).
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool excused = false;
};
inline constexpr Range kAny{};
inline constexpr Range kNonNegative{0.0};
inline constexpr Range kPositive{std::numeric_limits<double>::min()};
inline constexpr Range kUnit{0.0, 1.0};
/// Of roughness: pbrt-v3 takes a negative one as the smoothest that there is, or its square.
inline constexpr Range kRoughness{0.0, std::numeric_limits<double>::infinity(), true};
std::string range_text(const Range& range);  ///< "above 0", "between 0 and 1", ...

/// A point or vector parameter in double precision, as the file gives it.
struct Point {
  Vec3d value{0, 0, 0};
};
struct Vector {
  Vec3d value{0, 0, 0};
};

/// The path of a file, resolved against the main file's folder when bound. Existence is checked at binding
/// (a missing file is an error of class File at the value's place); reading waits for Plugin::prepare.
struct FileName {
  std::string path;  ///< Absolute, or "" when the parameter is absent.
  std::string as_given;
  SourcePos where;
  bool empty() const { return path.empty(); }
};

/// A string out of a fixed list, kept as the index into it.
struct Choice {
  int index = 0;
};

/// Values that stay in the scene description (which outlives building): large arrays are not copied.
/// Doubles for float, point and vector lists; flat, three (or two) per point.
template <class T>
struct List {
  std::span<const T> values;
  SourcePos where;  ///< Of the values.
  bool given = false;
  size_t size() const { return values.size(); }
};
struct FloatList : List<double> {};
struct Point2List : List<double> {};
struct Point3List : List<double> {};
struct Vector3List : List<double> {};
struct NormalList : List<double> {};
struct IntegerList : List<int32_t> {};
struct StringList : List<std::string> {};
/// Pairs of surface parameters, which pbrt-v3 takes as floats or as point2 alike. Bound in shape.cpp.
struct UvList : List<double> {};

/// A parameter that may be a texture and could not be read. What it gives is not wrong unless the plugin asks for it.
struct MissingParameter {
  std::shared_ptr<const Plugin> stand_in;  ///< What the plugin has instead.
  size_t first_problem = 0, problems = 0;  ///< What was said of it, in BindContext::diagnostics.
};

/// What binding needs to know of the scene around a statement.
struct BindContext {
  Diagnostics* diagnostics = nullptr;
  SourcePos statement;         ///< The directive being bound.
  std::string statement_name;  ///< "sphere", for messages.
  std::string folder;          ///< Of the main scene file; relative paths start here.
  /// The bound texture of a TextureRef in the float or spectrum name space, for the parameter named; null when there is
  /// none.
  std::function<std::shared_ptr<Texture<float>>(int, const std::string&)> float_texture;
  std::function<std::shared_ptr<Texture<RGB>>(int, const std::string&)> spectrum_texture;
  /// What the name of a texture that is not there may have been meant to be, as a remedy; empty when nothing is near.
  std::function<Remedy(const std::string&)> texture_hint;
  bool with_textures = true;  ///< Else a parameter that names one which is not constant keeps its default.
  /// Where parameters that could not be read are listed; when null, the first of them makes binding fail.
  std::vector<MissingParameter>* missing = nullptr;
  /// Finds the bound material of a name (for mix), null when its statement is unusable; false when there is none.
  std::function<bool(const std::string&, std::shared_ptr<class Material>&)> named_material;
  /// The place of the i-th value of a parameter.
  std::function<SourcePos(const Parameter&, size_t)> value_position;

  SourcePos at(const Parameter& p, size_t i = 0) const { return value_position ? value_position(p, i) : p.values_at; }
};

/// One declared parameter of a plugin class, type-erased.
struct ParamSpec {
  std::string name;
  std::vector<ParamType> accepts;  ///< The types it may be declared with, the usual one first.
  std::string default_text;
  Unit unit = Unit::None;
  Range range;
  std::string doc;
  std::vector<std::string> choices;  ///< Of a Choice, else empty.
  bool is_file = false;              ///< Its value is the path of a file.
  bool is_list = false;              ///< It takes any number of values, none too.
  /// Stores the parameter's value into the plugin, which must be of the class the spec was declared for.
  /// Reports errors; returns false after an error.
  std::function<bool(Plugin& plugin, const Parameter&, const BindContext&)> bind;
};

namespace detail {

/// How a member type is read from a parameter. Specialised in param.cpp for every supported type.
template <class T>
struct Binding {
  static std::vector<ParamType> accepts();
  static std::string to_text(const T& value);
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, T& out);
};

template <class T>
inline constexpr bool kIsList = requires(const T& value) {
  value.values.size();
};

bool read_choice(const Parameter& p, const BindContext& ctx, const std::vector<std::string>& choices, Choice& out);

template <class T>
struct DefaultOf {
  using type = T;
};
template <>
struct DefaultOf<Tex<float>> {
  using type = float;
};
template <>
struct DefaultOf<Tex<RGB>> {
  using type = RGB;
};
template <>
struct DefaultOf<std::string> {
  using type = const char*;
};

}  // namespace detail

/// Declares a parameter: the member it fills, its name in scene files, default, unit, a sentence of
/// documentation and the range of allowed values. The default is stored in the member's own initialiser by
/// the registry before binding, so it is written only here.
template <class Class, class T>
struct DeclaredParam {
  T Class::*member;
  T default_value;
  ParamSpec spec;
};

namespace detail {
template <class Class, class T>
DeclaredParam<Class, T> declare(T Class::*member, const char* name, T default_value, Unit unit, const char* doc,
                                Range range) {
  DeclaredParam<Class, T> d{member, std::move(default_value), {}};
  d.spec.name = name;
  d.spec.accepts = Binding<T>::accepts();
  d.spec.unit = unit;
  d.spec.range = range;
  d.spec.doc = doc;
  d.spec.is_file = std::is_same_v<T, FileName>;
  d.spec.is_list = kIsList<T>;
  d.spec.bind = [member, range](Plugin& plugin, const Parameter& p, const BindContext& ctx) {
    return Binding<T>::read(p, ctx, range, static_cast<Class&>(plugin).*member);
  };
  return d;
}
}  // namespace detail

template <class Class, class T>
DeclaredParam<Class, T> param(T Class::*member, const char* name, typename detail::DefaultOf<T>::type default_value,
                              Unit unit, const char* doc, Range range = kAny) {
  auto d = detail::declare(member, name, T(default_value), unit, doc, range);
  d.spec.default_text = detail::Binding<T>::to_text(d.default_value);
  return d;
}

/// A parameter without a default: a list, a file name or an optional value, absent unless given.
template <class Class, class T>
DeclaredParam<Class, T> param(T Class::*member, const char* name, Unit unit, const char* doc, Range range = kAny) {
  return detail::declare(member, name, T{}, unit, doc, range);
}

/// A string parameter with a fixed list of values, the first being the default, also for a string that is none of them.
template <class Class>
DeclaredParam<Class, Choice> choice(Choice Class::*member, const char* name, std::vector<std::string> choices,
                                    const char* doc) {
  DeclaredParam<Class, Choice> d{member, Choice{0}, {}};
  d.spec.name = name;
  d.spec.accepts = {ParamType::String};
  d.spec.default_text = '"' + choices.front() + '"';
  d.spec.doc = doc;
  d.spec.choices = choices;
  d.spec.bind = [member, choices](Plugin& plugin, const Parameter& p, const BindContext& ctx) {
    return detail::read_choice(p, ctx, choices, static_cast<Class&>(plugin).*member);
  };
  return d;
}

}  // namespace whit
