// What a page holds of one pair of pictures.
#pragma once

#include <string>
#include <vector>

#include "core/compare/comparison.h"
#include "core/compare/page_data.h"

namespace whit {

struct PageRow {
  Comparison comparison;
  std::string name;    ///< What both paths end with, else both names.
  double badness = 0;  ///< Of the comparison.
  PageSize size;
  Vec2i corner{0, 0};             ///< The pixel of the display window that is the first of the page's picture.
  bool display = false;           ///< The numbers are for a display.
  std::vector<PageLayer> layers;  ///< The one that is looked at first.
  std::string flip;               ///< FLIP's map; "" without one.
  std::string thumb_a, thumb_b, thumb_heat;
};

/// Of a pair that could not be read `pair` is null.
PageRow make_page_row(const Comparison& comparison, const PicturePair* pair);

/// "cornell/a.exr" of "out/cornell/a.exr" and "ref/cornell/a.exr"; "a.exr against b.exr" where they end differently.
std::string row_name(const std::string& a_path, const std::string& b_path);

/// verdict_text() without the word that the status says.
std::string row_reason(const PageRow& row);

/// All but thumbnails and data, as JSON for the page's script, safe between script tags.
std::string row_json(const PageRow& row, const std::string& id);

/// "same", "differs" or "cannot".
const char* row_status(const PageRow& row);

}  // namespace whit
