#include "tools/whit/quantities.h"

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

double share_of(const std::string& text) { return quantity(text, {{""}, {"%", 1, 100}}); }

}  // namespace whit
