#include "core/compare/page_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/plain_text.h"
#include "core/compare/measures.h"
#include "core/compare/number_words.h"

namespace whit {
namespace {

using nlohmann::json;

constexpr int kThumbnailWidth = 224;
constexpr int kBlockSize = 8;  // Of the measure "block".

// JSON has no NaN.
json number(double v) {
  if (std::isfinite(v)) return v;
  return std::isnan(v) ? "NaN" : v > 0 ? "+inf" : "-inf";
}

const char* kind_name(ChannelKind kind) {
  switch (kind) {
    case ChannelKind::Colour: return "colour";
    case ChannelKind::Data: return "data";
    case ChannelKind::Id: return "id";
    default: return "statistic";
  }
}

const char* numbers_name(PageNumbers numbers) {
  return numbers == PageNumbers::Half ? "half" : numbers == PageNumbers::Float ? "float" : "whole";
}

json measures_json(const Comparison& c) {
  json out = json::array();
  for (const Measured& m : c.measured) {
    const MeasureRow* row = find_measure(m.measure);
    out.push_back({{"measure", m.measure},
                   {"layer", one_line(m.layer)},
                   {"value", number(m.value)},
                   {"limit", m.limit ? number(*m.limit) : json()},
                   {"falls", row && row->falls},
                   {"failed", c.failure_of(m) != nullptr},
                   {"doc", row ? row->doc : ""},
                   {"words", one_line(m.words)}});
  }
  return out;
}

json region(const char* kind, const std::string& title, const std::string& text, const Box2i& box,
            const std::string& layer) {
  return {{"kind", kind},
          {"title", one_line(title)},
          {"text", one_line(text)},
          {"layer", one_line(layer)},
          {"box", {box.min.x, box.min.y, box.max.x, box.max.y}}};
}

// A pixel, or the block whose upper left one it is.
Box2i box_of(const std::string& measure, Vec2i at) {
  const int more = measure == "block" ? kBlockSize - 1 : 0;
  return {at, at + Vec2i(more, more)};
}

void add_noise(const Comparison& c, json& out) {
  if (!c.noise) return;
  for (const NoiseRegion& r : c.noise->regions) {
    std::string text = p_text(r.p);
    for (const std::string& object : r.objects) text += ", " + object;
    out.push_back(region("noise", signed_percent_text(r.change) + " in " + r.channel, text, r.box, ""));
  }
}

void add_failures(const Comparison& c, json& out) {
  for (const Failure& f : c.failed)
    if (f.at && f.measure != "noise" && f.measure != "nonfinite")
      out.push_back(region(
          "failure", f.measure + (f.layer.empty() ? "" : " in " + f.layer),
          fmt::format("{:.4g}, the limit is {:.4g}{}{}", f.value, f.limit, f.channel.empty() ? "" : " in ", f.channel),
          box_of(f.measure, *f.at), f.layer));
}

std::string place_title(const std::string& measure) {
  if (measure == "max") return "largest difference";
  return measure == "block" ? "block that differs most" : measure;
}

// Of the layer that is looked at first: others are looked at where they fail. The first of all pixels that differ is just
// some pixel.
void add_places(const Comparison& c, const std::string& layer, json& out) {
  for (const Measured& m : c.measured)
    if (m.at && m.layer == layer && m.measure != "pixels" && !c.failure_of(m) && m.value > 0)
      out.push_back(region("place", place_title(m.measure) + (m.layer.empty() ? "" : " in " + m.layer),
                           fmt::format("{:.4g}{}{}", m.value, m.channel.empty() ? "" : " in ", m.channel),
                           box_of(m.measure, *m.at), m.layer));
}

void add_nonfinite(const Comparison& c, json& out) {
  for (const NonFinite& n : c.nonfinite)
    out.push_back(region("nonfinite", n.side == Side::A ? "not finite in A" : "not finite in B",
                         fmt::format("{} is {}", n.channel, n.value), {n.at, n.at}, ""));
}

json layers_json(const PageRow& row, const std::string& id) {
  json out = json::array();
  for (size_t i = 0; i < row.layers.size(); ++i) {
    const PageLayer& layer = row.layers[i];
    json channels = json::array();
    for (const std::string& channel : layer.channels) channels.push_back(one_line(channel));
    out.push_back({{"name", one_line(layer.name)},
                   {"kind", kind_name(layer.kind)},
                   {"channels", channels},
                   {"numbers", numbers_name(layer.numbers)},
                   {"data", layer.data.empty() ? json() : json(fmt::format("{}-{}", id, i))}});
  }
  return out;
}

std::vector<std::string> notes_of(const PageRow& row) {
  std::vector<std::string> notes = row.comparison.notes;
  if (row.size.step > 1)
    notes.push_back(
        fmt::format("The pictures are shown reduced: a pixel here is the mean of {0} x {0}.", row.size.step));
  const auto shown = [](const PageLayer& layer) { return !layer.data.empty(); };
  const auto rounded = [&](const PageLayer& layer) { return layer.rounded && shown(layer); };
  if (std::any_of(row.layers.begin(), row.layers.end(), rounded))
    notes.emplace_back("Values are shown as halfs, of 11 binary digits.");
  if (!row.layers.empty() && !shown(row.layers[0]))
    notes.emplace_back("The numbers of these pictures are not in the page, which would be too large.");
  else if (!std::all_of(row.layers.begin(), row.layers.end(), shown))
    notes.emplace_back("Some layers are not in the page, which would be too large.");
  if (row.comparison.noise) notes.push_back(row.comparison.noise->how);
  for (std::string& note : notes) note = one_line(note);
  return notes;
}

void add_layers(const PicturePair& pair, PageRow& row) {
  const ComparedLayer* first = pair.beauty();
  if (first) row.layers.push_back(page_layer(pair, *first, row.size));
  for (const ComparedLayer& layer : pair.layers)
    if (&layer != first && layer.kind != ChannelKind::Statistic)
      row.layers.push_back(page_layer(pair, layer, row.size));
}

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (size_t at = 0; at <= path.size();) {
    const size_t end = std::min(path.find('/', at), path.size());
    parts.push_back(path.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

}  // namespace

std::string row_name(const std::string& a_path, const std::string& b_path) {
  const std::vector<std::string> a = parts_of(a_path), b = parts_of(b_path);
  std::string name;
  for (size_t i = 1; i <= std::min(a.size(), b.size()) && a[a.size() - i] == b[b.size() - i]; ++i)
    name = name.empty() ? a[a.size() - i] : a[a.size() - i] + "/" + name;
  return name.empty() ? a.back() + " against " + b.back() : name;
}

std::string row_reason(const PageRow& row) {
  const std::string text = verdict_text(row.comparison);
  for (const std::string word : {"same: ", "differs: ", "cannot compare: "})
    if (text.rfind(word, 0) == 0) return text.substr(word.size());
  return text;
}

const char* row_status(const PageRow& row) {
  return !row.comparison.cannot.empty() ? "cannot" : row.comparison.same() ? "same" : "differs";
}

PageRow make_page_row(const Comparison& comparison, const PicturePair* pair) {
  PageRow row;
  row.comparison = comparison;
  row.name = row_name(comparison.a_path, comparison.b_path);
  row.badness = badness(comparison);
  if (!pair || !comparison.cannot.empty() || pair->layers.empty()) return row;
  row.size = page_size(*pair);
  row.corner = pair->window.min;
  row.display = pair->scale == PairScale::Display;
  add_layers(*pair, row);
  if (pair->beauty()) row.flip = page_map(flip_of(*pair).map, *pair, row.size);
  row.thumb_a = thumbnail(*pair, Side::A, kThumbnailWidth);
  row.thumb_b = thumbnail(*pair, Side::B, kThumbnailWidth);
  row.thumb_heat = heat_thumbnail(*pair, kThumbnailWidth);
  return row;
}

std::string row_json(const PageRow& row, const std::string& id) {
  json regions = json::array();
  add_noise(row.comparison, regions);
  add_failures(row.comparison, regions);
  add_nonfinite(row.comparison, regions);
  add_places(row.comparison, row.layers.empty() ? "" : row.layers[0].name, regions);
  const json out{{"name", one_line(row.name)},
                 {"a", one_line(row.comparison.a_path)},
                 {"b", one_line(row.comparison.b_path)},
                 {"status", row_status(row)},
                 {"verdict", one_line(row_reason(row))},
                 {"width", row.size.width},
                 {"height", row.size.height},
                 {"step", row.size.step},
                 {"corner", {row.corner.x, row.corner.y}},
                 {"full", {row.comparison.width, row.comparison.height}},
                 {"display", row.display},
                 {"layers", layers_json(row, id)},
                 {"flip", row.flip.empty() ? json() : json(id + "-flip")},
                 {"measures", measures_json(row.comparison)},
                 {"regions", regions},
                 {"notes", notes_of(row)}};
  // A name with "</script>" must not end the script.
  std::string text = out.dump(-1, ' ', false, json::error_handler_t::replace);
  for (size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += 6) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace whit
