#include "core/base/limits.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

namespace whit {
namespace {

/// 1234567 as 1,234,567.
std::string with_commas(uint64_t n) {
  std::string text;
  const std::string digits = std::to_string(n);
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text.push_back(',');
    text.push_back(digits[i]);
  }
  return text;
}

TEST(Limits, ThePageHasARowForEach) {
  std::ifstream in(WHIT_SOURCE_DIR "/docs/limits.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  std::set<std::string> names;
  for (const Limit& limit : kLimits) {
    const std::string row = "\n| `" + std::string(limit.name) + "` | " + with_commas(limit.most) + " | ";
    EXPECT_NE(page.find(row), page.npos) << row;
    EXPECT_TRUE(names.insert(limit.name).second) << limit.name;
  }
}

}  // namespace
}  // namespace whit
