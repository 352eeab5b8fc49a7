#include "core/session/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "core/base/file_names.h"

namespace whit {
namespace {

/// Flags that say which part, and how many words follow each.
constexpr std::pair<std::string_view, int> kPartFlags[] = {
    {"--sample-range", 1}, {"--cropwindow", 4}, {"--crop-pixels", 4}, {"--pixel", 2}, {"--samples", 1}};

std::optional<int> words_behind(std::string_view flag) {
  for (const auto& [name, words] : kPartFlags) {
    if (flag == name) return words;
  }
  return {};
}

RenderIdentity identity_of_whole(RenderIdentity identity) {
  std::erase_if(identity.parts, [](const RenderIdentity::Part& p) { return words_behind(p.what).has_value(); });
  return identity;
}

struct Part {
  std::string path;
  FilmPart of;
};

std::string samples_text(uint32_t first, uint32_t end) {
  return end - first == 1 ? fmt::format("sample {}", first) : fmt::format("samples {} to {}", first, end - 1);
}

std::string pixels_text(const Box2i& box) {
  return fmt::format("pixels {} to {} of rows {} to {}", box.min.x, box.max.x - 1, box.min.y, box.max.y - 1);
}

double area(const Box2i& box) { return double{1} * (box.max.x - box.min.x) * (box.max.y - box.min.y); }

bool overlap(const Box2i& a, const Box2i& b) {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

/// Why a file is no part of a picture like the first one's, or "".
std::string problem_of(const CheckpointFile& file, const std::string& path, const CheckpointHead& first,
                       const std::string& first_path, FilmRender::Gaps gaps) {
  const std::string other = difference(identity_of_whole(first.identity), identity_of_whole(file.head.identity));
  if (!other.empty()) return fmt::format("\"{}\" and \"{}\" are of different renders: {}", first_path, path, other);
  if (!file.head.complete && gaps == FilmRender::Gaps::None)
    return fmt::format("\"{}\" is of a render that has not ended; its command with --resume {} goes on with it", path,
                       shell_word(path));
  const FilmPart &a = first.part, &b = file.head.part;
  if (b.samples.whole == 0)
    return fmt::format("\"{}\" is of a render to an accuracy, whose samples are of no fixed number", path);
  if (a.resolution != b.resolution || a.samples.whole != b.samples.whole) {
    return fmt::format("\"{}\" is of {} x {} pixels of {} samples, and \"{}\" of {} x {} of {}", first_path,
                       a.resolution.x, a.resolution.y, a.samples.whole, path, b.resolution.x, b.resolution.y,
                       b.samples.whole);
  }
  return {};
}

/// What is wrong with parts of one window, in the order of their samples; or "".
std::string samples_problem(const std::vector<Part>& parts, uint32_t whole, FilmRender::Gaps gaps) {
  uint32_t have = 0;
  const Part* before = nullptr;
  const auto missing = [&](uint32_t end) {
    return fmt::format("{} of {} are in no part of {}: --sample-range {}:{} renders them", samples_text(have, end),
                       whole, pixels_text(parts.front().of.window), have, end);
  };
  for (const Part& p : parts) {
    const SampleRange& s = p.of.samples;
    if (s.first > have && gaps == FilmRender::Gaps::None) return missing(s.first);
    if (s.first < have) {
      return fmt::format("{} of {} are in \"{}\" and in \"{}\"", samples_text(s.first, std::min(s.last, have)),
                         pixels_text(p.of.window), before->path, p.path);
    }
    have = s.last, before = &p;
  }
  return have < whole && gaps == FilmRender::Gaps::None ? missing(whole) : "";
}

bool comes_before(const Part& a, const Part& b) {
  const auto key = [](const Part& p) {
    const Box2i& w = p.of.window;
    return std::tuple(w.min.y, w.min.x, w.max.y, w.max.x, p.of.samples.first, p.of.samples.last);
  };
  return key(a) < key(b);
}

/// Puts parts of one window together.
void sort_into_windows(std::vector<Part> parts, PartsPlan& plan) {
  std::sort(parts.begin(), parts.end(), comes_before);
  for (auto from = parts.begin(); from != parts.end() && plan.problem.empty();) {
    const Box2i window = from->of.window;
    const auto to = std::find_if(from, parts.end(), [&](const Part& p) { return p.of.window != window; });
    const std::vector<Part> same(from, to);
    plan.problem = samples_problem(same, plan.samples, plan.gaps);
    for (const PartWindow& other : plan.windows) {
      if (!plan.problem.empty() || !overlap(other.window, window)) continue;
      plan.problem = fmt::format("\"{}\" has {}, and \"{}\" has {}: they overlap", other.paths.front(),
                                 pixels_text(other.window), same.front().path, pixels_text(window));
    }
    PartWindow joined{window, {}};
    for (const Part& p : same) joined.paths.push_back(p.path);
    plan.windows.push_back(std::move(joined));
    from = to;
  }
}

/// The film of one window.
class Joined {
 public:
  Joined(const BuiltWorld& world, RenderOptions options, const PartWindow& of, const PartsPlan& plan) {
    options.crop_given = true;
    pixel_crop(of.window, plan.resolution, options.crop);
    FilmRender film(*world.scene, options);
    for (const std::string& path : of.paths) {
      const CheckpointFile file(path);
      ByteReader in(file.state);
      if (!film.merge(in, plan.gaps)) problem_ = "its film is of another kind";
      if (!file.problem.empty()) problem_ = file.problem;
      if (const std::string changed = file.file.problem(); !changed.empty()) problem_ = changed;
      if (problem_.empty()) continue;
      problem_ = fmt::format("cannot join \"{}\": {}", path, problem_);
      return;
    }
    result_ = film.result();
  }
  const std::string& problem() const { return problem_; }
  RenderResult& result() { return result_; }

 private:
  std::string problem_;
  RenderResult result_;
};

/// Puts some pixels into those of a whole picture.
void paste(const RenderResult& part, RenderResult& whole) {
  const Box2i &from = part.picture.window, &to = whole.picture.window;
  const auto width = static_cast<size_t>(part.picture.width());
  const auto copy = [&](const std::vector<float>& values, std::vector<float>& out, size_t channels) {
    for (int y = from.min.y; y < from.max.y; ++y) {
      const size_t row = width * static_cast<size_t>(y - from.min.y);
      const size_t at = static_cast<size_t>(whole.picture.width()) * static_cast<size_t>(y - to.min.y) +
                        static_cast<size_t>(from.min.x - to.min.x);
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(channels * row), channels * width,
                  out.begin() + static_cast<std::ptrdiff_t>(channels * at));
    }
  };
  copy(part.picture.rgb, whole.picture.rgb, 3);
  for (size_t c = 0; c < part.aovs.channels.size(); ++c)
    copy(part.aovs.channels[c].values, whole.aovs.channels[c].values, 1);
}

/// A whole of which no pixel is there yet, like a part.
RenderResult empty_like(const RenderResult& part, const Box2i& window) {
  RenderResult whole;
  whole.picture.resolution = part.picture.resolution, whole.picture.window = window;
  const size_t pixels = static_cast<size_t>(whole.picture.width()) * static_cast<size_t>(whole.picture.height());
  whole.picture.rgb.resize(3 * pixels);
  whole.aovs = {{}, part.aovs.header, part.aovs.matrices, std::vector<std::set<uint32_t>>(part.aovs.seen.size())};
  for (const AovPicture::Channel& c : part.aovs.channels)
    whole.aovs.channels.push_back({c.name, c.full_float, std::vector<float>(pixels)});
  whole.samples_per_pixel = part.samples_per_pixel, whole.threads = part.threads;
  return whole;
}

}  // namespace

PartsPlan plan_parts(const std::vector<std::string>& paths, FilmRender::Gaps gaps) {
  PartsPlan plan;
  plan.gaps = gaps;
  std::vector<Part> parts;
  CheckpointHead first;
  for (const std::string& path : paths) {
    const CheckpointFile file(path);
    const std::string unreadable = file.problem.empty() ? file.file.problem() : file.problem;
    plan.unreadable = !unreadable.empty();
    if (parts.empty()) first = file.head;
    plan.problem = plan.unreadable ? fmt::format("cannot join \"{}\": {}", path, unreadable)
                                   : problem_of(file, path, first, parts.empty() ? path : parts.front().path, gaps);
    if (!plan.problem.empty()) return plan;
    parts.push_back({path, file.head.part});
  }
  plan.command = {first.command.folder, first.command.scene, words_of_whole(first.command.words)};
  plan.identity = identity_of_whole(std::move(first.identity));
  plan.resolution = first.part.resolution, plan.samples = first.part.samples.whole;
  sort_into_windows(std::move(parts), plan);
  return plan;
}

std::string identity_problem(const PartsPlan& plan, const RenderIdentity& here) {
  const std::string other = difference(plan.identity, identity_of_whole(here));
  return other.empty() ? "" : fmt::format("the parts are of another render: {}", other);
}

std::string cover_problem(const PartsPlan& plan, const Box2i& wanted) {
  const bool may_miss = plan.gaps == FilmRender::Gaps::Allowed;
  // Between neighbouring edges of windows either all pixels are in a window or none.
  std::set<int> xs{wanted.min.x, wanted.max.x}, ys{wanted.min.y, wanted.max.y};
  for (const PartWindow& w : plan.windows) {
    if (w.window.min.x < wanted.min.x || w.window.min.y < wanted.min.y || w.window.max.x > wanted.max.x ||
        w.window.max.y > wanted.max.y) {
      return fmt::format("\"{}\" has {}, and the picture {}", w.paths.front(), pixels_text(w.window),
                         pixels_text(wanted));
    }
    xs.insert({w.window.min.x, w.window.max.x}), ys.insert({w.window.min.y, w.window.max.y});
  }
  for (auto y = ys.begin(); !may_miss && std::next(y) != ys.end(); ++y) {
    for (auto x = xs.begin(); std::next(x) != xs.end(); ++x) {
      const Box2i cell({*x, *y}, {*std::next(x), *std::next(y)});
      const auto holds = [&](const PartWindow& w) { return overlap(w.window, cell); };
      if (std::any_of(plan.windows.begin(), plan.windows.end(), holds)) continue;
      return fmt::format("{} are in no part: --crop-pixels {} {} {} {} renders them", pixels_text(cell), cell.min.x,
                         cell.max.x, cell.min.y, cell.max.y);
    }
  }
  return {};
}

RenderedWorld join_parts(const BuiltWorld& world, RenderOptions options, const PartsPlan& plan, const Box2i& window) {
  const Stopwatch watch;
  RenderedWorld out;
  std::optional<RenderResult> whole;
  double samples = 0;  // over all pixels
  for (const PartWindow& w : plan.windows) {
    Joined joined(world, options, w, plan);
    if (!joined.problem().empty()) {
      out.said.file_error({}, joined.problem());
      return out;
    }
    const RenderResult& part = joined.result();
    if (!whole) whole = empty_like(part, window);
    paste(part, *whole);
    samples += part.samples_per_pixel * area(w.window);
    for (size_t m = 0; m < part.aovs.seen.size(); ++m)
      whole->aovs.seen[m].insert(part.aovs.seen[m].begin(), part.aovs.seen[m].end());
    whole->statistics.add(part.statistics);
    whole->seconds += part.seconds, whole->cpu_seconds += part.cpu_seconds;
  }
  if (whole) out.result = std::move(*whole);
  if (plan.gaps == FilmRender::Gaps::Allowed) {
    out.result.samples_per_pixel = samples / std::max(area(window), 1.0);
    out.result.share = out.result.samples_per_pixel / std::max(plan.samples, 1u);
    out.result.complete = out.result.share >= 1;
  }
  set_matte_headers(*world.scene, AovPlan(*world.scene, options.aovs), options.aovs.place, out.result.aovs);
  out.elapsed = watch.elapsed();
  return out;
}

std::vector<std::string> words_of_whole(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  for (size_t i = 0; i < words.size(); ++i) {
    const size_t equals = words[i].find('=');
    const std::optional<int> behind = words_behind(std::string_view(words[i]).substr(0, equals));
    if (!behind) out.push_back(words[i]);
    else i += static_cast<size_t>(*behind - (equals == std::string::npos ? 0 : 1));
  }
  return out;
}

}  // namespace whit
