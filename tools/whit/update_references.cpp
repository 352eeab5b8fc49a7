#include "tools/whit/update_references.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

#include "core/base/plain_text.h"
#include "core/compare/folders.h"
#include "core/image/planes.h"
#include "parser/source.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// "exr" of "x.EXR"; one word for endings that mean the same.
std::string kind_of(const std::string& path) {
  const std::string ending = lower_case(fs::path(path).extension().string());
  return ending == ".jpeg" ? ".jpg" : ending == ".tiff" ? ".tif" : ending;
}

/// "", or where a picture has a number that is none: in any channel, for all of them become the reference.
std::string nonfinite_problem(const PicturePlanes& picture) {
  for (size_t c = 0; c < picture.planes.size(); ++c) {
    const std::vector<float>& plane = picture.planes[c];
    const auto bad = std::find_if(plane.begin(), plane.end(), [&](float v) {
      return is_fault(picture.channel_names[c], picture.channel_names, v);
    });
    if (bad == plane.end()) continue;
    const auto at = bad - plane.begin();
    return fmt::format("its {} is {} at ({}, {}), and a reference has finite numbers (--allow-nonfinite allows it)",
                       picture.channel_names[c], *bad, picture.x + at % picture.width - picture.full_x,
                       picture.y + at / picture.width - picture.full_y);
  }
  return "";
}

/// "", or the channels that a reference would lose.
std::string channels_lost(const PicturePlanes& picture, const PicturePlanes& reference) {
  std::vector<std::string> lost;
  for (const std::string& name : reference.channel_names)
    if (picture.channel(name) < 0) lost.push_back(name);
  if (lost.empty()) return "";
  return fmt::format("its picture lacks {}, which the reference has; copy it by hand if that is meant",
                     fmt::join(lost, ", "));
}

/// "", or the pixels that a reference would lose. At another resolution there are none to keep, but the picture must be
/// whole.
std::string pixels_lost(const PicturePlanes& picture, const PicturePlanes& reference) {
  const Box2i whole({0, 0}, {picture.full_width - 1, picture.full_height - 1});
  const bool alike = picture.full_width == reference.full_width && picture.full_height == reference.full_height;
  const Box2i has = data_window(picture), wanted = alike ? data_window(reference) : whole;
  if (has.min.x <= wanted.min.x && has.min.y <= wanted.min.y && has.max.x >= wanted.max.x && has.max.y >= wanted.max.y)
    return "";
  return fmt::format(
      "its picture is a crop, x {} to {}, y {} to {}, and the reference has more; copy it by hand if that is meant",
      has.min.x, has.max.x, has.min.y, has.max.y);
}

/// "", or why a picture may not be a reference.
std::string picture_problem(const Compared& c) {
  if (kind_of(c.from) != kind_of(c.to))
    return fmt::format("a {} file cannot stand in the place of a {} file", kind_of(c.from), kind_of(c.to));
  std::error_code failed;
  if (fs::equivalent(c.from, c.to, failed) && !failed) return "it is its own reference";
  const Result<PicturePlanes> picture = read_planes(c.from);
  if (!picture.ok()) return picture.error;
  std::string problem = c.request.limits.allow_nonfinite ? "" : nonfinite_problem(picture.value);
  // Of a reference that cannot be read there is nothing to lose.
  const Result<PicturePlanes> reference = read_planes(c.to);
  if (problem.empty() && reference.ok()) problem = channels_lost(picture.value, reference.value);
  if (problem.empty() && reference.ok()) problem = pixels_lost(picture.value, reference.value);
  return problem;
}

/// Names by the file that their references are, whatever links lead there.
std::map<std::string, std::vector<std::string>> by_file(const std::vector<Compared>& compared) {
  std::map<std::string, std::vector<std::string>> names;
  for (const Compared& c : compared) {
    std::error_code failed;
    names[fs::canonical(c.to, failed).string()].push_back(c.name);
  }
  return names;
}

std::string sharing_problem(const Compared& c, const std::map<std::string, std::vector<std::string>>& names) {
  std::error_code failed;
  const auto found = names.find(fs::canonical(c.to, failed).string());
  if (found == names.end()) return "";
  for (const std::string& other : found->second)
    if (other != c.name) return fmt::format("its reference is that of {}, too", other);
  return "";
}

/// What is to be done with a reference.
struct Step {
  const Compared* compared;
  std::string problem;  ///< Why it stays.
};

std::vector<Step> plan(const std::vector<Compared>& compared) {
  std::vector<Step> steps;
  for (const Compared& c : compared)
    if (!c.same) steps.push_back({&c, ""});
  const auto names = by_file(compared);
  tbb::parallel_for(size_t{0}, steps.size(), [&](size_t i) {
    steps[i].problem = sharing_problem(*steps[i].compared, names);
    if (steps[i].problem.empty()) steps[i].problem = picture_problem(*steps[i].compared);
  });
  return steps;
}

void print_line(std::FILE* out, const std::string& text) { fmt::print(out, "{}\n", printable(text)); }

void print_stays(std::FILE* out, const Step& step) {
  print_line(out, fmt::format("stays     {}: {}", step.compared->to, step.problem));
}

bool confirmed(size_t count) {
  fmt::print(stderr, "Replace {} reference{}? [y/N] ", count, count == 1 ? "" : "s");
  std::fflush(stderr);
  std::string answer;
  if (!std::getline(std::cin, answer)) fmt::print(stderr, "\n");
  return answer == "y" || answer == "Y" || answer == "yes" || answer == "Yes";
}

}  // namespace

std::string update_problem(bool yes) {
  if (yes || (isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0)) return "";
  return "--update asks before it replaces references, and there is no terminal; --yes replaces them without asking";
}

std::vector<std::string> update_references(const std::vector<Compared>& compared, bool yes, std::FILE* out) {
  std::vector<Step> steps = plan(compared);
  size_t count = 0;
  for (const Step& step : steps) {
    if (!step.problem.empty()) {
      print_stays(out, step);
      continue;
    }
    ++count;
    print_line(out, fmt::format("to update {}  from {}", step.compared->to, step.compared->from));
  }
  std::fflush(out);
  if (count == 0 || (!yes && !confirmed(count))) {
    print_line(out, "no reference was replaced");
    return {};
  }
  std::vector<std::string> replaced;
  for (Step& step : steps) {
    if (!step.problem.empty()) continue;
    step.problem = replace_with(step.compared->from, step.compared->to);
    if (!step.problem.empty()) {
      print_stays(out, step);
      continue;
    }
    print_line(out, fmt::format("replaced  {}", step.compared->to));
    replaced.push_back(step.compared->name);
  }
  return replaced;
}

}  // namespace whit
