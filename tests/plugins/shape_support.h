// What the tests of shapes share: a shape made by name from parameters, as a scene statement would make it.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit::shape_test {

inline Parameter parameter(ParamType type, const char* name) {
  Parameter p;
  p.type = type, p.name = std::string(name);
  p.where = {0, 100}, p.values_at = {0, 200};
  return p;
}
inline Parameter numbers(ParamType type, const char* name, std::vector<double> values) {
  Parameter p = parameter(type, name);
  p.values = std::move(values);
  return p;
}
inline Parameter floats(const char* name, std::vector<double> values) {
  return numbers(ParamType::Float, name, std::move(values));
}
inline Parameter points(const char* name, std::vector<double> values) {
  return numbers(ParamType::Point3, name, std::move(values));
}
inline Parameter integers(const char* name, std::vector<int32_t> values) {
  Parameter p = parameter(ParamType::Integer, name);
  p.values = std::move(values);
  return p;
}
inline Parameter text(const char* name, const char* value) {
  Parameter p = parameter(ParamType::String, name);
  p.values = std::vector<std::string>{value};
  return p;
}

/// A bound and checked shape with what was said about it.
struct Made {
  ParameterList params;  ///< Lists of the shape point into it.
  Diagnostics diagnostics;
  std::unique_ptr<Plugin> plugin;

  Made(const char* name, ParameterList list) : params(std::move(list)) {
    const PluginInfo* info = find_plugin("shape", name);
    if (!info) throw std::runtime_error(std::string("no shape ") + name);
    plugin = info->make();
    BindContext ctx;
    ctx.diagnostics = &diagnostics;
    ctx.statement = statement();
    ctx.statement_name = std::string(name);
    ctx.folder = std::string(".");
    bind_parameters(*info, *plugin, params, ctx);
    plugin->check(diagnostics, statement());
  }
  static SourcePos statement() { return {0, 1}; }

  bool ok() const { return !diagnostics.has_errors(); }
  AnalyticShape& analytic() { return dynamic_cast<AnalyticShape&>(*plugin); }
  bool build(MeshData& out) { return dynamic_cast<MeshShape&>(*plugin).build_mesh(context(), out); }
  bool build(CurveData& out) { return dynamic_cast<CurveShape&>(*plugin).build_curves(context(), out); }
  /// Everything that was said, one line each.
  std::string said() const {
    std::string all;
    for (const auto& d : diagnostics.all()) all += d.message + " (" + d.remedy + ")\n";
    return all;
  }
  bool says(const char* what) const { return said().find(what) != std::string::npos; }

 private:
  PrepareContext context() {
    PrepareContext ctx;
    ctx.diagnostics = &diagnostics;
    ctx.statement = statement();
    return ctx;
  }
};

/// t of the nearest hit in object space, or t_max.
inline double intersect(const AnalyticShape& shape, const Vec3d& o, const Vec3d& d, double t_min = 0,
                        double t_max = 1e300) {
  double t = t_max;
  shape.intersect({1, &o.x, &o.y, &o.z, &d.x, &d.y, &d.z, &t_min, &t});
  return t;
}

/// Numbers in [0,1), the same in every run (a 64-bit linear congruence).
class Numbers {
 public:
  explicit Numbers(uint64_t seed = 1) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
  double operator()() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  double between(double a, double b) { return a + (b - a) * (*this)(); }
  Vec3d direction() {
    for (;;) {
      const Vec3d v{between(-1, 1), between(-1, 1), between(-1, 1)};
      if (v.length2() > 0.01 && v.length2() <= 1) return v.normalized();
    }
  }

 private:
  uint64_t state_;
};

}  // namespace whit::shape_test
