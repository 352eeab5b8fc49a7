#include "core/plugin/registry.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace whit {

namespace {

using Plugins = std::map<std::pair<std::string, std::string>, PluginInfo>;  // by category and name

/// A function's static, because the plugins' static initialisers run in no particular order.
Plugins& plugins() {
  static Plugins all;
  return all;
}

/// "rgb, xyz or spectrum".
std::string join_types(const std::vector<ParamType>& types) {
  std::string text;
  for (size_t i = 0; i < types.size(); ++i) {
    if (i > 0) text += i + 1 == types.size() ? " or " : ", ";
    text += param_type_name(types[i]);
  }
  return text;
}

bool accepts(const ParamSpec& spec, ParamType type) {
  return std::find(spec.accepts.begin(), spec.accepts.end(), type) != spec.accepts.end();
}

bool known_elsewhere(const Parameter& p, const std::vector<const PluginInfo*>& also_known, bool any_type) {
  return std::any_of(also_known.begin(), also_known.end(), [&](const PluginInfo* info) {
    const ParamSpec* spec = info ? info->find_param(p.name) : nullptr;
    return spec && (any_type || accepts(*spec, p.type));
  });
}

/// Whether a plugin of a category has a parameter of a name: it is then no slip in the statement of another.
bool category_has(const std::string& category, const std::string& name) {
  const auto all = list_plugins(category);
  return std::any_of(all.begin(), all.end(), [&](const PluginInfo* i) { return i->find_param(name) != nullptr; });
}

/// Whether another parameter of a statement has a name already, or would have it corrected.
bool has_another(const ParameterList& params, const Parameter& p, const std::string& meant,
                 const std::vector<std::string>& names) {
  return std::any_of(params.begin(), params.end(), [&](const Parameter& other) {
    if (&other == &p) return false;
    const bool known = std::find(names.begin(), names.end(), other.name) != names.end();
    return (known ? other.name : nearest_name(other.name, names)) == meant;
  });
}

void warn_unknown(const PluginInfo& info, const Parameter& p, const BindContext& ctx,
                  const std::vector<const PluginInfo*>& also_known, const ParameterList& params) {
  std::vector<std::string> names;
  const auto add_names = [&](const PluginInfo* plugin) {
    for (const ParamSpec& spec : plugin->params) names.push_back(spec.name);
  };
  add_names(&info);
  for (const PluginInfo* other : also_known)
    if (other) add_names(other);
  Remedy hint = suggestion(p.name, names);
  bool elsewhere = category_has(info.category, p.name);
  for (const PluginInfo* other : also_known) elsewhere = elsewhere || (other && category_has(other->category, p.name));
  if (hint.slip.known() && (elsewhere || has_another(params, p, hint.slip.meant, names))) hint.slip = {};
  ctx.diagnostics->warning(p.where, info.name + " has no parameter \"" + p.name + '"',
                           !hint.text.empty() ? hint : "it is ignored", "unknown-parameter");
}

void warn_wrong_type(const PluginInfo& info, const ParamSpec& spec, const Parameter& p, const BindContext& ctx) {
  const std::string used =
      spec.default_text.empty() ? "it is ignored" : "the default " + spec.default_text + " is used";
  ctx.diagnostics->warning(p.where,
                           std::string("parameter \"") + p.name + "\" of " + info.name + " is of type " +
                               join_types(spec.accepts) + ", not " + param_type_name(p.type),
                           used, "wrong-type");
}

void warn_empty(const PluginInfo& info, const Parameter& p, const BindContext& ctx) {
  ctx.diagnostics->warning(p.values_at, "parameter \"" + p.name + "\" of " + info.name + " has an empty list of values",
                           "the parameter is ignored");
}

/// Binds one parameter, or says why not. False after an error.
bool bind_parameter(const PluginInfo& info, Plugin& plugin, const Parameter& p, const BindContext& ctx,
                    const std::vector<const PluginInfo*>& also_known, const ParameterList& params) {
  const ParamSpec* spec = info.find_param(p.name);
  if (spec && accepts(*spec, p.type) && p.is_empty()) {
    if (!spec->is_list) warn_empty(info, p, ctx);  // A list of nothing is as good as none.
    return true;
  }
  if (spec && accepts(*spec, p.type)) return spec->bind(plugin, p, ctx);
  if (known_elsewhere(p, also_known, /*any_type=*/!spec)) return true;
  if (spec) warn_wrong_type(info, *spec, p, ctx);
  else warn_unknown(info, p, ctx, also_known, params);
  return true;
}

}  // namespace

const ParamSpec* PluginInfo::find_param(const std::string& param_name) const {
  const auto it = std::find_if(params.begin(), params.end(), [&](const ParamSpec& s) { return s.name == param_name; });
  return it == params.end() ? nullptr : &*it;
}

const PluginInfo* find_plugin(const std::string& category, const std::string& name) {
  if (const auto it = plugins().find({category, name}); it != plugins().end()) return &it->second;
  for (const auto& [key, info] : plugins()) {
    if (key.first != category) continue;
    if (std::find(info.aliases.begin(), info.aliases.end(), name) != info.aliases.end()) return &info;
  }
  return nullptr;
}

std::vector<const PluginInfo*> list_plugins(const std::string& category) {
  std::vector<const PluginInfo*> out;
  for (const auto& [key, info] : plugins())
    if (category.empty() || key.first == category) out.push_back(&info);
  return out;
}

std::vector<std::string> plugin_names(const std::string& category) {
  std::vector<std::string> out;
  for (const PluginInfo* info : list_plugins(category)) out.push_back(info->name);
  return out;
}

void detail::add_plugin(PluginInfo info) {
  std::vector<std::string> names = info.aliases;
  names.push_back(info.name);
  for (const std::string& name : names) {
    // A mistake of the programmer's, caught before main(): the uncaught exception ends the program and names
    // it.
    if (find_plugin(info.category, name))
      throw std::logic_error("two plugins are " + info.category + " \"" + name + '"');
  }
  const auto key = std::make_pair(info.category, info.name);
  plugins().emplace(key, std::move(info));
}

bool bind_parameters(const PluginInfo& info, Plugin& plugin, const ParameterList& params, const BindContext& ctx,
                     const std::vector<const PluginInfo*>& also_known) {
  bool ok = true;
  // Values first, so that a texture wins over a value of the same name, as in pbrt, wherever it stands.
  for (const bool textures : {false, true}) {
    for (const Parameter& p : params) {
      if ((p.type == ParamType::Texture) == textures)
        ok = bind_parameter(info, plugin, p, ctx, also_known, params) && ok;
    }
  }
  return ok;
}

}  // namespace whit
