// A comparison as a page that needs nothing else: one file, with a script, without a network.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/compare/comparison.h"
#include "core/compare/pair.h"

namespace whit {

struct PageRow;

/// Collects comparisons and makes one page of them: a row for each, the worst first, and a viewer that opens the two
/// pictures of a row. The numbers of the pictures are in the page as far as `budget` bytes of its text go: the beauty of
/// the worst first, other layers when all have theirs.
class ReportPage {
 public:
  explicit ReportPage(size_t budget = size_t{96} << 20);
  ~ReportPage();

  /// Takes what it needs from the pair, which may go afterwards; null for one that could not be read. From one thread at a
  /// time.
  void add(const Comparison& comparison, const PicturePair* pair);

  /// The page's text. `title` is what was compared.
  std::string html(const std::string& title) const;

 private:
  void keep_to_budget();

  size_t budget_, used_ = 0;
  std::vector<std::unique_ptr<PageRow>> rows_;
};

}  // namespace whit
