#include "core/compare/comparison_json.h"

#include <algorithm>
#include <cmath>

#include "core/compare/measures.h"

namespace whit {
namespace {

void add_place(const std::optional<Vec2i>& at, const std::string& channel, Json::Object& to) {
  if (at) to.insert(to.end(), {{"x", at->x}, {"y", at->y}});
  if (!channel.empty()) to.emplace_back("channel", channel);
}

Json::Array failures(const Comparison& c) {
  Json::Array all;
  for (const Failure& f : c.failed) {
    Json::Object one{{"measure", f.measure}, {"value", f.value}, {"limit", f.limit}};
    add_place(f.at, f.channel, one);
    if (!f.layer.empty()) one.emplace_back("layer", f.layer);
    if (!f.words.empty()) one.emplace_back("words", f.words);
    all.emplace_back(std::move(one));
  }
  return all;
}

Json::Object measures_of(const Comparison& c, const std::string& layer) {
  Json::Object all;
  for (const Measured& m : c.measured)
    if (m.layer == layer) all.emplace_back(m.measure, m.value);
  return all;
}

// Of the picture itself, or of the first layer where there are only others.
std::string main_layer(const Comparison& c) {
  const bool plain = std::find(c.layers.begin(), c.layers.end(), "") != c.layers.end();
  return plain || c.layers.empty() ? "" : c.layers.front();
}

Json::Object places(const Comparison& c, const std::string& layer) {
  Json::Object all;
  for (const Measured& m : c.measured) {
    if (m.layer != layer) continue;
    Json::Object one;
    add_place(m.at, m.channel, one);
    if (!m.words.empty()) one.emplace_back("words", m.words);
    if (!one.empty()) all.emplace_back(m.measure, std::move(one));
  }
  return all;
}

Json::Object layers(const Comparison& c) {
  Json::Object all;
  for (const std::string& layer : c.layers)
    if (layer != main_layer(c)) all.emplace_back(layer, measures_of(c, layer));
  return all;
}

Json::Array nonfinite(const Comparison& c) {
  Json::Array all;
  for (const NonFinite& n : c.nonfinite) {
    const std::string value = n.value > 0 ? "inf" : n.value < 0 ? "-inf" : "nan";
    all.emplace_back(Json::Object{{"file", n.side == Side::A ? c.a_path : c.b_path},
                                  {"channel", n.channel},
                                  {"x", n.at.x},
                                  {"y", n.at.y},
                                  {"value", value}});
  }
  return all;
}

Json noise(const Comparison& c) {
  if (!c.noise) return {};
  Json::Array regions;
  for (const NoiseRegion& r : c.noise->regions)
    regions.emplace_back(Json::Object{{"x0", r.box.min.x},
                                      {"y0", r.box.min.y},
                                      {"x1", r.box.max.x + 1},
                                      {"y1", r.box.max.y + 1},
                                      {"change", r.change},
                                      {"channel", r.channel},
                                      {"p", r.p},
                                      {"objects", r.objects}});
  return Json::Object{{"same", c.noise->same},           {"p", c.noise->p},
                      {"alpha", c.noise->alpha},         {"regions", std::move(regions)},
                      {"estimated", c.noise->estimated}, {"how", c.noise->how},
                      {"untested", c.noise->untested},   {"region_count", static_cast<int64_t>(c.noise->region_count)}};
}

Json::Object limits_in_force(const Limits& limits) {
  if (limits.exact) return {{"exact", true}};
  Json::Object all;
  for (const MeasureRow& row : all_measures())
    if (const auto limit = limit_of(row, limits); limit && std::isfinite(*limit)) all.emplace_back(row.name, *limit);
  if (limits.hard_fail && std::isfinite(*limits.hard_fail)) all.emplace_back("hard-fail", *limits.hard_fail);
  if (limits.fail_pixels && *limits.fail_pixels < 1)
    all.insert(all.end(), {{"fail-pixels", *limits.fail_pixels}, {"pixel-error", limits.pixel_error}});
  if (limits.noise) all.insert(all.end(), {{"noise", true}, {"alpha", limits.alpha}});
  return all;
}

// As --crop takes it.
Json::Array window(const Box2i& box) { return {box.min.x, box.max.x + 1, box.min.y, box.max.y + 1}; }

}  // namespace

Json::Object to_json(const Comparison& c, const Limits& limits) {
  Json::Object json{{"same", c.same()}, {"a", c.a_path}, {"b", c.b_path}};
  if (!c.cannot.empty()) json.emplace_back("cannot", c.cannot);
  json.insert(
      json.end(),
      {{"failed", failures(c)},
       {"measures", measures_of(c, main_layer(c))},
       {"where", places(c, main_layer(c))},
       {"layers", layers(c)},
       {"nonfinite", nonfinite(c)},
       {"nonfinite_count", c.nonfinite_count},
       {"differing_pixels", c.differing_pixels},
       {"noise", noise(c)},
       {"limits", limits_in_force(limits)},
       {"windows", Json::Object{{"a", window(c.a_window)}, {"b", window(c.b_window)}, {"compared", window(c.window)}}},
       {"notes", c.notes}});
  return json;
}

}  // namespace whit
