#include "tools/whit/watch_terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "core/color/display.h"
#include "core/watch/halves.h"
#include "tools/whit/commands.h"
#include "tools/whit/terminal.h"
#include "tools/whit/terminal_picture.h"

namespace whit {
namespace {

/// Cells and pixels of the terminal; of one that does not tell its pixels, what most have.
struct Screen {
  int columns = 80, rows = 24, cell_width = 9, cell_height = 18;
};

Screen screen_now() {
  Screen screen;
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return screen;
  screen.columns = size.ws_col, screen.rows = size.ws_row;
  if (size.ws_xpixel > 0 && size.ws_ypixel > 0)
    screen.cell_width = size.ws_xpixel / size.ws_col, screen.cell_height = size.ws_ypixel / size.ws_row;
  return screen;
}

std::string graphics_here(const std::string& asked) {
  if (asked != "auto") return asked;
  const char* const term = std::getenv("TERM");
  const bool kitty = std::getenv("KITTY_WINDOW_ID") != nullptr || (term && std::string_view(term) == "xterm-kitty");
  return kitty && ::isatty(STDOUT_FILENO) != 0 ? "kitty" : "blocks";
}

TerminalPicture for_display(const PreviewPicture& picture, const DisplayTransform& display) {
  std::vector<float> rgb = floats_of(picture.halves);
  display.apply(rgb.data(), rgb.size() / 3);
  TerminalPicture out{picture.width, picture.height, {}};
  out.rgb.reserve(rgb.size());
  for (const float v : rgb) out.rgb.push_back(static_cast<uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f));
  return out;
}

/// The picture in so many cells, by whatever the terminal knows.
std::string drawn(const PreviewPicture& picture, const DisplayTransform& display, const std::string& graphics,
                  const Screen& screen, int rows) {
  const Vec2i size = picture.window.max - picture.window.min;
  const bool blocks = graphics == "blocks";
  // Of half blocks a cell has two pixels, one above the other.
  const double room_x = screen.columns * (blocks ? 1 : screen.cell_width);
  const double room_y = rows * (blocks ? 2 : screen.cell_height);
  const double scale = std::min({room_x / size.x, room_y / size.y, blocks ? 1e9 : 1.0});
  const int width = std::max(1, static_cast<int>(size.x * scale)),
            height = std::max(1, static_cast<int>(size.y * scale));
  const TerminalPicture fitted = resampled(for_display(picture, display), width, height);
  if (graphics == "kitty") return as_kitty(fitted);
  return graphics == "sixel" ? as_sixels(fitted) : as_blocks(fitted);
}

std::string problems_text(const PreviewState& state, int lines) {
  std::string out;
  for (const PreviewProblem& p : state.problems) {
    if (lines-- <= 0) break;
    const std::string where =
        p.where.line > 0 ? fmt::format("{}:{}:{}: ", p.where.file, p.where.line, p.where.column) : "";
    const std::string line = fmt::format("{}{}: {}{}", where, p.is_error ? "error" : "warning", p.message,
                                         p.remedy.empty() ? "" : " (" + p.remedy + ")");
    out += printable(line) + "\n";
  }
  return out;
}

std::string status_text(const std::string& path, const PreviewState& state) {
  if (state.stale) return fmt::format("{}: the picture is of the last text without errors", path);
  return fmt::format("{}: {}, {:.0f} of {:.0f} samples, {}", path, phase_name(state.phase), state.samples,
                     state.samples_wanted, duration_text(state.render_seconds));
}

void put(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

/// One finished picture, for a file or another program.
int draw_once(Preview& preview, const WatchTerminal& how, const DisplayTransform& display) {
  for (uint64_t seen = 0;;) {
    preview.wait_beyond(seen, 100);
    const PreviewState state = preview.state();
    seen = state.version;
    if (how.ended()) return kDone;
    if (state.stale) {
      say(problems_text(state, 50));
      const auto is_limit = [](const PreviewProblem& p) { return p.is_limit; };
      return std::any_of(state.problems.begin(), state.problems.end(), is_limit) ? kLimit : kSceneError;
    }
    if (state.phase != PreviewPhase::Done || !state.picture || !state.picture->done) continue;
    put(drawn(*state.picture, display, graphics_here(how.graphics), {}, 40));
    return kDone;
  }
}

/// The terminal's other page, without a cursor, for as long as this lives.
class OtherScreen {
 public:
  OtherScreen() { put("\033[?1049h\033[?25l\033[2J"); }
  ~OtherScreen() { put("\033[?25h\033[?1049l"); }
  OtherScreen(const OtherScreen&) = delete;
  OtherScreen& operator=(const OtherScreen&) = delete;
};

int draw_until_ended(Preview& preview, const WatchTerminal& how, const DisplayTransform& display) {
  const OtherScreen other;
  const std::string graphics = graphics_here(how.graphics);
  for (uint64_t seen = 0, drawn_number = 0; !how.ended();) {
    preview.wait_beyond(seen, 100);
    const PreviewState state = preview.state();
    if (state.version == seen) continue;
    seen = state.version;
    const Screen screen = screen_now();
    const int lines = std::min<int>(static_cast<int>(state.problems.size()), 4),
              rows = std::max(1, screen.rows - 2 - lines);
    std::string text = "\033[H";
    if (state.picture && (state.picture->number != drawn_number || lines > 0)) {
      drawn_number = state.picture->number;
      text += drawn(*state.picture, display, graphics, screen, rows);
    }
    text += fmt::format("\033[{};1H\033[J{}\n{}", screen.rows - lines, status_text(preview.path(), state),
                        problems_text(state, lines));
    // No newline at the very end, which would move everything up.
    while (text.ends_with('\n')) text.pop_back();
    put(text);
  }
  return kDone;
}

}  // namespace

int watch_in_terminal(Preview& preview, const WatchTerminal& how) {
  DisplaySpec spec;
  spec.config_path = how.ocio, spec.view = how.view;
  const DisplayResult display = make_display_transform(spec);
  if (!display.transform) {
    say("whit watch: " + display.error);
    return kUsage;
  }
  if (::isatty(STDOUT_FILENO) == 0) return draw_once(preview, how, *display.transform);
  return draw_until_ended(preview, how, *display.transform);
}

}  // namespace whit
