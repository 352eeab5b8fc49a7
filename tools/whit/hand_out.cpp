#include "tools/whit/hand_out.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include "tools/whit/commands.h"
#include "tools/whit/json.h"
#include "tools/whit/text_file.h"

namespace whit {
namespace {

/// Times as long as a look took until the next.
constexpr double kPause = 10;
/// How often somebody asks whether to go on while nothing comes, in milliseconds.
constexpr int kAsk = 100;

enum class Read { Line, End, Stopped };

/// The next line of standard input, without its end. `goes_on` is asked now and then.
Read read_line(std::string& input, std::string& line, const std::function<bool()>& goes_on) {
  for (;;) {
    if (const size_t end = input.find('\n'); end != std::string::npos) {
      line = input.substr(0, end);
      input.erase(0, end + 1);
      return Read::Line;
    }
    pollfd wait{STDIN_FILENO, POLLIN, 0};
    const int ready = ::poll(&wait, 1, kAsk);
    if (!goes_on()) return Read::Stopped;
    if (ready <= 0) continue;
    char bytes[4096];
    const ssize_t got = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN)) return Read::End;
    input.append(bytes, static_cast<size_t>(std::max<ssize_t>(got, 0)));
  }
}

/// "" or why nobody can be told of a pass.
std::string announce(uint32_t number, const std::string& file, const FilmRender::PassRest& rest,
                     const TargetState& state) {
  const Json::Object said{{"pass", static_cast<int64_t>(number)},
                          {"file", file},
                          {"tiles", static_cast<int64_t>(rest.tiles)},
                          {"samples", rest.samples},
                          {"error", std::isfinite(state.claim.value) ? Json(state.claim.value) : Json()},
                          {"share", state.share}};
  std::string line = to_text(Json(said));
  std::erase(line, '\n');
  return write_text("-", line + '\n');
}

}  // namespace

PassEnd HandOut::fail(PassEnd end, int code, std::string problem) {
  problem_ = std::move(problem), code_ = code;
  return end;
}

PassEnd HandOut::render_pass(FilmRender& film, const TargetState& state, const std::function<bool(double)>& progress) {
  const FilmRender::PassRest rest = film.rest();
  if (rest.tiles == 0) return PassEnd::Over;
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  const std::string file = (std::filesystem::path(folder_) / fmt::format("pass-{}", ++passes_)).string();
  if (const std::string problem = write_pass(file, identity_, passes_, film); !problem.empty())
    return fail(PassEnd::Stopped, kFileError, fmt::format("cannot write \"{}\": {}", file, problem));
  const PassFile written(file);
  if (!written.problem.empty())
    return fail(PassEnd::Stopped, kFileError, fmt::format("cannot read \"{}\": {}", file, written.problem));
  if (const std::string problem = announce(passes_, file, rest, state); !problem.empty())
    return fail(PassEnd::Stopped, kFileError, problem);
  PassParts parts(identity_, written.id);
  const PassEnd end = collect(film, parts, progress);
  if (end == PassEnd::Over) std::filesystem::remove(file, failed);
  return end;
}

PassEnd HandOut::collect(FilmRender& film, PassParts& parts, const std::function<bool(double)>& progress) {
  const double all = film.rest().samples;
  double done = 0;
  for (std::string name;;) {
    const Read read = read_line(input_, name, [&] { return progress(done); });
    if (read == Read::Stopped) return PassEnd::Stopped;
    if (read == Read::End) {
      return fail(PassEnd::Stopped, kFileError,
                  fmt::format("standard input ended in pass {}, before the empty line that ends it", passes_));
    }
    if (name.empty()) break;
    if (const PassEnd end = add(film, parts, name); end != PassEnd::Over) return end;
    done = 1 - film.rest().samples / all;
    look(film);
  }
  if (film.rest().tiles == 0) return PassEnd::Over;
  const std::string missing = parts.missing();
  return fail(PassEnd::Stopped, kUsage,
              fmt::format("not all of pass {} is there: {}", passes_, missing.empty() ? "no part was named" : missing));
}

PassEnd HandOut::add(FilmRender& film, PassParts& parts, const std::string& name) {
  using Trouble = PassParts::Trouble;
  PassParts::Problem problem = parts.add(film, name);
  if (problem.trouble == Trouble::None) return PassEnd::Over;
  const PassEnd end = problem.trouble == Trouble::Unusable ? PassEnd::Failed : PassEnd::Stopped;
  return fail(end, problem.trouble == Trouble::Different ? kUsage : kFileError, std::move(problem.text));
}

void HandOut::look(const FilmRender& film) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [] { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); };
  const double start = seconds();
  if (!look_ || start < next_look_) return;
  look_(film);
  next_look_ = seconds() + kPause * (seconds() - start);
}

}  // namespace whit
