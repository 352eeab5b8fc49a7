#include "core/watch/state_json.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace whit {
namespace {

using Json = nlohmann::json;

Json of(const Vec3d& v) { return {v.x, v.y, v.z}; }
Json of(const Box2i& b) { return {b.min.x, b.min.y, b.max.x, b.max.y}; }
Json of(const PlaceInFile& p) {
  if (p.line == 0) return nullptr;
  return {{"file", p.file}, {"path", p.path}, {"line", p.line}, {"column", p.column}};
}

Json of(const PreviewPicture& p) {
  return {{"number", p.number},     {"reading", p.reading}, {"resolution", {p.resolution.x, p.resolution.y}},
          {"window", of(p.window)}, {"width", p.width},     {"height", p.height},
          {"samples", p.samples},   {"done", p.done}};
}

Json of(const PreviewProblem& p) {
  Json json{{"error", p.is_error}, {"message", p.message}, {"remedy", p.remedy}, {"excerpt", p.excerpt}};
  if (p.where.line > 0) json["where"] = of(p.where);
  return json;
}

Json of(const PreviewEffect& e) {
  const EffectInfo& info = effect_info(e.effect);
  return {{"name", info.name},
          {"doc", info.doc},
          {"without", info.off},
          {"off", e.off},
          {"why_off", e.why_off},
          {"causes", e.causes},
          {"cost", e.cost ? Json(*e.cost) : Json()}};
}

Json of(const PreviewCamera& c) {
  return {{"eye", of(c.pose.eye)}, {"direction", of(c.pose.direction)},
          {"up", of(c.pose.up)},   {"mirrored", c.mirrored},
          {"movable", c.movable},  {"moved", c.moved},
          {"text", c.text},        {"refusal", c.refusal},
          {"where", of(c.where)}};
}

/// Names of files need not be UTF-8.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::optional<Vec3d> vector_of(const Json& json, const char* name) {
  const auto list = json.find(name);
  if (list == json.end() || !list->is_array() || list->size() != 3) return std::nullopt;
  Vec3d v;
  for (size_t i = 0; i < 3; ++i) {
    if (!(*list)[i].is_number()) return std::nullopt;
    v[static_cast<int>(i)] = (*list)[i].get<double>();
    if (!std::isfinite(v[static_cast<int>(i)])) return std::nullopt;
  }
  return v;
}

bool is_length(double v) { return v > 0 && std::isfinite(v); }

}  // namespace

std::string state_json(const std::string& scene, const PreviewState& s, const WatchExtras& extras) {
  Json json{{"version", s.version},
            {"scene", scene},
            {"reading", s.reading},
            {"phase", phase_name(s.phase)},
            {"samples", s.samples},
            {"samples_wanted", s.samples_wanted},
            {"render_seconds", s.render_seconds},
            {"first_seconds", s.first_seconds},
            {"read_seconds", s.read_seconds},
            {"build_seconds", s.build_seconds},
            {"stale", s.stale},
            {"integrator", s.integrator},
            {"triangles", s.triangles},
            {"lights", s.lights},
            {"worlds", s.worlds},
            {"file_count", s.files},
            {"camera", of(s.camera)},
            {"problems_left_out", s.problems_left_out},
            {"views", extras.views}};
  json["picture"] = s.picture ? of(*s.picture) : Json();
  json["problems"] = Json::array();
  for (const PreviewProblem& p : s.problems) json["problems"].push_back(of(p));
  json["effects"] = Json::array();
  for (const PreviewEffect& e : s.effects) json["effects"].push_back(of(e));
  json["reference"] = Json();
  if (!extras.reference.empty()) {
    json["reference"] = {{"name", extras.reference},
                         {"problem", extras.reference_problem},
                         {"number", extras.reference_number},
                         {"width", extras.reference_width},
                         {"height", extras.reference_height}};
  }
  return text_of(json);
}

std::string spot_json(const PreviewSpot& s) {
  Json json{{"known", s.known}, {"busy", s.busy}, {"hit", s.hit}};
  if (s.hit) {
    json.update({{"depth", s.depth},
                 {"distance", s.distance},
                 {"point", of(s.point)},
                 {"shape", s.shape},
                 {"material", s.material},
                 {"material_kind", s.material_kind},
                 {"object", s.object},
                 {"shape_at", of(s.shape_at)},
                 {"material_at", of(s.material_at)}});
  }
  return text_of(json);
}

std::string problem_json(const std::string& problem) { return text_of({{"problem", problem}}); }

std::optional<CameraWish> camera_wish(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  if (json.value("reset", Json()) == Json(true)) return CameraWish{};
  const auto eye = vector_of(json, "eye"), direction = vector_of(json, "direction"), up = vector_of(json, "up");
  if (!eye || !direction || !up || !is_length(direction->length()) || !is_length(up->length())) return std::nullopt;
  const CameraPose pose{*eye, direction->normalized(), up->normalized()};
  // Beyond that squares of distances are not finite in single precision; and what is up must be seen from the side.
  constexpr double kFarthest = 1e15, kSide = 1e-6;
  if (!(eye->length() <= kFarthest) || !(pose.direction.cross(pose.up).length() > kSide)) return std::nullopt;
  return CameraWish{pose};
}

std::optional<EffectSet> effects_wish(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  const auto off = json.is_object() ? json.find("off") : json.end();
  if (!json.is_object() || off == json.end() || !off->is_array()) return std::nullopt;
  EffectSet set;
  for (const Json& name : *off) {
    std::string unknown;
    if (!name.is_string()) return std::nullopt;
    const EffectSet one = parse_effects(name.get<std::string>(), unknown);
    if (!unknown.empty()) return std::nullopt;
    set |= one;
  }
  return set;
}

}  // namespace whit
