// What people see: messages on stderr, colour and a progress bar only where there is a terminal.
#pragma once

#include <chrono>
#include <string>

#include "core/base/diagnostics.h"
#include "core/base/stopwatch.h"
#include "core/plugin/memory_limit.h"
#include "parser/source.h"

namespace whit {

/// True when stderr is a terminal and NO_COLOR is not set.
bool use_colour();

/// How many characters a line of a terminal has; `otherwise` where the file is none.
int columns_of(int file, int otherwise);

/// Prints a line, or several, to stderr, with control characters escaped.
void say(const std::string& text);

/// Prints diagnostics in file order with their places, and how many there were: of equal ones three, of errors and of
/// warnings a hundred. `quiet_warnings` keeps errors only.
void print_diagnostics(const Sources& sources, const Diagnostics& diagnostics, bool quiet_warnings = false);

/// The exit code that errors lead to: 3 when the scene is wrong, else 4 when files could not be read or written, else 2
/// when what was asked for cannot be had; 0 without errors.
int exit_code(const Diagnostics& diagnostics);

/// Turns every warning into an error (--strict).
Diagnostics strict(const Diagnostics& diagnostics);

/// A bar with elapsed time and an estimate on a terminal, a line now and then in a log.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void update(double share);
  /// The same under another name.
  void update(double share, std::string what);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double share, double seconds) const;
  std::string what_;
  bool terminal_;
  Clock::time_point start_, last_;
  bool drawn_ = false;
  double next_line_ = 10;  ///< Seconds after which a log gets its next line.
};

/// "12.3 s", "4 min 05 s".
std::string duration_text(double seconds);
/// "13.5 M".
std::string count_text(double count);

/// What this process has taken so far: loading the program, if asked first of all. The clock time is right to a hundredth
/// of a second, for as often the system's clock of processes ticks; within that it is the processor time.
Elapsed process_age();

}  // namespace whit
