#include "core/render/aov_plan.h"

#include <algorithm>

namespace whit {
namespace {

/// Names of groups as numbers, in the order of the scene's lights.
class Groups {
 public:
  explicit Groups(std::vector<std::string>& names) : names_(names) {}
  int of(const std::string& name) {
    if (name.empty()) return -1;
    const auto number = std::find(names_.begin(), names_.end(), name) - names_.begin();
    if (static_cast<size_t>(number) == names_.size()) names_.push_back(name);
    return static_cast<int>(number);
  }

 private:
  std::vector<std::string>& names_;
};

void find_light_groups(const Scene& scene, AovPlan& plan) {
  Groups groups(plan.light_groups);
  for (const SceneLight& l : scene.lights) plan.group_of_light.push_back(groups.of(l.light->light_group()));
  for (const SceneEnvironment& e : scene.environments)
    plan.group_of_environment.push_back(groups.of(e.light->light_group()));
  for (const SceneShape& s : scene.shapes) {
    const bool emits = s.emitter >= 0;
    plan.group_of_shape.push_back(emits ? groups.of(scene.emitters[static_cast<size_t>(s.emitter)]->light_group())
                                        : -1);
  }
}

std::vector<std::string> channels_by_group(const AovRow& row, const std::vector<std::string>& groups) {
  std::vector<std::string> channels;
  for (const std::string& group : groups) {
    for (const std::string& channel : row.channels) channels.push_back("lightgroup." + group + channel);
  }
  return channels;
}

/// Gives the layers arrays, those of which pixels are means first.
void place_columns(AovPlan& plan) {
  for (const bool nearest : {false, true}) {
    for (AovLayer& layer : plan.layers) {
      const AovPixel pixel = layer.row->pixel;
      if (pixel == AovPixel::Statistic || (pixel == AovPixel::Nearest) != nearest) continue;
      layer.column = static_cast<int>(plan.columns.size());
      plan.columns.insert(plan.columns.end(), layer.channels.size(), layer.row);
    }
    if (!nearest) plan.means = plan.columns.size();
  }
}

}  // namespace

AovPlan::AovPlan(const Scene& scene, const AovRequest& request) {
  for (const AovRow& row : all_aovs()) {
    if (std::find(request.names.begin(), request.names.end(), row.name) == request.names.end()) continue;
    AovLayer layer{&row, row.channels};
    if (row.by_light_group) {
      find_light_groups(scene, *this);
      layer.channels = channels_by_group(row, light_groups);
    }
    layers.push_back(std::move(layer));
  }
  place_columns(*this);
  for (const AovLayer& layer : layers) {
    const AovRow& row = *layer.row;
    surfaces |= row.surface != nullptr;
    parts |= row.part.has_value();
    statistics |= row.pixel == AovPixel::Statistic;
    blocks |= row.blocks;
    if (row.matte) mattes.push_back(layer.column);
    if (row.part) column_of_part[static_cast<size_t>(*row.part)] = layer.column;
    if (row.by_light_group) first_group = layer.column;
  }
}

}  // namespace whit
