// Which AOVs a render makes, and where each has its values while it does.
#pragma once

#include <string>
#include <vector>

#include "core/render/aovs.h"

namespace whit {

/// What somebody asks for.
struct AovRequest {
  std::vector<std::string> names;  ///< All known: see unknown_aov().
  StatementPlace place;            ///< For the tables of names.
};

/// A row of the table that is asked for.
struct AovLayer {
  const AovRow* row;
  std::vector<std::string> channels;  ///< In the file.
  int column = -1;                    ///< The first of as many arrays of every chunk of samples; -1 for statistics.
};

struct AovPlan {
  /// Without names nothing is planned.
  AovPlan(const Scene& scene, const AovRequest& request);
  bool any() const { return !layers.empty(); }
  bool sums() const { return means > 0 || !mattes.empty(); }              ///< Something is added up over filters.
  bool nearest() const { return columns.size() > means; }                 ///< Something is a single sample's.
  bool watches() const { return surfaces || parts || first_group >= 0; }  ///< Values come from the way of the light.

  std::vector<AovLayer> layers;
  std::vector<const AovRow*> columns;  ///< The row of each array: those of means first,
  size_t means = 0;                    ///< which are so many; of the others a pixel has the nearest sample's.
  std::vector<int> mattes;             ///< Arrays of numbers that cryptomattes are made of.
  bool surfaces = false;               ///< Some row asks for the first surfaces.
  bool parts = false;                  ///< Some row asks how light got to the camera.
  bool statistics = false;
  bool blocks = false;  ///< Some row asks for blocks of samples.

  /// Arrays of each part of the light; -1 where nobody asks.
  int column_of_part[5] = {-1, -1, -1, -1, -1};
  std::vector<std::string> light_groups;  ///< Their names; empty when nobody asks.
  int first_group = -1;                   ///< Array of the first group; three for each.
  // The group of each light, light at infinity and shape; -1 for none.
  std::vector<int> group_of_light, group_of_environment, group_of_shape;
};

}  // namespace whit
