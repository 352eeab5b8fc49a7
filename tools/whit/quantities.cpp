#include "tools/whit/quantities.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <string_view>

namespace whit {
namespace {

/// What comes behind a number. Hundredths and thousandths divide, since as factors they are not exact.
struct UnitOf {
  std::string_view name;
  double times = 1, over = 1;
};

/// A number above 0 before one of the units, times what the unit stands for; else 0.
double quantity(const std::string& text, std::initializer_list<UnitOf> units) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || !(number > 0) || !std::isfinite(number)) return 0;
  std::string_view unit(rest, static_cast<size_t>(end - rest));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  for (const UnitOf& u : units) {
    if (unit == u.name) return number * u.times / u.over;
  }
  return 0;
}

}  // namespace

double duration_of(const std::string& text) {
  return quantity(text, {{""}, {"s"}, {"ms", 1, 1000}, {"min", 60}, {"h", 3600}});
}

uint64_t size_of(const std::string& text) {
  constexpr double kKiB = 1024, kMiB = 1024 * kKiB, kGiB = 1024 * kMiB, kTiB = 1024 * kGiB, kMost = 0x1p62;
  const double bytes = quantity(text, {{""},
                                       {"B"},
                                       {"K", kKiB},
                                       {"KB", kKiB},
                                       {"KiB", kKiB},
                                       {"M", kMiB},
                                       {"MB", kMiB},
                                       {"MiB", kMiB},
                                       {"G", kGiB},
                                       {"GB", kGiB},
                                       {"GiB", kGiB},
                                       {"T", kTiB},
                                       {"TB", kTiB},
                                       {"TiB", kTiB}});
  return static_cast<uint64_t>(std::min(bytes, kMost));
}

double share_of(const std::string& text) { return quantity(text, {{""}, {"%", 1, 100}}); }

}  // namespace whit
