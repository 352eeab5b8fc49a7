#include "tools/whit/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>
#include <vector>

#include "tools/whit/commands.h"

namespace whit {

bool use_colour() { return isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr; }

void say(const std::string& text) {
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    fmt::print(stderr, "{}\n", printable(std::string_view(text).substr(at, end - at)));
    at = end + 1;
  }
}

void print_diagnostics(const Sources& sources, const Diagnostics& diagnostics, bool quiet_warnings) {
  // A mistake of an exporter's comes a thousand times; a few places are as good as all.
  constexpr size_t kMostEqual = 3, kMost = 100;
  std::vector<Diagnostic> ordered = diagnostics.all();
  std::stable_sort(ordered.begin(), ordered.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.where.file, a.where.offset) < std::tie(b.where.file, b.where.offset);
  });
  struct Equal {
    size_t count = 0, shown = 0;
    SourcePos last;
  };
  std::map<std::tuple<Severity, std::string, std::string>, Equal> all_equal;
  const auto equal_to = [&](const Diagnostic& d) -> Equal& { return all_equal[{d.severity, d.message, d.remedy}]; };
  size_t counts[3] = {}, shown[3] = {}, hidden = 0;  // by severity
  for (const Diagnostic& d : ordered) {
    ++counts[static_cast<size_t>(d.severity)];
    ++equal_to(d).count;
    equal_to(d).last = d.where;
  }
  for (const Diagnostic& d : ordered) {
    Equal& equal = equal_to(d);
    if (equal.shown == kMostEqual || (quiet_warnings && d.severity != Severity::Error)) continue;
    if (shown[static_cast<size_t>(d.severity)]++ >= kMost) {
      ++hidden;
      continue;
    }
    fmt::print(stderr, "{}", sources.render_diagnostic(d, use_colour()));
    if (++equal.shown == kMostEqual && equal.count > kMostEqual)
      say(fmt::format("  the same at {} more places, the last at {}", equal.count - kMostEqual,
                      sources.location(equal.last)));
  }
  const size_t warnings = counts[static_cast<size_t>(Severity::Warning)];
  const size_t errors = counts[static_cast<size_t>(Severity::Error)];
  const size_t notes = counts[static_cast<size_t>(Severity::Note)];
  if (errors + warnings + notes < 2) return;
  const auto counted = [](size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); };
  say(counted(errors, "error") + ", " + counted(warnings, "warning") +
      (notes > 0 ? ", " + counted(notes, "note") : "") +
      (hidden > 0 ? fmt::format("; {} of them are not shown", hidden) : ""));
}

int exit_code(const Diagnostics& diagnostics) {
  int code = 0;
  for (const Diagnostic& d : diagnostics.all()) {
    if (d.severity != Severity::Error) continue;
    if (d.error_class == ErrorClass::Scene) return kSceneError;
    if (d.name == kLimitHit) code = kLimit;
    else if (d.error_class == ErrorClass::File && code != kLimit) code = kFileError;
    if (d.error_class == ErrorClass::Usage && code == 0) code = kUsage;
  }
  return code;
}

Diagnostics strict(const Diagnostics& diagnostics) {
  Diagnostics out;
  for (Diagnostic d : diagnostics.all()) {
    d.severity = Severity::Error;
    out.add(std::move(d));
  }
  return out;
}

int columns_of(int file, int otherwise) {
  winsize size{};
  return ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : otherwise;
}

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(double share) {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (terminal_) {
    if (std::chrono::duration<double>(now - last_).count() < 0.1) return;
    last_ = now;
    drawn_ = true;
    draw(share, seconds);
  } else if (seconds >= next_line_) {
    next_line_ = seconds + 10;
    say(fmt::format("{}: {:.0f} % after {}, {} left", what_, 100 * share, duration_text(seconds),
                    duration_text(share > 0 ? seconds * (1 - share) / share : 0)));
  }
}

void Progress::update(double share, std::string what) {
  what_ = std::move(what);
  update(share);
}

void Progress::draw(double share, double seconds) const {
  const int columns = columns_of(STDERR_FILENO, 80);
  const std::string tail = fmt::format(" {:3.0f} %  {}  {} left", 100 * share, duration_text(seconds),
                                       duration_text(share > 0.01 ? seconds * (1 - share) / share : 0));
  const int width = std::max(4, columns - static_cast<int>(what_.size() + tail.size()) - 4);
  const int filled = static_cast<int>(share * width);
  fmt::print(stderr, "\r{} [{}{}]{}\033[K", what_, std::string(static_cast<size_t>(filled), '='),
             std::string(static_cast<size_t>(width - filled), ' '), tail);
  std::fflush(stderr);
}

std::string duration_text(double seconds) {
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", 1000 * seconds);
  if (seconds < 99.95) return fmt::format("{:.1f} s", seconds);
  const int s = static_cast<int>(seconds + 0.5);
  if (s < 3600) return fmt::format("{} min {:02d} s", s / 60, s % 60);
  return fmt::format("{} h {:02d} min", s / 3600, s / 60 % 60);
}

std::string count_text(double count) {
  if (count < 1e4) return fmt::format("{:.0f}", count);
  if (count < 1e6) return fmt::format("{:.1f} k", count / 1e3);
  if (count < 1e9) return fmt::format("{:.2f} M", count / 1e6);
  return fmt::format("{:.2f} G", count / 1e9);
}

Elapsed process_age() {
  const double cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  // proc(5): the 22nd field, which the name in parentheses is the second of, is when the process began, in ticks.
  constexpr int kAfterName = 20;
  std::ifstream file("/proc/self/stat");
  std::string text, began;
  std::getline(file, text);
  std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  for (int i = 0; i < kAfterName && fields >> began;) ++i;
  timespec now{};
  if (!fields || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return {cpu, cpu};
  const double tick = 1.0 / static_cast<double>(sysconf(_SC_CLK_TCK));
  const double most =
      static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) - tick * std::stod(began);
  return {std::clamp(cpu, std::max(most - tick, 0.0), std::max(most, tick)), cpu};
}

}  // namespace whit
