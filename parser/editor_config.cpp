#include "parser/editor_config.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/limits.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

using Values = std::map<std::string, std::string>;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n\v\f";
  const size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::optional<int64_t> number_in(std::string_view text) {
  int64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool match(std::string_view glob, std::string_view path);

/// The byte behind the } that closes the brace at 0, or npos; `commas` takes those between.
size_t closing_brace(std::string_view glob, std::vector<size_t>& commas) {
  int depth = 0;
  for (size_t i = 0; i < glob.size(); ++i) {
    if (glob[i] == '\\') ++i;
    else if (glob[i] == '{') ++depth;
    else if (glob[i] == ',' && depth == 1) commas.push_back(i);
    else if (glob[i] == '}' && --depth == 0) return i;
  }
  return std::string_view::npos;
}

/// A glob that begins with a brace: one of several, or a number between two.
bool match_brace(std::string_view glob, std::string_view path) {
  std::vector<size_t> commas;
  const size_t close = closing_brace(glob, commas);
  if (close == std::string_view::npos) return !path.empty() && path[0] == '{' && match(glob.substr(1), path.substr(1));
  const std::string_view inside = glob.substr(1, close - 1), rest = glob.substr(close + 1);
  if (commas.empty()) {
    const size_t dots = inside.find("..");
    const auto low = number_in(inside.substr(0, dots)),
               high = dots == inside.npos ? low : number_in(inside.substr(dots + 2));
    if (dots == std::string_view::npos || !low || !high) return match("\\{" + std::string(glob.substr(1)), path);
    for (size_t n = 1; n <= path.size(); ++n) {
      const auto value = number_in(path.substr(0, n));
      if (value && *value >= std::min(*low, *high) && *value <= std::max(*low, *high) && match(rest, path.substr(n)))
        return true;
    }
    return false;
  }
  commas.push_back(close);
  size_t first = 1;
  for (const size_t comma : commas) {
    if (match(std::string(glob.substr(first, comma - first)) + std::string(rest), path)) return true;
    first = comma + 1;
  }
  return false;
}

/// A glob that begins with a bracket: one of some characters, or none of them.
bool match_bracket(std::string_view glob, std::string_view path) {
  const size_t close = glob.find(']', 2);
  if (close == std::string_view::npos) return !path.empty() && path[0] == '[' && match(glob.substr(1), path.substr(1));
  if (path.empty() || path[0] == '/') return false;
  std::string_view set = glob.substr(1, close - 1);
  const bool none = set.starts_with('!');
  if (none) set.remove_prefix(1);
  bool in = false;
  for (size_t i = 0; i < set.size(); ++i) {
    if (i + 2 < set.size() && set[i + 1] == '-') {
      in = in || (path[0] >= set[i] && path[0] <= set[i + 2]);
      i += 2;
    } else {
      in = in || path[0] == set[i];
    }
  }
  return in != none && match(glob.substr(close + 1), path.substr(1));
}

bool match(std::string_view glob, std::string_view path) {
  if (glob.empty()) return path.empty();
  switch (glob[0]) {
    case '*': {
      const bool any = glob.starts_with("**");
      const std::string_view rest = glob.substr(any ? 2 : 1);
      // "**/" is also no folder at all.
      if (any && rest.starts_with('/') && match(rest.substr(1), path)) return true;
      for (size_t n = 0; n <= path.size(); ++n) {
        if (match(rest, path.substr(n))) return true;
        if (n < path.size() && path[n] == '/' && !any) return false;
      }
      return false;
    }
    case '?': return !path.empty() && path[0] != '/' && match(glob.substr(1), path.substr(1));
    case '[': return match_bracket(glob, path);
    case '{': return match_brace(glob, path);
    case '\\':
      if (glob.size() > 1) glob.remove_prefix(1);
      break;
    default: break;
  }
  return !path.empty() && path[0] == glob[0] && match(glob.substr(1), path.substr(1));
}

/// Lays what a .editorconfig file says of a path over `values`. Returns whether it is the root.
bool read_config(const fs::path& config, const std::string& path, Values& values) {
  // Where somebody has something else of that name, not all of it is read.
  constexpr size_t kMostLines = 10000, kLongest = 4096, kMostBytes = size_t{1} << 20;
  if (!why_unreadable(config.string()).empty()) return false;
  std::string head(kMostBytes, '\0');
  std::ifstream in(config, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(in.gcount()));
  std::istringstream file(std::move(head));
  bool root = false, in_section = false, any_section = false;
  std::string line;
  for (size_t n = 0; n < kMostLines && std::getline(file, line); ++n) {
    std::string_view text = trimmed(line);
    if (n == 0 && text.starts_with("\xef\xbb\xbf")) text = trimmed(text.substr(3));
    if (text.empty() || text[0] == '#' || text[0] == ';' || text.size() > kLongest) continue;
    if (text[0] == '[' && text.back() == ']') {
      any_section = true;
      in_section = matches_glob(text.substr(1, text.size() - 2), path);
      continue;
    }
    const size_t equals = text.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string key = lower(trimmed(text.substr(0, equals))), value = lower(trimmed(text.substr(equals + 1)));
    if (!any_section && key == "root") root = value == "true";
    if (in_section) values[key] = value;
  }
  return root;
}

}  // namespace

bool matches_glob(std::string_view glob, std::string_view path) {
  if (glob.starts_with('/')) return match(glob.substr(1), path);
  if (glob.find('/') != std::string_view::npos) return match(glob, path);
  return match(glob, path.substr(path.rfind('/') + 1));
}

std::string EditorConfig::line_ends(const std::string& text) const {
  if (!crlf) return text;
  std::string out;
  for (const char c : text) {
    if (c == '\n') out += '\r';
    out += c;
  }
  return out;
}

EditorConfig read_editor_config(const std::string& path) {
  std::error_code failed;
  const fs::path file = fs::absolute(path, failed).lexically_normal();
  if (failed) return {};
  std::vector<Values> said;  // The nearest file's first.
  for (fs::path folder = file.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    Values values;
    const bool root = read_config(folder / ".editorconfig", file.lexically_relative(folder).generic_string(), values);
    said.push_back(std::move(values));
    if (root || folder == folder.parent_path()) break;
  }
  Values all;
  for (Values& values : said) all.merge(values);

  const auto value = [&all](const char* key) {
    const auto found = all.find(key);
    return found == all.end() || found->second == "unset" ? std::string() : found->second;
  };
  EditorConfig out;
  out.crlf = value("end_of_line") == "crlf";
  constexpr int64_t kMost = 64;
  const std::string size = value("indent_size") == "tab" ? value("tab_width") : value("indent_size");
  if (value("indent_style") == "tab") {
    out.indent.assign(1, '\t');
  } else if (const auto spaces = number_in(size); spaces && *spaces >= 0 && *spaces <= kMost) {
    out.indent = std::string(static_cast<size_t>(*spaces), ' ');
  }
  return out;
}

}  // namespace whit
