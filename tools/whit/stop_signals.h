// Ctrl-C and its kin as a wish to stop, for work that has something to show for itself.
#pragma once

#include <array>
#include <csignal>
#include <string>

namespace whit {

/// While it lives, SIGINT, SIGTERM and SIGHUP are noted instead of ending the program; a second one ends it. Only one may
/// live at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Thread-safe.
  static bool come();
  /// "SIGTERM"; "" when none has come.
  static std::string name();

 private:
  static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace whit
