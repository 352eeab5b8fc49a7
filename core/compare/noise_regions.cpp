#include "core/compare/noise_regions.h"

#include <algorithm>
#include <map>

namespace whit {
namespace {

constexpr int kNone = -1;

// A field of cells with the block that marked each.
struct Marks {
  int across, down;
  std::vector<int> by;
  int& at(int x, int y) { return by[index(x, y)]; }
  int at(int x, int y) const { return by[index(x, y)]; }
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(across) + static_cast<size_t>(x);
  }
};

int64_t area(const Box2i& box) { return int64_t{box.max.x - box.min.x + 1} * (box.max.y - box.min.y + 1); }

template <class Of>
void for_cells(const Box2i& box, const Of& of) {
  for (int y = box.min.y; y <= box.max.y; ++y)
    for (int x = box.min.x; x <= box.max.x; ++x) of(x, y);
}

// The smallest blocks first; one that holds cells which a smaller one has marked says nothing new.
Marks mark(const std::vector<TestedBlock>& blocks, int across, int down) {
  Marks marks{across, down, std::vector<int>(static_cast<size_t>(across) * static_cast<size_t>(down), kNone)};
  int64_t size = 0;
  std::vector<std::pair<int, Box2i>> waiting;  // of one size, which do not hide each other
  const auto paint = [&] {
    for (const auto& one : waiting)
      for_cells(one.second, [&](int x, int y) {
        if (marks.at(x, y) == kNone) marks.at(x, y) = one.first;
      });
    waiting.clear();
  };
  for (size_t k = 0; k < blocks.size(); ++k) {
    if (area(blocks[k].cells) > size) paint();
    size = area(blocks[k].cells);
    bool said = false;
    for_cells(blocks[k].cells, [&](int x, int y) { said |= marks.at(x, y) != kNone; });
    if (!said) waiting.emplace_back(static_cast<int>(k), blocks[k].cells);
  }
  paint();
  return marks;
}

using Cells = std::vector<Vec2i>;

// Cells that touch, corners too; what was taken is no longer marked.
Cells take_component(Marks& left, Vec2i start) {
  Cells cells{start};
  left.at(start.x, start.y) = kNone;
  for (size_t next = 0; next < cells.size(); ++next) {
    const Vec2i c = cells[next];
    for (int y = std::max(0, c.y - 1); y <= std::min(left.down - 1, c.y + 1); ++y)
      for (int x = std::max(0, c.x - 1); x <= std::min(left.across - 1, c.x + 1); ++x) {
        if (left.at(x, y) == kNone) continue;
        left.at(x, y) = kNone;
        cells.emplace_back(x, y);
      }
  }
  return cells;
}

// The pixels of a cell, numbered in the pair's window.
template <class Of>
void for_pixels(const PicturePair& pair, Vec2i cell, const Of& of) {
  const int x1 = std::min(pair.width(), (cell.x + 1) * kNoiseCell),
            y1 = std::min(pair.height(), (cell.y + 1) * kNoiseCell);
  for (int y = cell.y * kNoiseCell; y < y1; ++y)
    for (int x = cell.x * kNoiseCell; x < x1; ++x)
      of(static_cast<size_t>(y) * static_cast<size_t>(pair.width()) + static_cast<size_t>(x));
}

// What covers at least a tenth of the cells, the most first, three at most.
std::vector<std::string> objects_of(const PicturePair& pair, const Cells& cells, const Matte& matte) {
  std::map<int, size_t> counts;
  size_t pixels = 0;
  for (const Vec2i& cell : cells)
    for_pixels(pair, cell, [&](size_t i) {
      ++pixels;
      if (matte.pixels[i] >= 0) ++counts[matte.pixels[i]];
    });
  std::vector<std::pair<size_t, int>> ranked;
  for (const auto& [number, count] : counts)
    if (10 * count >= pixels) ranked.emplace_back(count, number);
  std::sort(ranked.begin(), ranked.end(),
            [](auto& l, auto& r) { return l.first != r.first ? l.first > r.first : l.second < r.second; });
  std::vector<std::string> names;
  for (size_t k = 0; k < std::min<size_t>(3, ranked.size()); ++k)
    names.push_back(matte.names[static_cast<size_t>(ranked[k].second)]);
  return names;
}

NoiseRegion region_of(const PicturePair& pair, const std::vector<CellGrid>& grids,
                      const std::vector<std::string>& channels, const Cells& cells, const TestedBlock& least) {
  const CellGrid& grid = grids[least.channel];
  NoiseRegion region;
  Box2i box;
  BlockSums sums;
  for (const Vec2i& cell : cells) {
    box.extendBy(cell);
    sums += grid.cells[static_cast<size_t>(cell.y) * static_cast<size_t>(grid.across) + static_cast<size_t>(cell.x)];
  }
  const Vec2i last = (box.max + Vec2i(1, 1)) * kNoiseCell - Vec2i(1, 1);
  region.box = {pair.window.min + box.min * kNoiseCell,
                pair.window.min + Vec2i(std::min(last.x, pair.width() - 1), std::min(last.y, pair.height() - 1))};
  region.change = sums.difference / std::abs(sums.reference);
  region.channel = channels[least.channel];
  region.p = least.p;
  return region;
}

}  // namespace

std::vector<NoiseRegion> join_regions(const PicturePair& pair, const std::vector<CellGrid>& grids,
                                      const std::vector<std::string>& channels, std::vector<TestedBlock> blocks,
                                      const std::optional<Matte>& matte) {
  if (blocks.empty()) return {};
  std::stable_sort(blocks.begin(), blocks.end(), [](auto& l, auto& r) {
    return area(l.cells) != area(r.cells) ? area(l.cells) < area(r.cells) : l.p < r.p;
  });
  const Marks marks = mark(blocks, grids[0].across, grids[0].down);
  Marks left = marks;
  std::vector<NoiseRegion> regions;
  for (int y = 0; y < left.down; ++y)
    for (int x = 0; x < left.across; ++x) {
      if (left.at(x, y) == kNone) continue;
      const Cells cells = take_component(left, {x, y});
      const TestedBlock* least = nullptr;
      for (const Vec2i& c : cells) {
        const auto& block = blocks[static_cast<size_t>(marks.at(c.x, c.y))];
        if (!least || block.p < least->p) least = &block;
      }
      regions.push_back(region_of(pair, grids, channels, cells, *least));
      if (matte) regions.back().objects = objects_of(pair, cells, *matte);
    }
  std::stable_sort(regions.begin(), regions.end(), [](auto& l, auto& r) { return l.p < r.p; });
  return regions;
}

}  // namespace whit
