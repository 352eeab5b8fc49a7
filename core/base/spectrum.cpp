#include "core/base/spectrum.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>

#include "core/base/cie_1931.h"
#include "core/base/limits.h"

namespace whit {

namespace {

/// The integral of y over wavelength that pbrt-v3 divides by.
constexpr double kYIntegral = 106.856895;

/// The colour of a function of wavelength in nm: the sum over the CIE table, as a mean over its 470 nm.
RGB rgb_from_function(const std::function<double(double)>& value) {
  double xyz[3] = {0, 0, 0};
  for (int i = 0; i < kCieSamples; ++i) {
    const double v = value(kCieFirst + i);
    for (int c = 0; c < 3; ++c) xyz[c] += v * kCie[i][c];
  }
  // 470 nm over 471 samples: a mean, not a Riemann sum, so that white comes out 0.2 % below 1, as in pbrt.
  const double scale = (kCieSamples - 1) / (kYIntegral * kCieSamples);
  return rgb_from_xyz(xyz[0] * scale, xyz[1] * scale, xyz[2] * scale);
}

struct Sample {
  double nm, value;
};

/// Linear interpolation in samples sorted by wavelength, clamped at the ends.
double interpolate(const std::vector<Sample>& samples, double nm) {
  if (nm <= samples.front().nm) return samples.front().value;
  if (nm >= samples.back().nm) return samples.back().value;
  const auto after =
      std::upper_bound(samples.begin(), samples.end(), nm, [](double x, const Sample& s) { return x < s.nm; });
  const Sample a = *std::prev(after), b = *after;
  const double t = (nm - a.nm) / (b.nm - a.nm);
  return (1 - t) * a.value + t * b.value;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

/// Reads the numbers of `text` into `out`; the message of the first mistake, or "".
std::string read_numbers(const std::string& text, std::vector<double>& out) {
  int line = 1;
  const char *at = text.data(), *const end = at + text.size();
  while (at != end) {
    if (*at == '#') {
      at = std::find(at, end, '\n');
    } else if (is_space(*at)) {
      line += *at++ == '\n';
    } else {
      const char* const stop = std::find_if(at, end, [](char c) { return is_space(c) || c == '#'; });
      double value = 0;
      const auto [read_to, code] = std::from_chars(at + (*at == '+'), stop, value);
      if (code != std::errc() || read_to != stop || !std::isfinite(value))
        return "line " + std::to_string(line) + ": expected a number";
      out.push_back(value);
      at = stop;
    }
  }
  return {};
}

}  // namespace

RGB rgb_from_xyz(double x, double y, double z) {
  return {static_cast<float>(3.240479 * x - 1.537150 * y - 0.498535 * z),
          static_cast<float>(-0.969256 * x + 1.875991 * y + 0.041556 * z),
          static_cast<float>(0.055648 * x - 0.204043 * y + 1.057311 * z)};
}

RGB rgb_from_samples(std::span<const double> pairs) {
  std::vector<Sample> samples;
  for (size_t i = 0; i + 1 < pairs.size(); i += 2) samples.push_back({pairs[i], pairs[i + 1]});
  if (samples.empty()) return RGB(0, 0, 0);
  std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.nm < b.nm; });
  return rgb_from_function([&](double nm) { return interpolate(samples, nm); });
}

double planck(double nm, double kelvin) {
  constexpr double kSpeedOfLight = 299792458, kPlanck = 6.62606957e-34, kBoltzmann = 1.3806488e-23;
  const double l = nm * 1e-9;
  return 2 * kPlanck * kSpeedOfLight * kSpeedOfLight /
         (l * l * l * l * l * std::expm1(kPlanck * kSpeedOfLight / (l * kBoltzmann * kelvin)));
}

RGB rgb_from_blackbody(double kelvin, double scale) {
  constexpr double kWien = 2.8977721e-3;  // m K
  const double peak = planck(1e9 * kWien / kelvin, kelvin);
  return rgb_from_function([=](double nm) { return scale * (planck(nm, kelvin) / peak); });
}

SpdFile read_spd_file(const std::string& path) {
  SpdFile file;
  const std::optional<std::string> text = read_file(path, kSpectrumBytes, file.error);
  file.readable = text.has_value();
  if (!text) return file;
  file.error = read_numbers(*text, file.pairs);
  if (!file.error.empty()) return file;
  if (file.pairs.empty()) file.error = "holds no numbers";
  if (file.pairs.size() % 2 != 0) file.error = "the last wavelength has no value";
  return file;
}

}  // namespace whit
