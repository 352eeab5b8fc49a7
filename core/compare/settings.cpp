#include "core/compare/settings.h"

namespace whit {
namespace {

template <class T>
void take(std::optional<T>& here, const std::optional<T>& said) {
  if (said) here = said;
}

template <class T>
void write(T& here, const std::optional<T>& said) {
  if (said) here = *said;
}

}  // namespace

void CompareSettings::lay(const CompareSettings& over) {
  if (exact && over.limits_anything()) exact = false;
  for (const auto& [measure, limit] : over.limits) limits[measure] = limit;
  take(hard_fail, over.hard_fail);
  take(fail_pixels, over.fail_pixels);
  take(pixel_error, over.pixel_error);
  take(exact, over.exact);
  take(allow_nonfinite, over.allow_nonfinite);
  take(noise, over.noise);
  take(alpha, over.alpha);
  take(channels, over.channels);
  take(colour_space, over.colour_space);
  take(skip, over.skip);
}

void CompareSettings::apply(CompareRequest& request) const {
  for (const auto& [measure, limit] : limits) request.limits.of[measure] = limit;
  take(request.limits.hard_fail, hard_fail);
  take(request.limits.fail_pixels, fail_pixels);
  write(request.limits.pixel_error, pixel_error);
  write(request.limits.exact, exact);
  write(request.limits.allow_nonfinite, allow_nonfinite);
  write(request.limits.noise, noise);
  write(request.limits.alpha, alpha);
  write(request.pair.channels, channels);
  write(request.pair.colour_space, colour_space);
}

}  // namespace whit
