#include "tools/whit/check_fix.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/check/edit.h"
#include "core/image/replace_file.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// At most how often each file of a scene is read, which is more than once where it is included in several places: exact
/// where one file alone is.
std::vector<uint64_t> most_readings(const ParsedFile& file) {
  const Sources& sources = *file.sources;
  const auto count = static_cast<uint32_t>(sources.size());
  uint64_t once = 0;
  for (uint32_t i = 0; i < count; ++i)
    if (why_not_text(sources.text(i)).empty()) once += sources.text(i).size();
  const uint64_t more = file.bytes - std::min(file.bytes, once);
  std::vector<uint64_t> most;
  for (uint32_t i = 0; i < count; ++i) most.push_back(1 + more / std::max<uint64_t>(sources.text(i).size(), 1));
  return most;
}

/// The corrections of each file, in order; of two that overlap the first. In a file that is read several times, those
/// that were found each time.
std::map<uint32_t, std::vector<Edit>> edits_of(const ParsedFile& parsed, const Diagnostics& found) {
  const Sources& sources = *parsed.sources;
  const std::vector<uint64_t> readings = most_readings(parsed);
  using Place = std::tuple<uint32_t, uint64_t, uint64_t, std::string>;
  std::map<Place, uint64_t> counts;
  for (const Diagnostic& d : found.all()) {
    if (std::optional<Edit> edit = edit_of(sources, d)) ++counts[{edit->file, edit->begin, edit->end, edit->text}];
  }
  std::map<uint32_t, std::vector<Edit>> all;
  for (const auto& [place, count] : counts) {
    const auto& [file, begin, end, text] = place;
    if (count < readings[file]) continue;
    std::vector<Edit>& edits = all[file];
    if (edits.empty() || edits.back().end <= begin) edits.push_back({file, begin, end, text});
  }
  return all;
}

}  // namespace

std::vector<std::string> Fixer::fix(const std::function<ParsedFile(const Texts&)>& read,
                                    const std::function<Diagnostics(const ParsedFile&)>& check) {
  Texts texts;
  std::map<std::string, std::vector<std::string>> said;
  // Corrections that lead to each other in a ring would go on for ever.
  constexpr int kMostRounds = 20;
  bool changed = true;
  for (int round = 0; changed && round < kMostRounds; ++round) {
    changed = false;
    const ParsedFile file = read(texts);
    const Sources& sources = *file.sources;
    for (auto& [number, edits] : edits_of(file, check(file))) {
      const std::string& name = sources.name(number);
      const std::string_view text = sources.text(number);
      auto mine = std::find_if(texts.begin(), texts.end(), [&](const auto& t) { return t.first == name; });
      // Models have texts that are in no file, and a file may have changed since.
      if (mine == texts.end() && (!sources.problem(number).empty() || !holds_text(name, text))) continue;
      std::erase_if(edits, [&, n = number](const Edit& e) {
        const std::string written(text.substr(e.begin, e.end - e.begin));
        const uint64_t line = sources.place({n, e.begin}).line;
        if (done_.count({name, line, e.text, written}) > 0) return true;
        done_.insert({name, line, written, e.text});
        return false;
      });
      if (edits.empty()) continue;
      for (const Edit& e : edits)
        said[name].push_back(fmt::format("{}: corrected {} to {}", sources.location({number, e.begin}),
                                         text.substr(e.begin, e.end - e.begin), e.text));
      std::string corrected = edited(text, edits);
      if (mine == texts.end()) texts.emplace_back(name, std::move(corrected));
      else mine->second = std::move(corrected);
      changed = true;
    }
  }
  std::vector<std::string> problems;
  for (const auto& [path, text] : texts) {
    if (const std::string problem = replace_file(path, text); !problem.empty()) {
      problems.push_back(fmt::format("cannot correct {}: {}", path, problem));
    } else {
      for (const std::string& line : said[path]) say(line);
    }
  }
  return problems;
}

}  // namespace whit
