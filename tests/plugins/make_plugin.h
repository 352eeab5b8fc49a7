// Making plugins in tests as the builder does: from the registry, with parameters bound and checked.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/plugin/registry.h"

namespace whit::test {

template <class Values>
Parameter parameter(ParamType type, const char* name, Values values) {
  Parameter p;
  p.type = type, p.name = name, p.values = std::move(values);
  return p;
}
inline Parameter floats(const char* name, std::vector<double> v) { return parameter(ParamType::Float, name, v); }
inline Parameter integer(const char* name, int32_t v) {
  return parameter(ParamType::Integer, name, std::vector<int32_t>{v});
}
inline Parameter boolean(const char* name, bool v) {
  return parameter(ParamType::Bool, name, std::vector<uint8_t>{static_cast<uint8_t>(v)});
}
inline Parameter text(const char* name, const std::string& v) {
  return parameter(ParamType::String, name, std::vector<std::string>{v});
}
inline Parameter rgb(const char* name, double r, double g, double b) {
  return parameter(ParamType::Rgb, name, std::vector<double>{r, g, b});
}
inline Parameter point(const char* name, double x, double y, double z) {
  return parameter(ParamType::Point3, name, std::vector<double>{x, y, z});
}

/// A plugin of class T with what it was made from and what was said about it.
template <class T>
struct Made {
  std::unique_ptr<ParameterList> parameters;  ///< Lists of the plugin point into it.
  std::unique_ptr<T> plugin;
  Diagnostics diagnostics;
  T* operator->() const { return plugin.get(); }
  bool good() const { return plugin && !diagnostics.has_errors(); }
  bool silent() const { return plugin && diagnostics.all().empty(); }
  bool prepare(PrepareContext ctx = {}) {
    ctx.diagnostics = &diagnostics;
    plugin = prepared(after_reading(std::move(plugin), diagnostics, SourcePos()), ctx);
    return plugin != nullptr;
  }
};

/// Binds and checks; prepare() is left to the test.
template <class T>
Made<T> make_plugin(const char* category, const char* name, ParameterList parameters = {}) {
  Made<T> made;
  made.parameters = std::make_unique<ParameterList>(std::move(parameters));
  const PluginInfo* info = find_plugin(category, name);
  if (!info) return made;
  made.plugin.reset(dynamic_cast<T*>(info->make().release()));
  BindContext ctx;
  ctx.diagnostics = &made.diagnostics, ctx.statement_name = name;
  if (bind_parameters(*info, *made.plugin, *made.parameters, ctx)) made.plugin->check(made.diagnostics, {});
  return made;
}

/// Three arrays that Vec3Lanes or RGBLanes can show.
struct Triples {
  explicit Triples(int n) : x(n), y(n), z(n) {}
  Vec3Lanes vec3() { return {x.data(), y.data(), z.data()}; }
  RGBLanes rgb() { return {x.data(), y.data(), z.data()}; }
  Vec3f operator[](int i) const { return {x[i], y[i], z[i]}; }
  bool operator==(const Triples&) const = default;
  std::vector<float> x, y, z;
};

}  // namespace whit::test
