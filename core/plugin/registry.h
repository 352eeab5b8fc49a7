// The registry of plugins: filled by one static Register<> object at the end of every plugin file.
#pragma once

#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "core/plugin/param.h"
#include "core/plugin/plugin.h"

namespace whit {

/// Everything known about a plugin: what help, docs, binding and checks read.
struct PluginInfo {
  std::string category;  ///< The kCategory of its base: "shape", "float texture", "area light", ...
  std::string name;
  std::vector<std::string> aliases;
  std::string doc;
  std::vector<ParamSpec> params;
  std::unique_ptr<Plugin> (*make)() = nullptr;  ///< A new plugin, every parameter at its default.

  const ParamSpec* find_param(const std::string& param_name) const;
};

/// The plugin of a category by name or alias, or null.
const PluginInfo* find_plugin(const std::string& category, const std::string& name);
/// All plugins of a category, sorted by name; of every category when it is "".
std::vector<const PluginInfo*> list_plugins(const std::string& category = "");
/// The names (no aliases) of a category, sorted.
std::vector<std::string> plugin_names(const std::string& category);
/// Binds the parameters of a statement: every given parameter is looked up, its type, count and range
/// checked, and stored. Unknown names and parameters of the wrong type warn with a did-you-mean, unless
/// `also_known` (another plugin that shares the parameter list, as a shape's material does) has them.
/// Errors and warnings go to ctx.diagnostics. Returns false when there was an error.
bool bind_parameters(const PluginInfo& info, Plugin& plugin, const ParameterList& params, const BindContext& ctx,
                     const std::vector<const PluginInfo*>& also_known = {});

namespace detail {

/// Adds a plugin; a second one of the same category and name ends the program. Only Register does, which knows that
/// what make() makes is of that category.
void add_plugin(PluginInfo info);

/// Whether class T may have a parameter of type V: a material alone may be made of materials.
template <class T, class V>
inline constexpr bool kMayHave = !std::is_same_v<V, std::shared_ptr<Material>> || std::is_base_of_v<Material, T>;

}  // namespace detail

/// Registers plugin class T from a static object, in the category of T's base:
///   const Register<Matte> matte{"matte", "Lambertian ...", param(...), param(...)};
template <class T>
class Register {
 public:
  template <class... D, class... V>
  Register(const char* name, const char* doc, DeclaredParam<D, V>... declared) {
    add({}, name, doc, declared...);
  }
  /// With further names under which scene files know the plugin.
  template <class... D, class... V>
  Register(std::vector<std::string> aliases, const char* name, const char* doc, DeclaredParam<D, V>... declared) {
    add(std::move(aliases), name, doc, declared...);
  }

 private:
  template <class... D, class... V>
  void add(std::vector<std::string> aliases, const char* name, const char* doc,
           const DeclaredParam<D, V>&... declared) {
    static_assert((detail::kMayHave<T, V> && ...), "only a material has materials as parameters");
    PluginInfo info;
    info.category = T::kCategory, info.name = name, info.aliases = std::move(aliases), info.doc = doc;
    (info.params.push_back(declared.spec), ...);
    static const std::tuple<DeclaredParam<D, V>...> defaults{declared...};
    info.make = +[]() -> std::unique_ptr<Plugin> {
      auto plugin = std::make_unique<T>();
      std::apply([&](const auto&... d) { ((plugin.get()->*(d.member) = d.default_value), ...); }, defaults);
      return plugin;
    };
    detail::add_plugin(std::move(info));
  }
};

}  // namespace whit
