#include "core/compare/policy.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/base/plain_text.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// The length of the UTF-8 character that begins at text[at]; of a byte that begins none, 1.
size_t character_length(const std::string& text, size_t at) {
  size_t length = 1;
  if (static_cast<unsigned char>(text[at]) < 0xc0) return length;
  while (at + length < text.size() && (static_cast<unsigned char>(text[at + length]) & 0xc0) == 0x80) ++length;
  return length;
}

/// A file's path without links to folders; the file itself may be one.
fs::path real_path_of(const std::string& file) {
  std::error_code failed;
  const fs::path whole = fs::absolute(file, failed);
  return fs::weakly_canonical(whole.parent_path(), failed) / whole.filename();
}

/// A reference's name relative to the policy's folder; "" where it is not below it.
std::string name_below(const std::string& policy, const std::string& reference) {
  std::error_code failed;
  const fs::path folder = fs::weakly_canonical(fs::absolute(policy, failed), failed).parent_path();
  const fs::path relative = real_path_of(reference).lexically_relative(folder);
  return relative.empty() || relative == "." || *relative.begin() == ".." ? "" : relative.generic_string();
}

/// True when a pattern is for the last parts of a path, how many ever.
bool matches_end_of(const std::string& pattern, const std::string& path) {
  for (size_t at = 0; at < path.size() && at != path.npos; at = path.find('/', at)) {
    if (path[at] == '/') ++at;
    if (matches_path(pattern, path.substr(at))) return true;
  }
  return false;
}

}  // namespace

bool matches_path(const std::string& pattern, const std::string& name) {
  // reached[i]: the pattern so far matches the first i bytes of the name.
  std::vector<char> reached(name.size() + 1, 0);
  reached[0] = 1;
  for (size_t p = 0; p < pattern.size();) {
    std::vector<char> next(name.size() + 1, 0);
    const bool anything = pattern.compare(p, 2, "**") == 0;
    const bool folders = pattern.compare(p, 3, "**/") == 0 && (p == 0 || pattern[p - 1] == '/');
    bool open = false;  // something that goes on has begun
    for (size_t i = 0; i <= name.size(); ++i) {
      if (folders) {
        if (reached[i] || (open && name[i - 1] == '/')) next[i] = 1;
        open = open || reached[i];
      } else if (pattern[p] == '*') {
        if (!anything && i > 0 && name[i - 1] == '/') open = false;
        open = open || reached[i];
        if (open) next[i] = 1;
      } else if (reached[i] && i < name.size()) {
        const size_t length = pattern[p] == '?' ? character_length(name, i) : 1;
        if (pattern[p] == '?' ? name[i] != '/' : name[i] == pattern[p]) next[i + length] = 1;
      }
    }
    reached.swap(next);
    p += folders ? 3 : anything ? 2 : 1;
  }
  return reached[name.size()] != 0;
}

CompareSettings Policy::settings_for(const std::string& name) const {
  CompareSettings settings;
  for (const PolicyRule& rule : rules)
    if (matches_path(rule.match, name)) settings.lay(rule.says);
  return settings;
}

std::string Policy::name_of(const std::string& reference) const {
  const std::string relative = name_below(path, reference);
  return relative.empty() ? fs::path(reference).filename().string() : relative;
}

std::vector<std::string> Policy::missed(const std::string& reference) const {
  const std::string name = name_of(reference), whole = real_path_of(reference).generic_string();
  std::vector<std::string> out;
  bool any = rules.empty();
  for (const PolicyRule& rule : rules) {
    if (matches_path(rule.match, name)) any = true;
    else if (matches_end_of(rule.match, whole))
      out.push_back(fmt::format(
          "{}: {}/match: {} is not for this picture, whose name is {}; names are relative to the folder of the policy "
          "where the reference is below it, else the file's alone",
          path, rule.place, quoted_name(rule.match), quoted_name(name)));
  }
  if (!any && out.empty() && name_below(path, reference).empty())
    out.push_back(
        fmt::format("{}: no rule is for {}, which is this picture's name as it is not below the policy's folder", path,
                    quoted_name(name)));
  return out;
}

std::vector<std::string> Policy::unmatched(const std::vector<std::string>& names) const {
  const auto used = [&](const std::string& pattern) {
    return std::any_of(names.begin(), names.end(), [&](const std::string& n) { return matches_path(pattern, n); });
  };
  std::vector<std::string> out;
  for (const PolicyRule& rule : rules) {
    if (used(rule.match)) continue;
    const std::string deeper = "**/" + rule.match;
    out.push_back(fmt::format("{}: {}/match: no picture matches {}{}", path, rule.place, quoted_name(rule.match),
                              used(deeper) ? fmt::format("; did you mean {}?", quoted_name(deeper)) : ""));
  }
  return out;
}

}  // namespace whit
