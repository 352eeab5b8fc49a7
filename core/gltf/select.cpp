#include "core/gltf/select.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace whit::gltf {
namespace {

/// The first thing of that name, or else of that number.
template <class T>
int index_of(const std::vector<T>& things, const std::string& wanted) {
  const auto name_of = [](const T& thing) -> const std::string& {
    if constexpr (std::is_same_v<T, std::string>) return thing;
    else return thing.name;
  };
  const auto found = std::find_if(things.begin(), things.end(), [&](const T& t) { return name_of(t) == wanted; });
  if (found != things.end()) return static_cast<int>(found - things.begin());
  int number = -1;
  const char* const end = wanted.data() + wanted.size();
  const auto [rest, error] = std::from_chars(wanted.data(), end, number);
  const bool good = error == std::errc() && rest == end && number >= 0 && static_cast<size_t>(number) < things.size();
  return good ? number : -1;
}

/// "there are \"Day\", \"Night\""
template <class T>
std::string what_there_is(const std::vector<T>& things) {
  if (things.empty()) return "it has none";
  constexpr size_t kNamed = 12;
  std::string out = things.size() == 1 ? "there is" : "there are";
  for (size_t i = 0; i < std::min(things.size(), kNamed); ++i) {
    std::string name;
    if constexpr (std::is_same_v<T, std::string>) name = things[i];
    else name = things[i].name;
    out += fmt::format("{} {}", i == 0 ? "" : ",", name.empty() ? fmt::format("{}", i) : '"' + name + '"');
  }
  if (things.size() > kNamed) out += fmt::format(" and {} more", things.size() - kNamed);
  return out;
}

template <class T>
bool exists(const Model& model, const std::vector<T>& things, const char* kind, const std::string& wanted,
            SourcePos where, Diagnostics& diagnostics) {
  if (wanted.empty() || index_of(things, wanted) >= 0) return true;
  diagnostics.add({Severity::Error, where.known() ? ErrorClass::Scene : ErrorClass::Usage, where,
                   fmt::format("{} has no {} \"{}\"", model.path, kind, wanted), what_there_is(things)});
  return false;
}

/// Those of the scene that is wanted, the file's own, its first, or else all that have no parent.
std::vector<int> scene_roots(const Model& model, const std::string& wanted) {
  const int scene = wanted.empty() ? (model.default_scene >= 0 || model.scenes.empty() ? model.default_scene : 0)
                                   : index_of(model.scenes, wanted);
  if (scene >= 0) return model.scenes[static_cast<size_t>(scene)].nodes;
  std::vector<int> roots;
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    if (model.nodes[i].parent < 0) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

}  // namespace

int variant_index(const Model& model, const std::string& wanted) { return index_of(model.variants, wanted); }
int camera_index(const Model& model, const std::string& wanted) { return index_of(model.cameras, wanted); }

bool select_roots(const Model& model, const Selection& selection, std::vector<int>& roots, SourcePos where,
                  Diagnostics& diagnostics) {
  bool good = exists(model, model.scenes, "scene", selection.scene, where, diagnostics);
  good &= exists(model, model.nodes, "node", selection.node, where, diagnostics);
  good &= exists(model, model.variants, "variant", selection.variant, where, diagnostics);
  if (!good) return false;
  if (selection.node.empty()) roots = scene_roots(model, selection.scene);
  else roots = {index_of(model.nodes, selection.node)};
  return true;
}

std::vector<int> nodes_below(const Model& model, const std::vector<int>& roots) {
  std::vector<int> out, open(roots.rbegin(), roots.rend());
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    out.push_back(node);
    const std::vector<int>& children = model.nodes[static_cast<size_t>(node)].children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return out;
}

}  // namespace whit::gltf
