// One hard case: the worst error seen over a sweep, its bound, and its row in docs/hard-cases.md.
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace whit::test {

/// Takes the errors a test sees, fails it when the worst is above the bound, and writes the row for the page
/// (tools/make-hard-cases) when $WHIT_HARD_ROWS names a folder.
class HardCase {
 public:
  /// What the page says of a case.
  struct Row {
    int number;         ///< Of the section of the page: 1 to 19.
    std::string what;   ///< What is tested, in a few words.
    std::string sweep;  ///< Over what, and how many.
    std::string error;  ///< What the error measures, with its unit.
    double bound;       ///< The largest error that passes.
    std::string pbrt;   ///< What pbrt-v3 is known to do; "" when nothing is.
  };

  explicit HardCase(Row row) : row_(std::move(row)) {}
  HardCase(const HardCase&) = delete;
  HardCase& operator=(const HardCase&) = delete;

  /// One error of the sweep; `at` says where. NaN is worse than anything.
  void see(double error, const std::string& at = {}) {
    ++seen_;
    if (!(error <= worst_)) worst_ = std::isnan(error) ? INFINITY : error, where_ = at;
  }

  ~HardCase() {
    EXPECT_GT(seen_, 0) << row_.what;
    EXPECT_LE(worst_, row_.bound) << row_.what << " at " << where_;
    if (const char* folder = std::getenv("WHIT_HARD_ROWS")) write(folder);
  }

 private:
  void write(const std::string& folder) const {
    std::filesystem::create_directories(folder);
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::ofstream out(folder + '/' + std::to_string(row_.number) + '-' + test + '-' + slug() + ".tsv");
    out << row_.number << '\t' << row_.what << '\t' << row_.sweep << '\t' << row_.error << '\t' << row_.bound << '\t'
        << worst_ << '\t' << row_.pbrt << '\n';
    EXPECT_TRUE(out.good()) << "cannot write a row to " << folder;
  }
  std::string slug() const {
    std::string s;
    for (const char c : row_.what) s += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
    return s;
  }

  Row row_;
  double worst_ = -1;
  int64_t seen_ = 0;
  std::string where_;
};

}  // namespace whit::test
