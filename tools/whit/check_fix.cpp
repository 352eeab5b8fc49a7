#include "tools/whit/check_fix.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "core/check/edit.h"
#include "core/image/replace_file.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// Whether the text of a source is that of the file of its name, as it is now; models have texts that are in no file.
bool is_of_file(const Sources& sources, uint32_t file) {
  std::ifstream in(sources.name(file), std::ios::binary);
  if (!in) return false;
  const std::string now{std::istreambuf_iterator<char>(in), {}};
  return now == sources.text(file);
}

/// The corrections of each file, in order; of two that overlap the first.
std::map<uint32_t, std::vector<Edit>> edits_of(const Sources& sources, const Diagnostics& found) {
  std::map<uint32_t, std::vector<Edit>> all;
  for (const Diagnostic& d : found.all()) {
    if (std::optional<Edit> edit = edit_of(sources, d)) all[edit->file].push_back(std::move(*edit));
  }
  for (auto& [file, edits] : all) {
    std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
    uint64_t free = 0;
    std::erase_if(edits, [&free](const Edit& e) {
      if (e.begin < free) return true;
      free = e.end;
      return false;
    });
  }
  return all;
}

}  // namespace

std::string fix_slips(const std::function<ParsedFile()>& read,
                      const std::function<Diagnostics(const ParsedFile&)>& check) {
  // Corrections that undo each other would go on for ever.
  constexpr int kMostRounds = 20;
  for (int round = 0; round < kMostRounds; ++round) {
    const ParsedFile file = read();
    const Sources& sources = *file.sources;
    bool changed = false;
    for (const auto& [number, edits] : edits_of(sources, check(file))) {
      if (!is_of_file(sources, number)) continue;
      const std::string_view text = sources.text(number);
      const std::string problem = replace_file(sources.name(number), edited(text, edits));
      if (!problem.empty()) return fmt::format("cannot correct {}: {}", sources.name(number), problem);
      changed = true;
      for (const Edit& e : edits)
        say(fmt::format("{}: corrected {} to {}", sources.location({number, e.begin}),
                        text.substr(e.begin, e.end - e.begin), e.text));
    }
    if (!changed) break;
  }
  return {};
}

}  // namespace whit
