// The table of a page, which is there before any script has run.
#pragma once

#include <string>
#include <vector>

#include "core/compare/page_row.h"

namespace whit {

/// How many differ, are the same and cannot be compared, as buttons that choose rows.
std::string counts_html(const std::vector<const PageRow*>& rows);

/// A row for each picture: how it went, thumbnails, the measures that have limits.
std::string table_html(const std::vector<const PageRow*>& rows);

}  // namespace whit
