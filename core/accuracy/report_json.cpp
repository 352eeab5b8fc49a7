// The report for machines.
#include <nlohmann/json.hpp>

#include "core/accuracy/report.h"

namespace whit {
namespace {

using Json = nlohmann::ordered_json;

// Numbers that are not finite are written as null.
Json interval(const char* middle, const Estimate& e) { return {{middle, e.value}, {"low", e.low}, {"high", e.high}}; }

Json range(const Estimate& e) { return {{"low", e.low}, {"high", e.high}}; }

Json difference(const Estimate& e, bool resolved) {
  Json json = interval("value", e);
  json["resolved"] = resolved;
  return json;
}

Json change_json(const CostChange& c) {
  return {{"from", c.from},
          {"seconds", difference(c.seconds, c.resolved)},
          {"share", c.share},
          {"noise", c.noise ? interval("value", *c.noise) : Json()},
          {"mean_change", c.mean_change},
          {"pixels_changed", c.pixels_changed}};
}

Json setting_json(const CostSetting& s) {
  Json nrmse = interval("value", s.nrmse);
  nrmse["upper95"] = s.upper95;
  return {{"knob", s.knob},
          {"value", s.value},
          {"samples", s.samples},
          {"command", s.command},
          {"seconds", interval("median", s.seconds)},
          {"cpu_seconds", interval("median", s.cpu_seconds)},
          {"nrmse", nrmse},
          {"bias", s.bias ? interval("value", *s.bias) : Json()},
          {"change", s.change ? change_json(*s.change) : Json()},
          {"relmse", s.relmse},
          {"flip", s.flip},
          {"share_2_255", s.share_2_255},
          {"pareto", s.pareto}};
}

Json effect_json(const CostEffect& e) {
  return {{"name", e.name},
          {"command", e.command},
          {"samples", e.samples},
          {"seconds", difference(e.seconds, e.resolved)},
          {"wall_seconds", interval("value", e.wall_seconds)},
          {"share", e.share},
          {"mean_change", e.mean_change},
          {"pixels_changed", e.pixels_changed}};
}

Json answer_json(const CostAnswer& a) {
  return {{"text", a.text},
          {"command", a.command},
          {"predicted", {{"nrmse", range(a.nrmse)}, {"cpu_seconds", range(a.cpu_seconds)}}},
          {"extrapolated", a.extrapolated}};
}

Json worst_json(const CostReport& report) {
  Json pixels = Json::array();
  for (const CostWorst& w : report.worst)
    pixels.push_back({{"x", w.pixel.x}, {"y", w.pixel.y}, {"share", w.share}, {"shape", w.shape}, {"light", w.light}});
  return {{"half_error_pixels", report.half_error_pixels}, {"pixels", pixels}};
}

template <class Item>
Json list(const std::vector<Item>& items, Json (*of)(const Item&)) {
  Json array = Json::array();
  for (const Item& item : items) array.push_back(of(item));
  return array;
}

}  // namespace

std::string cost_json(const CostReport& report) {
  const Json json{{"scene", report.scene},
                  {"machine", report.machine},
                  {"reference",
                   {{"samples", report.reference_samples},
                    {"seconds", report.reference_seconds},
                    {"noise", report.reference_noise}}},
                  {"order", interval("value", report.order)},
                  {"time", {{"fixed", report.fixed_seconds}, {"per_sample", report.per_sample_seconds}}},
                  {"settings", list(report.settings, setting_json)},
                  {"effects", list(report.effects, effect_json)},
                  {"answers", list(report.answers, answer_json)},
                  {"worst", worst_json(report)},
                  {"not_known", report.not_known},
                  {"complete", report.complete}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace whit
