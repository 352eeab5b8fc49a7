#include "core/compare/channels.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/base/plain_text.h"

namespace whit {
namespace {

std::string last_part(const std::string& name) { return name.substr(name.rfind('.') + 1); }

bool is_one_of(const std::string& text, std::initializer_list<const char*> all) {
  return std::any_of(all.begin(), all.end(), [&](const char* one) { return text == one; });
}

}  // namespace

ChannelKind channel_kind(const std::string& name) {
  const std::string last = last_part(name), whole = lower_case(name);
  if (lower_case(last_part(layer_of(name))) == "variance" || is_one_of(whole, {"samples", "samplecount"}))
    return ChannelKind::Statistic;
  if (is_matte(name) || lower_case(last) == "id") return ChannelKind::Id;
  if (is_one_of(last, {"R", "G", "B", "r", "g", "b"})) return ChannelKind::Colour;
  // The luminance of a grey picture; of a layer it is a coordinate.
  return name == "Y" ? ChannelKind::Colour : ChannelKind::Data;
}

std::string layer_of(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

bool is_matte(const std::string& channel) {
  const std::string layer = lower_case(last_part(layer_of(channel)));
  const auto digit = [&](size_t from_end) {
    return std::isdigit(static_cast<unsigned char>(layer[layer.size() - from_end]));
  };
  return layer.rfind("crypto", 0) == 0 && layer.size() > 8 && digit(1) && digit(2);
}

bool is_first_matte_rank(const std::string& channel) {
  if (!is_matte(channel) || !is_one_of(lower_case(last_part(channel)), {"r", "red"})) return false;
  const std::string layer = layer_of(channel);
  return layer.compare(layer.size() - 2, 2, "00") == 0;
}

bool is_depth(const std::string& channel, const std::vector<std::string>& all) {
  const std::string layer = layer_of(channel), last = lower_case(last_part(channel));
  if (last == "depth" || lower_case(last_part(layer)) == "depth") return true;
  if (last != "z") return false;
  const std::string x = layer.empty() ? "X" : layer + ".X";
  return std::find(all.begin(), all.end(), x) == all.end();
}

bool is_fault(const std::string& channel, const std::vector<std::string>& all, float value) {
  if (std::isfinite(value)) return false;
  const bool may_be_infinite = channel_kind(channel) == ChannelKind::Statistic || is_depth(channel, all);
  return !(may_be_infinite && value > 0);
}

// Where a star has taken too little, it takes one more; only the last star is ever tried again.
bool matches(const std::string& pattern, const std::string& text) {
  size_t p = 0, t = 0, star = std::string::npos, taken = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      taken = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p, ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

std::vector<std::string> split_patterns(const std::string& patterns) {
  std::vector<std::string> all;
  for (size_t at = 0; at <= patterns.size();) {
    const size_t comma = std::min(patterns.find(',', at), patterns.size());
    const size_t first = patterns.find_first_not_of(' ', at);
    if (first < comma) {
      const size_t last = patterns.find_last_not_of(' ', comma - 1);
      all.push_back(patterns.substr(first, last - first + 1));
    }
    at = comma + 1;
  }
  return all;
}

bool matches_any(const std::string& patterns, const std::string& text) {
  bool chosen = false, any_positive = false;
  for (const std::string& pattern : split_patterns(patterns)) {
    if (pattern[0] == '!') {
      if (matches(pattern.substr(1), text)) return false;
    } else {
      any_positive = true;
      chosen |= matches(pattern, text);
    }
  }
  return chosen || !any_positive;
}

}  // namespace whit
