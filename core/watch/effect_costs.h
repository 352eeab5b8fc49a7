// What an effect costs in time, by a piece of the picture with it and without.
#pragma once

#include <functional>
#include <optional>

#include "core/session/session.h"

namespace whit {

class EffectCosts {
 public:
  /// Of a world, for as long as `go_on` says so.
  EffectCosts(const BuiltWorld& world, std::function<bool()> go_on) : world_(world), go_on_(std::move(go_on)) {}

  /// Of the time that the world takes, the share that it does not take as it is here. Nothing when it was stopped.
  std::optional<double> share_without(const BuiltWorld& without, int threads);

 private:
  const BuiltWorld& world_;
  std::function<bool()> go_on_;
};

}  // namespace whit
