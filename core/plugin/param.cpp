// How each member type is read from a parameter of a scene file. What is wrong is reported at the value's own place.
#include "core/plugin/param.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "core/base/limits.h"
#include "core/base/path_hint.h"
#include "core/base/spectrum.h"

namespace whit {

const char* unit_name(Unit unit) {
  switch (unit) {
    case Unit::None: return "";
    case Unit::Degrees: return "degrees";
    case Unit::Length: return "scene length";
    case Unit::Radiance: return "radiance";
    case Unit::Intensity: return "radiant intensity";
    case Unit::Irradiance: return "irradiance";
    case Unit::Seconds: return "seconds";
    case Unit::Millimetres: return "millimetres";
    case Unit::Pixels: return "pixels";
  }
  return "unknown";
}

namespace {

/// The shortest decimal that reads back as the same number.
template <class Number>
std::string number_text(Number v) {
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, v);
  return code == std::errc() ? std::string(buffer, end) : std::string("?");
}

}  // namespace

std::string range_text(const Range& r) {
  const bool low = std::isfinite(r.min), high = std::isfinite(r.max);
  // The smallest positive number stands for an open end, see kPositive.
  const bool positive = r.min == kPositive.min || r.min == static_cast<double>(std::numeric_limits<float>::min());
  if (low && high)
    return (positive ? "above 0 and at most " : "between " + number_text(r.min) + " and ") + number_text(r.max);
  if (low) return positive ? "above 0" : "at least " + number_text(r.min);
  return high ? "at most " + number_text(r.max) : "any number";
}

namespace {

std::string vector_text(const Vec3d& v) { return number_text(v.x) + ' ' + number_text(v.y) + ' ' + number_text(v.z); }

/// What a message calls the parameter: "radius" of sphere.
std::string called(const Parameter& p, const BindContext& ctx) {
  const std::string name = '"' + p.name + '"';
  return ctx.statement_name.empty() ? name : name + " of " + ctx.statement_name;
}

bool fail(const BindContext& ctx, SourcePos where, std::string message, Remedy remedy = {}) {
  ctx.diagnostics->error(where, std::move(message), std::move(remedy));
  return false;
}

/// How many values a parameter that takes one has.
enum class Count { None, One, Several };

/// Counts values of `numbers_each` numbers. None and incomplete values are errors; several warn, and the default
/// holds, because pbrt-v3 looks only at parameters with exactly one value.
Count count_values(const Parameter& p, const BindContext& ctx, size_t numbers, size_t numbers_each = 1) {
  if (numbers % numbers_each != 0) {
    fail(ctx, p.values_at,
         called(p, ctx) + " has " + std::to_string(numbers) + " numbers, not a multiple of " +
             std::to_string(numbers_each));
    return Count::None;
  }
  if (numbers == numbers_each) return Count::One;
  ctx.diagnostics->warning(p.values_at,
                           called(p, ctx) + " takes one value, not " + std::to_string(numbers / numbers_each),
                           "the parameter is ignored, as in pbrt-v3");
  return Count::Several;
}

/// The parameter with its first value of `numbers_each` numbers alone, and a warning. Where a texture may stand pbrt-v3
/// takes the first of several values.
Parameter first_value(const Parameter& p, const BindContext& ctx, size_t numbers_each) {
  ctx.diagnostics->warning(
      p.values_at, called(p, ctx) + " takes one value, not " + std::to_string(p.numbers().size() / numbers_each),
      "the first is used, as in pbrt-v3");
  Parameter first = p;
  std::get<std::vector<double>>(first.values).resize(numbers_each);
  return first;
}

/// Checks a number as it will be used: rounded to Stored (float or double).
template <class Stored>
bool check_number(const Parameter& p, const BindContext& ctx, const Range& range, double v, size_t i = 0) {
  const double used = static_cast<double>(static_cast<Stored>(v));
  if (!std::isfinite(used))
    return fail(ctx, ctx.at(p, i), called(p, ctx) + " is not a finite number: " + number_text(v));
  if (used >= range.min && used <= range.max) return true;
  if (range.excused) {
    ctx.diagnostics->excused(ctx.at(p, i), called(p, ctx) + " must be " + range_text(range) + ", not " + number_text(v),
                             "it is rendered as pbrt-v3 does");
    return true;
  }
  return fail(ctx, ctx.at(p, i), called(p, ctx) + " must be " + range_text(range) + ", not " + number_text(v));
}

/// `as_given` as a path: absolute stays, relative starts at the main file's folder.
std::string resolve(const BindContext& ctx, const std::string& as_given) {
  const std::filesystem::path path(as_given);
  return (path.is_absolute() ? path : std::filesystem::path(ctx.folder) / path).lexically_normal().string();
}

bool check_readable(const Parameter& p, const BindContext& ctx, const std::string& as_given, const std::string& path) {
  const std::string reason = why_unreadable(path);
  if (reason.empty()) return true;
  const std::string hint = path_hint(as_given);
  ctx.diagnostics->file_error(ctx.at(p), "cannot open " + as_given,
                              path + ": " + reason + (hint.empty() ? "" : "; " + hint));
  return false;
}

bool read_rgb(const Parameter& p, const BindContext& ctx, const Range& range, RGB& out) {
  const auto& v = p.numbers();
  if (const Count count = count_values(p, ctx, v.size(), 3); count != Count::One) return count == Count::Several;
  // Converted colours may leave the gamut below 0 by a little; only components written as such are held to the range.
  const Range held = p.type == ParamType::Rgb ? range : kAny;
  for (size_t i = 0; i < 3; ++i)
    if (!check_number<float>(p, ctx, held, v[i], i)) return false;
  out = p.type == ParamType::Xyz ? rgb_from_xyz(v[0], v[1], v[2])
                                 : RGB(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  return true;
}

bool read_blackbody(const Parameter& p, const BindContext& ctx, RGB& out) {
  const auto& v = p.numbers();
  if (const Count count = count_values(p, ctx, v.size(), 2); count != Count::One) return count == Count::Several;
  if (!(v[0] > 0) || !std::isfinite(v[0]))
    return fail(ctx, ctx.at(p), called(p, ctx) + " must be a temperature above 0 kelvin, not " + number_text(v[0]));
  if (!check_number<float>(p, ctx, kAny, v[1], 1)) return false;
  out = rgb_from_blackbody(v[0], v[1]);
  return true;
}

bool read_spd(const Parameter& p, const BindContext& ctx, RGB& out) {
  const auto& names = p.strings();
  if (const Count count = count_values(p, ctx, names.size()); count != Count::One) return count == Count::Several;
  const std::string path = resolve(ctx, names[0]);
  if (!check_readable(p, ctx, names[0], path)) return false;
  const SpdFile file = read_spd_file(path);
  if (!file.error.empty()) {
    ctx.diagnostics->file_error(ctx.at(p), "cannot read " + names[0] + ": " + file.error);
    return false;
  }
  out = rgb_from_samples(file.pairs);
  return true;
}

bool read_spectrum(const Parameter& p, const BindContext& ctx, RGB& out) {
  if (!p.strings().empty()) return read_spd(p, ctx, out);
  const auto& v = p.numbers();
  if (v.empty()) return fail(ctx, p.values_at, called(p, ctx) + " has no value");
  if (v.size() % 2 != 0)
    return fail(ctx, ctx.at(p, v.size() - 1), called(p, ctx) + " has a wavelength without a value at its end");
  for (size_t i = 0; i < v.size(); ++i)
    if (!check_number<float>(p, ctx, kAny, v[i], i)) return false;
  out = rgb_from_samples(v);
  return true;
}

bool read_colour(const Parameter& p, const BindContext& ctx, const Range& range, RGB& out) {
  switch (p.type) {
    case ParamType::Blackbody: return read_blackbody(p, ctx, out);
    case ParamType::Spectrum: return read_spectrum(p, ctx, out);
    default: return read_rgb(p, ctx, range, out);
  }
}

bool read_float(const Parameter& p, const BindContext& ctx, const Range& range, float& out) {
  const auto& v = p.numbers();
  if (const Count count = count_values(p, ctx, v.size()); count != Count::One) return count == Count::Several;
  if (!check_number<float>(p, ctx, range, v[0])) return false;
  out = static_cast<float>(v[0]);
  return true;
}

/// The texture a parameter names, in the name space of floats or of spectra.
template <class T>
bool read_texture(const Parameter& p, const BindContext& ctx, Tex<T>& out) {
  constexpr bool wants_float = std::is_same_v<T, float>;
  const auto& refs = p.textures();
  if (const Count count = count_values(p, ctx, refs.size()); count != Count::One) return count == Count::Several;
  const TextureRef& ref = refs[0];
  const int index = wants_float ? ref.float_texture : ref.spectrum_texture;
  const int other = wants_float ? ref.spectrum_texture : ref.float_texture;
  const char *wanted = wants_float ? "float" : "spectrum", *found = wants_float ? "spectrum" : "float";
  if (index < 0 && other >= 0) {
    ctx.diagnostics->warning(
        ctx.at(p), called(p, ctx) + " needs a " + wanted + " texture; \"" + ref.name + "\" is a " + found + " texture",
        "it is ignored, as in pbrt-v3");
    return true;
  }
  if (index < 0) {
    const Remedy hint = ctx.texture_hint ? ctx.texture_hint(ref.name) : Remedy();
    return fail(ctx, ctx.at(p), "no texture named \"" + ref.name + '"',
                hint.text.empty() ? "a texture must be defined before it is used" : hint);
  }
  std::shared_ptr<Texture<T>> texture;
  if constexpr (wants_float) texture = ctx.float_texture(index, p.name);
  else texture = ctx.spectrum_texture(index, p.name);
  if (!texture) return !ctx.with_textures;  // its own statement has the error
  if (ctx.with_textures || texture->constant()) out = Tex<T>(std::move(texture));
  return true;
}

/// Reads a parameter that may be a texture; one that cannot be read is kept as missing where BindContext wants that.
template <class T, class Read>
bool read_or_miss(const BindContext& ctx, Tex<T>& out, const Read& read) {
  const size_t before = ctx.diagnostics->all().size();
  if (read()) return true;
  if (!ctx.missing) return false;
  auto stand_in = std::make_shared<MissingTexture<T>>();
  ctx.missing->push_back({stand_in, before, ctx.diagnostics->all().size() - before});
  out = Tex<T>(std::move(stand_in));
  return true;
}

/// The values of a list of `numbers_each` numbers per element, left where they are.
template <class Number, class L>
bool read_list(const Parameter& p, const BindContext& ctx, const Range& range, const std::vector<Number>& v,
               size_t numbers_each, L& out) {
  if (v.size() % numbers_each != 0)
    return fail(ctx, p.values_at,
                called(p, ctx) + " has " + std::to_string(v.size()) + " numbers, not a multiple of " +
                    std::to_string(numbers_each));
  if (std::isfinite(range.min) || std::isfinite(range.max)) {
    for (size_t i = 0; i < v.size(); ++i)
      if (!check_number<double>(p, ctx, range, static_cast<double>(v[i]), i)) return false;
  }
  out.values = v;
  out.where = p.values_at;
  out.given = true;
  return true;
}

bool read_triple(const Parameter& p, const BindContext& ctx, Vec3d& out) {
  const auto& v = p.numbers();
  if (const Count count = count_values(p, ctx, v.size(), 3); count != Count::One) return count == Count::Several;
  for (size_t i = 0; i < 3; ++i)
    if (!check_number<double>(p, ctx, kAny, v[i], i)) return false;
  out = {v[0], v[1], v[2]};
  return true;
}

/// One member type: the parameter types it accepts, its text and how it is read.
template <class T>
struct Kind;

template <>
struct Kind<float> {
  static constexpr ParamType accepts[] = {ParamType::Float};
  static std::string text(float v) { return number_text(v); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, float& out) {
    return read_float(p, ctx, range, out);
  }
};

template <>
struct Kind<std::optional<float>> {
  static constexpr ParamType accepts[] = {ParamType::Float};
  static std::string text(const std::optional<float>& v) { return v ? number_text(*v) : std::string(); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, std::optional<float>& out) {
    float v = 0;
    const size_t count = p.numbers().size();
    if (!read_float(p, ctx, range, v)) return false;
    if (count == 1) out = v;
    return true;
  }
};

template <>
struct Kind<int> {
  static constexpr ParamType accepts[] = {ParamType::Integer};
  static std::string text(int v) { return number_text(v); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, int& out) {
    const auto& v = p.integers();
    if (const Count count = count_values(p, ctx, v.size()); count != Count::One) return count == Count::Several;
    if (!check_number<double>(p, ctx, range, v[0])) return false;
    out = v[0];
    return true;
  }
};

template <>
struct Kind<bool> {
  static constexpr ParamType accepts[] = {ParamType::Bool};
  static std::string text(bool v) { return v ? "true" : "false"; }
  static bool read(const Parameter& p, const BindContext& ctx, const Range&, bool& out) {
    const auto& v = p.bools();
    if (const Count count = count_values(p, ctx, v.size()); count != Count::One) return count == Count::Several;
    out = v[0] != 0;
    return true;
  }
};

template <>
struct Kind<std::optional<bool>> {
  static constexpr ParamType accepts[] = {ParamType::Bool};
  static std::string text(const std::optional<bool>& v) { return v ? Kind<bool>::text(*v) : std::string(); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, std::optional<bool>& out) {
    bool v = false;
    const size_t count = p.bools().size();
    if (!Kind<bool>::read(p, ctx, range, v)) return false;
    if (count == 1) out = v;
    return true;
  }
};

template <>
struct Kind<std::string> {
  static constexpr ParamType accepts[] = {ParamType::String};
  static std::string text(const std::string& v) { return '"' + v + '"'; }
  static bool read(const Parameter& p, const BindContext& ctx, const Range&, std::string& out) {
    const auto& v = p.strings();
    if (const Count count = count_values(p, ctx, v.size()); count != Count::One) return count == Count::Several;
    out = v[0];
    return true;
  }
};

template <>
struct Kind<FileName> {
  static constexpr ParamType accepts[] = {ParamType::String};
  static std::string text(const FileName& v) { return v.empty() ? std::string() : '"' + v.as_given + '"'; }
  static bool read(const Parameter& p, const BindContext& ctx, const Range&, FileName& out) {
    const auto& v = p.strings();
    if (const Count count = count_values(p, ctx, v.size()); count != Count::One) return count == Count::Several;
    if (v[0].empty()) return true;  // pbrt takes "" for no file
    const std::string path = resolve(ctx, v[0]);
    if (!check_readable(p, ctx, v[0], path)) return false;
    out.path = std::filesystem::absolute(path).string();
    out.as_given = v[0];
    out.where = ctx.at(p);
    return true;
  }
};

template <>
struct Kind<RGB> {
  static constexpr ParamType accepts[] = {ParamType::Rgb, ParamType::Xyz, ParamType::Blackbody, ParamType::Spectrum};
  static std::string text(const RGB& c) { return number_text(c.x) + ' ' + number_text(c.y) + ' ' + number_text(c.z); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, RGB& out) {
    return read_colour(p, ctx, range, out);
  }
};

template <>
struct Kind<Point> {
  static constexpr ParamType accepts[] = {ParamType::Point3};
  static std::string text(const Point& v) { return vector_text(v.value); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range&, Point& out) {
    return read_triple(p, ctx, out.value);
  }
};

template <>
struct Kind<Vector> {
  static constexpr ParamType accepts[] = {ParamType::Vector3};
  static std::string text(const Vector& v) { return vector_text(v.value); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range&, Vector& out) {
    return read_triple(p, ctx, out.value);
  }
};

template <>
struct Kind<Tex<float>> {
  static constexpr ParamType accepts[] = {ParamType::Float, ParamType::Texture};
  static std::string text(const Tex<float>& v) { return v.is_constant() ? number_text(v.value()) : std::string(); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, Tex<float>& out) {
    return read_or_miss(ctx, out, [&] { return read_it(p, ctx, range, out); });
  }

 private:
  static bool read_it(const Parameter& p, const BindContext& ctx, const Range& range, Tex<float>& out) {
    if (p.type == ParamType::Texture) return read_texture(p, ctx, out);
    if (p.numbers().size() > 1) return read_it(first_value(p, ctx, 1), ctx, range, out);
    float v = out.value();
    const bool ok = read_float(p, ctx, range, v);
    if (ok && p.numbers().size() == 1) out = Tex<float>(v);
    return ok;
  }
};

template <>
struct Kind<std::optional<Tex<float>>> {
  static constexpr ParamType accepts[] = {ParamType::Float, ParamType::Texture};
  static std::string text(const std::optional<Tex<float>>& v) { return v ? Kind<Tex<float>>::text(*v) : std::string(); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, std::optional<Tex<float>>& out) {
    // No value can be negative infinity: if it still is, the parameter was ignored.
    constexpr float none = -std::numeric_limits<float>::infinity();
    Tex<float> v(none);
    if (!Kind<Tex<float>>::read(p, ctx, range, v)) return false;
    if (!v.is_constant() || v.value() != none) out = v;
    return true;
  }
};

/// The name of a material.
template <>
struct Kind<std::shared_ptr<Material>> {
  static constexpr ParamType accepts[] = {ParamType::String};
  static std::string text(const std::shared_ptr<Material>&) { return {}; }
  static bool read(const Parameter& p, const BindContext& ctx, const Range&, std::shared_ptr<Material>& out) {
    const auto& v = p.strings();
    if (const Count count = count_values(p, ctx, v.size()); count != Count::One) return count == Count::Several;
    const bool known = ctx.named_material && ctx.named_material(v[0], out);
    if (known) return out != nullptr;  // its own statement has the error
    return fail(ctx, ctx.at(p), called(p, ctx) + " names a material that is not there: \"" + v[0] + '"',
                "a named material must be made before it is used");
  }
};

template <>
struct Kind<Tex<RGB>> {
  static constexpr ParamType accepts[] = {ParamType::Rgb, ParamType::Xyz, ParamType::Blackbody, ParamType::Spectrum,
                                          ParamType::Texture};
  static std::string text(const Tex<RGB>& v) { return v.is_constant() ? Kind<RGB>::text(v.value()) : std::string(); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, Tex<RGB>& out) {
    return read_or_miss(ctx, out, [&] { return read_it(p, ctx, range, out); });
  }

 private:
  static bool read_it(const Parameter& p, const BindContext& ctx, const Range& range, Tex<RGB>& out) {
    if (p.type == ParamType::Texture) return read_texture(p, ctx, out);
    const size_t each = p.type == ParamType::Blackbody ? 2 : 3, numbers = p.numbers().size();
    if (p.type != ParamType::Spectrum && numbers > each && numbers % each == 0)
      return read_it(first_value(p, ctx, each), ctx, range, out);
    RGB v = out.value();
    const bool ok = read_colour(p, ctx, range, v);
    if (ok) out = Tex<RGB>(v);
    return ok;
  }
};

template <>
struct Kind<std::optional<Tex<RGB>>> {
  static constexpr auto& accepts = Kind<Tex<RGB>>::accepts;
  static std::string text(const std::optional<Tex<RGB>>& v) { return v ? Kind<Tex<RGB>>::text(*v) : std::string(); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, std::optional<Tex<RGB>>& out) {
    // As above.
    const RGB none(-std::numeric_limits<float>::infinity());
    Tex<RGB> v(none);
    if (!Kind<Tex<RGB>>::read(p, ctx, range, v)) return false;
    if (!v.is_constant() || v.value() != none) out = v;
    return true;
  }
};

/// Lists of numbers, `Each` per element.
template <class L, ParamType Type, size_t Each>
struct ListKind {
  static constexpr ParamType accepts[] = {Type};
  static std::string text(const L&) { return {}; }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, L& out) {
    if constexpr (Type == ParamType::Integer) return read_list(p, ctx, range, p.integers(), Each, out);
    else return read_list(p, ctx, range, p.numbers(), Each, out);
  }
};
template <>
struct Kind<FloatList> : ListKind<FloatList, ParamType::Float, 1> {};
template <>
struct Kind<IntegerList> : ListKind<IntegerList, ParamType::Integer, 1> {};
template <>
struct Kind<Point2List> : ListKind<Point2List, ParamType::Point2, 2> {};
template <>
struct Kind<Point3List> : ListKind<Point3List, ParamType::Point3, 3> {};
template <>
struct Kind<Vector3List> : ListKind<Vector3List, ParamType::Vector3, 3> {};
template <>
struct Kind<StringList> {
  static constexpr ParamType accepts[] = {ParamType::String};
  static std::string text(const StringList&) { return {}; }
  static bool read(const Parameter& p, const BindContext&, const Range&, StringList& out) {
    out.values = p.strings(), out.where = p.values_at, out.given = true;
    return true;
  }
};
template <>
struct Kind<NormalList> : ListKind<NormalList, ParamType::Normal3, 3> {};

}  // namespace

namespace detail {

template <class T>
std::vector<ParamType> Binding<T>::accepts() {
  return {std::begin(Kind<T>::accepts), std::end(Kind<T>::accepts)};
}
template <class T>
std::string Binding<T>::to_text(const T& value) {
  return Kind<T>::text(value);
}
template <class T>
bool Binding<T>::read(const Parameter& p, const BindContext& ctx, const Range& range, T& out) {
  return Kind<T>::read(p, ctx, range, out);
}

template struct Binding<float>;
template struct Binding<std::optional<float>>;
template struct Binding<int>;
template struct Binding<bool>;
template struct Binding<std::optional<bool>>;
template struct Binding<std::string>;
template struct Binding<FileName>;
template struct Binding<RGB>;
template struct Binding<Point>;
template struct Binding<Vector>;
template struct Binding<Tex<float>>;
template struct Binding<Tex<RGB>>;
template struct Binding<std::optional<Tex<float>>>;
template struct Binding<std::optional<Tex<RGB>>>;
template struct Binding<std::shared_ptr<Material>>;
template struct Binding<FloatList>;
template struct Binding<IntegerList>;
template struct Binding<Point2List>;
template struct Binding<Point3List>;
template struct Binding<Vector3List>;
template struct Binding<NormalList>;
template struct Binding<StringList>;

bool read_choice(const Parameter& p, const BindContext& ctx, const std::vector<std::string>& choices, Choice& out) {
  const auto& v = p.strings();
  if (const Count count = count_values(p, ctx, v.size()); count != Count::One) return count == Count::Several;
  std::string list;
  for (size_t i = 0; i < choices.size(); ++i) {
    if (v[0] == choices[i]) {
      out.index = static_cast<int>(i);
      return true;
    }
    list += (i > 0 ? ", \"" : "\"") + choices[i] + '"';
  }
  Remedy remedy = suggestion(v[0], choices);
  if (!remedy.text.empty()) remedy.text += ' ';
  remedy.text += '"' + choices[static_cast<size_t>(out.index)] + "\" is used";
  ctx.diagnostics->warning(ctx.at(p), called(p, ctx) + " is \"" + v[0] + "\", not one of " + list, remedy);
  return true;
}

}  // namespace detail

}  // namespace whit
