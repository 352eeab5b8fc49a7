#include "core/base/diagnostics.h"

#include <algorithm>

namespace whit {

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The cost of reading `a` where `b` was meant, in half letters: 2 a letter, 1 where only the case differs.
int substitution_cost(char a, char b) {
  if (a == b) return 0;
  return lower(a) == lower(b) ? 1 : 2;
}

/// Edit distance in half letters; two swapped neighbours count as one slip, the commonest typing error.
int edit_distance(const std::string& a, const std::string& b) {
  const size_t width = b.size() + 1;
  std::vector<int> before(width), previous(width), current(width);
  for (size_t j = 0; j < width; ++j) previous[j] = 2 * static_cast<int>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    current[0] = 2 * static_cast<int>(i);
    for (size_t j = 1; j < width; ++j) {
      const int change = previous[j - 1] + substitution_cost(a[i - 1], b[j - 1]);
      current[j] = std::min({change, previous[j] + 2, current[j - 1] + 2});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        current[j] = std::min(current[j], before[j - 2] + 2);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

bool differs_in_case_alone(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

/// nearest_name(); `tie`: another candidate is as near.
std::string nearest_of(const std::string& name, const std::vector<std::string>& candidates, bool& tie) {
  tie = false;
  // A longer "name" is no slip of the pen, and the cost grows with the product of the lengths.
  constexpr size_t kLongest = 64;
  if (name.empty() || name.size() > kLongest) return {};
  std::string best;
  int best_distance = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.empty() || candidate.size() > kLongest) continue;
    const int distance = edit_distance(name, candidate);
    const int letters = static_cast<int>(std::max(name.size(), candidate.size()));
    if (3 * distance > 2 * letters && !differs_in_case_alone(name, candidate)) continue;
    if (best.empty() || distance < best_distance) {
      best = candidate;
      best_distance = distance;
      tie = false;
    } else if (distance == best_distance && candidate != best) {
      tie = true;
    }
  }
  return best;
}

}  // namespace

bool Diagnostics::has_errors() const {
  return std::any_of(all_.begin(), all_.end(), [](const Diagnostic& d) { return d.severity == Severity::Error; });
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& candidates) {
  bool tie = false;
  return nearest_of(name, candidates, tie);
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(name, candidates);
  return nearest.empty() ? std::string() : "did you mean \"" + nearest + "\"?";
}

Remedy suggestion(const std::string& name, const std::vector<std::string>& candidates) {
  bool tie = false;
  const std::string nearest = nearest_of(name, candidates, tie);
  if (nearest.empty()) return {};
  return {"did you mean \"" + nearest + "\"?", tie ? Slip{} : Slip{name, nearest}};
}

}  // namespace whit
