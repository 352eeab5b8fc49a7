// Which numbers belong to which use.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/gltf/check_parts.h"

namespace whit::gltf {
namespace {

using Kinds = std::vector<Wanted::Kind>;

const Kinds kFloat{{Component::Float, false}};
const Kinds kUnsignedFractions{{Component::Float, false}, {Component::Uint8, true}, {Component::Uint16, true}};
const Kinds kFractions{{Component::Float, false},
                       {Component::Int8, true},
                       {Component::Uint8, true},
                       {Component::Int16, true},
                       {Component::Uint16, true}};
const Kinds kSignedFractions{{Component::Int8, true}, {Component::Int16, true}};
const Kinds kSmallIntegers{{Component::Int8, false},   {Component::Int8, true},   {Component::Uint8, false},
                           {Component::Uint8, true},   {Component::Int16, false}, {Component::Int16, true},
                           {Component::Uint16, false}, {Component::Uint16, true}};

bool is_among(const Accessor& a, const Kinds& kinds) {
  return std::any_of(kinds.begin(), kinds.end(),
                     [&](const Wanted::Kind& k) { return k.component == a.component && k.normalized == a.normalized; });
}

std::string name_of(const Accessor& a) {
  static constexpr const char* kComponents[] = {"BYTE",           "UNSIGNED_BYTE", "SHORT",
                                                "UNSIGNED_SHORT", "UNSIGNED_INT",  "FLOAT"};
  const std::string type = a.columns > 1 ? fmt::format("MAT{}", a.rows)
                           : a.rows > 1  ? fmt::format("VEC{}", a.rows)
                                         : "SCALAR";
  return fmt::format("{} of {}{}", type, a.normalized ? "normalized " : "",
                     kComponents[static_cast<size_t>(a.component)]);
}

}  // namespace

const Wanted& floats_of(int rows, int columns) {
  static const std::map<std::pair<int, int>, Wanted> kAll{{{1, 1}, {1, 1, kFloat, {}, "a SCALAR of FLOAT"}},
                                                          {{3, 1}, {3, 1, kFloat, {}, "a VEC3 of FLOAT"}},
                                                          {{4, 1}, {4, 1, kFloat, {}, "a VEC4 of FLOAT"}},
                                                          {{4, 4}, {4, 4, kFloat, {}, "a MAT4 of FLOAT"}}};
  return kAll.at({rows, columns});
}

const Wanted& fractions_of(int rows) {
  static const Wanted kScalars{1, 1, kFractions, {}, "a SCALAR of FLOAT or normalized integers"};
  static const Wanted kQuaternions{4, 1, kFractions, {}, "a VEC4 of FLOAT or normalized integers"};
  return rows == 1 ? kScalars : kQuaternions;
}

const Wanted& wanted_of_indices() {
  static const Wanted kIndices{1,
                               1,
                               {{Component::Uint8, false}, {Component::Uint16, false}, {Component::Uint32, false}},
                               {},
                               "a SCALAR of UNSIGNED_BYTE, _SHORT or _INT"};
  return kIndices;
}

const Wanted* wanted_of(const std::string& attribute, bool morph_target) {
  static const Wanted kPosition{3, 1, kFloat, kSmallIntegers, "a VEC3 of FLOAT"};
  static const Wanted kNormal{3, 1, kFloat, kSignedFractions, "a VEC3 of FLOAT"};
  static const Wanted kTangent{4, 1, kFloat, kSignedFractions, "a VEC4 of FLOAT"};
  static const Wanted kUv{2, 1, kUnsignedFractions, kSmallIntegers,
                          "a VEC2 of FLOAT or normalized UNSIGNED_BYTE or _SHORT"};
  // Of three or of four numbers.
  static const Wanted kColor{
      0, 1, kUnsignedFractions, {}, "a VEC3 or VEC4 of FLOAT or normalized UNSIGNED_BYTE or _SHORT"};
  static const Wanted kJoints{
      4, 1, {{Component::Uint8, false}, {Component::Uint16, false}}, {}, "a VEC4 of UNSIGNED_BYTE or _SHORT"};
  static const Wanted kWeights{4, 1, kUnsignedFractions, {}, "a VEC4 of FLOAT or normalized UNSIGNED_BYTE or _SHORT"};
  if (attribute == "POSITION") return &kPosition;
  if (attribute == "NORMAL" || (morph_target && attribute == "TANGENT")) return &kNormal;
  if (attribute == "TANGENT") return &kTangent;
  const std::string set = attribute.substr(0, attribute.find('_'));
  // Targets may move coordinates and colours with numbers of other kinds, which are not read.
  if (morph_target || attribute.empty() || attribute.front() == '_') return nullptr;
  return set == "TEXCOORD"  ? &kUv
         : set == "COLOR"   ? &kColor
         : set == "JOINTS"  ? &kJoints
         : set == "WEIGHTS" ? &kWeights
                            : nullptr;
}

int check_accessor(const CheckContext& c, const Item& member, const Wanted& wanted) {
  const int accessor = member.as_index(c.counts.accessors);
  if (accessor < 0) return -1;
  const Accessor& a = c.buffers.accessors[static_cast<size_t>(accessor)];
  // What is wrong with it has been said.
  if (a.count == 0) return -1;
  const bool shape = wanted.rows == 0 ? a.columns == 1 && (a.rows == 3 || a.rows == 4)
                                      : a.rows == wanted.rows && a.columns == wanted.columns;
  if (shape && is_among(a, wanted.kinds)) return accessor;
  if (shape && is_among(a, wanted.quantized_kinds)) {
    if (c.quantized) return accessor;
    member.error(fmt::format("names accessor {}, a {}, which needs KHR_mesh_quantization under extensionsUsed",
                             accessor, name_of(a)));
    return -1;
  }
  member.error(fmt::format("must name {}, and accessor {} is a {}", wanted.words, accessor, name_of(a)));
  return -1;
}

int check_accessor(const CheckContext& c, const Item& item, const char* key, const Wanted& wanted, Item::Need need) {
  if (!item.has(key)) {
    if (need == Item::Need::Required) item.error_at(key, "is missing");
    return -1;
  }
  return check_accessor(c, Item(item, key, item.value()[key]), wanted);
}

}  // namespace whit::gltf
