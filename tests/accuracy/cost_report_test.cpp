#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "core/accuracy/estimate.h"
#include "core/accuracy/report.h"
#include "core/accuracy/report_axis.h"
#include "core/accuracy/report_words.h"
#include "core/base/plain_text.h"

namespace whit {
namespace {

// A ball on a floor, with noise that falls with the samples.
CostImage ball(int width, int height, double noise, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal;
  CostImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (x - 0.5 * width) / (0.35 * height), v = (y - 0.5 * height) / (0.35 * height);
      const double inside = 1 - u * u - v * v;
      const double light = inside > 0 ? std::max(0.04, (std::sqrt(inside) - 0.7 * u - 0.6 * v) / 1.4)
                                      : 0.12 + 0.3 * std::max(0.0, v) * (1 + std::sin(9 * u / (0.6 + std::abs(v))));
      const double colour[] = {0.9, inside > 0 ? 0.45 : 0.8, inside > 0 ? 0.25 : 0.7};
      for (double c : colour)
        image.rgb.push_back(static_cast<float>(c * light * std::max(0.0, 1 + noise * double{normal(random)})));
    }
  return image;
}

CostImage difference(const CostImage& a, const CostImage& b) {
  CostImage out = a;
  for (size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = std::abs(a.rgb[i] - b.rgb[i]) / 0.2f;
  return out;
}

CostSetting setting(const char* knob, const char* value, int samples, double cpu, double nrmse, double spread) {
  CostSetting s;
  s.knob = knob;
  s.value = value;
  s.samples = samples;
  s.command = "whit render 'scenes/ball & <floor>.pbrt' --spp " + std::to_string(samples);
  if (s.knob != "samples") s.command += std::string(" --") + knob + " " + value;
  s.cpu_seconds = {cpu, cpu * 0.97, cpu * 1.04};
  s.seconds = {cpu / 3.8, cpu / 3.9, cpu / 3.5};
  s.nrmse = {nrmse, nrmse / (1 + spread), nrmse * (1 + spread)};
  s.upper95 = nrmse * (1 + 0.8 * spread);
  s.relmse = nrmse * nrmse * 1.3;
  s.flip = 0.4 * nrmse;
  s.share_2_255 = std::min(1.0, 4 * nrmse);
  s.quantile95 = 1.9 * nrmse;
  s.crop = ball(48, 48, 3 * nrmse, static_cast<uint64_t>(samples));
  return s;
}

CostEffect effect(const char* name, Estimate seconds, double mean_change, double changed) {
  CostEffect e;
  e.name = name;
  e.command = std::string("whit render 'scenes/ball & <floor>.pbrt' --without ") + name;
  e.seconds = e.wall_seconds = seconds;
  e.resolved = seconds.low > 0 || seconds.high < 0;
  e.share = seconds.value / 14;
  e.mean_change = mean_change;
  e.pixels_changed = changed;
  e.where = difference(ball(64, 40, 0, 1), ball(64, 40, changed, 2));
  return e;
}

// What a study may come to.
CostReport example() {
  CostReport r;
  r.scene = "scenes/ball & <floor>.pbrt";
  r.machine = "AMD EPYC 7B13, 4 threads, AVX2";
  r.integrator = "path";
  r.sampler = "sobol";
  r.resolution = {480, 300};
  r.own_samples = 64;
  r.reference_samples = 4096;
  r.reference_seconds = 52.3;
  r.reference_noise = 0.0031;
  r.mean_radiance = 0.213;
  r.replicates = 8;
  r.fixed_seconds = 0.12;
  r.per_sample_seconds = 0.0312;
  std::vector<ErrorLevel> levels;
  for (int n : {4, 16, 64, 256}) {
    r.settings.push_back(
        setting("samples", std::to_string(n).c_str(), n, 0.12 + 0.0312 * n, 0.4 * std::pow(n, -0.6), 0.05));
    levels.push_back({n, r.settings.back().nrmse, r.settings.back().upper95});
  }
  r.order = fit_order(levels).order;
  for (int n : {4, 16, 64, 256})
    r.settings.push_back(setting("sampler", "random", n, 0.11 + 0.0304 * n, 0.45 * std::pow(n, -0.5), 0.06));
  for (int depth : {2, 3, 5})
    r.settings.push_back(
        setting("maxdepth", std::to_string(depth).c_str(), 64, 0.12 + 0.3 * depth, 0.3 / (depth * depth), 0.04));
  for (CostSetting& s : r.settings)
    if (s.knob == "maxdepth") s.bias = Estimate{s.nrmse.value * 0.9, s.nrmse.value * 0.8, s.nrmse.value};
  r.settings.push_back(setting("texture filter", "point", 64, 1.9, 0.041, 0.05));
  r.settings.push_back(setting("texture filter", "trilinear", 64, 2.02, 0.036, 0.05));
  mark_pareto(r.settings);
  r.effects = {effect("indirect", {1.2, 1.1, 1.3}, 0.31, 0.82), effect("bump", {0.021, -0.03, 0.072}, -0.002, 0.04),
               effect("texture-filter", {0.08, 0.05, 0.11}, 0.0001, 0.11)};
  r.answers = {{"1 % error (nRMSE, 95 % sure) takes 14 s of CPU time on this machine",
                "whit render 'scenes/ball & <floor>.pbrt' --spp 512",
                {0.009, 0.0081, 0.01},
                {14, 12, 17},
                true},
               {"half the error of 64 samples costs x3.1",
                "whit render 'scenes/ball & <floor>.pbrt' --spp 256",
                {0.0144, 0.0137, 0.0151},
                {8.1, 7.9, 8.4},
                false},
               {"maxdepth 5 instead of 12 saves 32 % and changes 1.1 % of the pixels by more than 1 %",
                "whit render 'scenes/ball & <floor>.pbrt' --maxdepth 5",
                {0.012, 0.0115, 0.0125},
                {1.62, 1.57, 1.68},
                false}};
  r.worst = {{{212, 90}, 0.083, "sphere ball.pbrt:12", "point light ball.pbrt:4"},
             {{213, 91}, 0.041, "sphere ball.pbrt:12", ""},
             {{20, 280}, 0.012, "", ""}};
  r.half_error_pixels = 61;
  r.not_known = {"The sampler was not tried with 1024 samples: there was no time left.",
                 "Nothing is said of the error of the integrator itself: <whitted> leaves out light between surfaces."};
  r.picture = ball(480, 300, 0.05, 5);
  r.error = difference(r.picture, ball(480, 300, 0, 5));
  return r;
}

// All that can be missing or not a number.
CostReport odd() {
  CostReport r = example();
  r.scene = "a\"b'<script>alert(1)</script>\n\x1b[31m\xff\xe2\x82.pbrt";
  r.complete = false;
  r.reference_noise = NAN;
  r.order = {NAN, -INFINITY, INFINITY};
  r.fixed_seconds = NAN;
  r.settings[0].nrmse = {0, 0, 0};
  r.settings[1].nrmse = {NAN, NAN, NAN};
  r.settings[2].cpu_seconds = {0, 0, 0};
  r.settings[3].nrmse.low = 0;
  r.settings[3].crop = {};
  r.settings[4].flip = INFINITY;
  r.settings[5].value = "<b>&\"";
  r.effects[0].seconds = {NAN, -INFINITY, INFINITY};
  r.effects[0].where = {};
  r.effects[1].where.rgb.assign(r.effects[1].where.rgb.size(), NAN);
  r.answers[0].nrmse = {NAN, NAN, NAN};
  r.picture.rgb[7] = NAN;
  r.error.rgb[7] = INFINITY;
  return r;
}

std::vector<CostReport> reports() {
  CostReport one = example();
  one.settings.resize(1);
  one.effects.clear();
  one.answers.clear();
  return {example(), odd(), one, CostReport()};
}

std::vector<std::string> keys(const nlohmann::ordered_json& object) {
  std::vector<std::string> out;
  for (const auto& [key, value] : object.items()) out.push_back(key);
  return out;
}

using Keys = std::vector<std::string>;

TEST(CostJson, HasItsKeys) {
  const auto json = nlohmann::ordered_json::parse(cost_json(example()));
  EXPECT_EQ(keys(json), (Keys{"scene", "machine", "reference", "order", "time", "settings", "effects", "answers",
                              "worst", "not_known", "complete"}));
  EXPECT_EQ(keys(json["reference"]), (Keys{"samples", "seconds", "noise"}));
  EXPECT_EQ(keys(json["order"]), (Keys{"value", "low", "high"}));
  EXPECT_EQ(keys(json["time"]), (Keys{"fixed", "per_sample"}));
  EXPECT_EQ(keys(json["settings"][0]), (Keys{"knob", "value", "samples", "command", "seconds", "cpu_seconds", "nrmse",
                                             "bias", "change", "relmse", "flip", "share_2_255", "pareto"}));
  EXPECT_EQ(keys(json["settings"][0]["seconds"]), (Keys{"median", "low", "high"}));
  EXPECT_EQ(keys(json["settings"][0]["cpu_seconds"]), (Keys{"median", "low", "high"}));
  EXPECT_EQ(keys(json["settings"][0]["nrmse"]), (Keys{"value", "low", "high", "upper95"}));
  EXPECT_EQ(keys(json["effects"][0]),
            (Keys{"name", "command", "samples", "seconds", "wall_seconds", "share", "mean_change", "pixels_changed"}));
  EXPECT_EQ(keys(json["effects"][0]["seconds"]), (Keys{"value", "low", "high", "resolved"}));
  EXPECT_EQ(keys(json["answers"][0]), (Keys{"text", "command", "predicted", "extrapolated"}));
  EXPECT_EQ(json["answers"][0]["predicted"]["cpu_seconds"]["high"], 17);
  EXPECT_EQ(json["settings"][0]["bias"], nullptr);
  EXPECT_EQ(json["settings"][8]["bias"]["value"], 0.9 * 0.3 / 4);
  EXPECT_EQ(json["worst"]["half_error_pixels"], 61);
  EXPECT_EQ(json["worst"]["pixels"][0]["shape"], "sphere ball.pbrt:12");
  EXPECT_EQ(json["scene"], "scenes/ball & <floor>.pbrt");
}

TEST(CostJson, IsAlwaysJson) {
  for (const CostReport& report : reports()) EXPECT_TRUE(nlohmann::json::accept(cost_json(report)));
}

size_t fields(const std::string& row) {
  size_t n = 1;
  bool quoted = false;
  for (char c : row) {
    if (c == '"') quoted = !quoted;
    n += c == ',' && !quoted;
  }
  return n;
}

TEST(CostCsv, HasARowForEach) {
  CostReport report = example();
  report.settings[0].command = "whit render \"a, b\".pbrt";
  std::istringstream lines(cost_csv(report));
  std::string header, line;
  std::getline(lines, header);
  size_t rows = 0;
  while (std::getline(lines, line)) {
    EXPECT_EQ(fields(line), fields(header)) << line;
    ++rows;
  }
  EXPECT_EQ(rows, report.settings.size() + report.effects.size());
  EXPECT_NE(cost_csv(report).find("\"whit render \"\"a, b\"\".pbrt\""), std::string::npos);
}

TEST(CostText, FitsTheTerminal) {
  for (const CostReport& report : reports())
    for (int columns : {20, 80, 100, 120, 1000}) {
      const std::string text = cost_text(report, false, columns);
      EXPECT_EQ(text.find('\x1b'), std::string::npos);
      EXPECT_EQ(text.find("nan"), std::string::npos);
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);)
        // Commands are to be pasted, and stay whole.
        if (line.find("whit render") == std::string::npos && columns >= 80) {
          EXPECT_LE(line.size(), static_cast<size_t>(columns)) << line;
        }
    }
}

TEST(CostText, SaysWhatMatters) {
  const std::string text = cost_text(example(), false, 100);
  for (const char* what : {"not reality", "samples^-0.600 [", "not resolved [-30.0, 72.0] ms", "need not add up",
                           "(extrapolated)", "Not known:", "61 pixels", "--spp 512"})
    EXPECT_NE(text.find(what), std::string::npos) << what;
  for (const char* what : {"Ended early", "How nRMSE falls with the samples is not known"})
    EXPECT_NE(cost_text(odd(), false, 100).find(what), std::string::npos) << what;
}

// The page without the bytes of its pictures, which may spell anything.
std::string without_pictures(const std::string& page) {
  std::string out;
  for (size_t at = 0; at < page.size();) {
    const size_t picture = std::min(page.find("base64,", at), page.size());
    out += page.substr(at, picture - at);
    at = std::min(page.find('"', picture), page.size());
  }
  return out;
}

TEST(CostHtml, IsCompleteAndEscaped) {
  for (const CostReport& report : reports()) {
    const std::string page = cost_html(report);
    const std::string words = without_pictures(page);
    for (const char* bad : {"nan", "inf\"", "inf ", "-inf", "<script", "http:", "https:"})
      EXPECT_EQ(words.find(bad), std::string::npos) << bad;
    EXPECT_NE(page.find("</html>"), std::string::npos);
  }
  const std::string page = cost_html(example());
  for (const char* what : {"scenes/ball &amp; &lt;floor&gt;.pbrt", "not resolved", "need not add up", "★",
                           "extrapolated", "noise of the reference", "What is not known"})
    EXPECT_NE(page.find(what), std::string::npos) << what;
}

// For tests/accuracy/cost_page_test.py, which opens them.
TEST(CostHtml, WritesPages) {
  const char* folder = std::getenv("WHIT_COST_PAGES");
  if (!folder) GTEST_SKIP() << "WHIT_COST_PAGES names no folder";
  int n = 0;
  for (const CostReport& report : reports()) {
    const std::string stem = std::string(folder) + "/" + std::to_string(n++);
    std::ofstream(stem + ".html") << cost_html(report);
    std::ofstream(stem + ".txt") << cost_text(report, false, 100);
  }
}

TEST(ReportWords, HaveThreeDigits) {
  EXPECT_EQ(three_digits(9.996), "10.0");
  EXPECT_EQ(three_digits(0.00123456), "0.00123");
  EXPECT_EQ(three_digits(12345), "12300");
  EXPECT_EQ(three_digits(0.9999), "1.00");
  EXPECT_EQ(three_digits(-4.2), "-4.20");
  EXPECT_EQ(three_digits(100), "100");
  EXPECT_EQ(three_digits(NAN), "unknown");
  EXPECT_EQ(percent_interval({0.0094, 0.0081, 0.01}), "0.940 % [0.810, 1.00]");
  EXPECT_EQ(seconds_interval({0.0312, 0.03, 0.2}), "31.2 ms [30.0, 200]");
  EXPECT_EQ(seconds_text(14), "14.0 s");
  EXPECT_EQ(seconds_text(750), "12.5 min");
  EXPECT_EQ(one_line("a\n\x1b[31m\xc2\x9b\xff\xe2\x82\xac"), "a  [31m ?€");
  EXPECT_EQ(html_text("<\xff\xe2\x82\xac\xc3\">"), "&lt;?€?&quot;&gt;");
}

TEST(LogAxis, HasRoundTicks) {
  EXPECT_EQ((LogAxis{0.9, 11}.ticks(8)), (std::vector<double>{1, 2, 5, 10}));
  EXPECT_EQ((LogAxis{0.9, 1100}.ticks(5)), (std::vector<double>{1, 10, 100, 1000}));
  EXPECT_EQ((LogAxis{0.9, 1100}.ticks(2)), (std::vector<double>{1, 100}));
  EXPECT_DOUBLE_EQ((LogAxis{1, 100}.place(10)), 0.5);
  EXPECT_EQ((LogAxis{1, 100}.place(0)), 0);
  EXPECT_EQ((LogAxis{1, 100}.place(NAN)), 0);
  const LogAxis flat = axis_over({2, 2, 0, NAN});
  EXPECT_LT(flat.low, 2);
  EXPECT_GT(flat.high, 2);
}

}  // namespace
}  // namespace whit
