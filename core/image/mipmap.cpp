// Building the pyramid; mipmap_lookup.cpp filters.
//
// A picture comes in row by row, and a level makes a row of two rows of the finer one. So of levels that are not kept there are
// a few rows in memory, and of the picture what the reader holds, with a few more where its sides are no powers of two.
#include "core/image/mipmap.h"

#ifdef __F16C__
#include <immintrin.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "core/image/picture_rows.h"
#include "core/image/scratch_file.h"

namespace whit {
namespace {

// Whether texels are one of the picture's numbers.
bool is_one_channel(const ImageInfo& image, const MipMapOptions& options) {
  return (options.single && options.alpha) || image.rgb_channels()[0] == image.rgb_channels()[1];
}

int channels_of(const ImageInfo& image, const MipMapOptions& options) {
  return options.single || is_one_channel(image, options) ? 1 : 3;
}

TexelRows::Take taken(const MipMapOptions& options) {
  if (!options.single) return TexelRows::Take::Rgb;
  return options.alpha ? TexelRows::Take::Alpha : TexelRows::Take::Luminance;
}

bool sides_are_powers_of_two(const ImageInfo& image) {
  return is_power_of_two(image.width) && is_power_of_two(image.height);
}

// Whether level 0 can be the file's bytes: nothing is computed of them but one value each.
bool keeps_bytes(const ImageInfo& image, const MipMapOptions& options) {
  return image.format == SampleFormat::UInt8 && options.scale >= 0 &&
         (is_one_channel(image, options) || !options.single) && sides_are_powers_of_two(image);
}

// Whether values are stored without their scale, so that no scale can drive them out of range of halves. A negative one
// meets the clamp of the enlargement, so there the scale has to come first.
bool scales_last(const ImageInfo& image, const MipMapOptions& options) {
  return image.format != SampleFormat::Float && options.scale >= 0;
}

bool fit_halves(const float* values, size_t n) {
  return std::all_of(values, values + n, [](float v) { return std::abs(v) <= 65504.0f; });
}

void to_halves(const float* from, size_t n, Imath::half* to) {
  size_t i = 0;
#ifdef __F16C__
  for (; i + 8 <= n; i += 8)
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to + i), _mm256_cvtps_ph(_mm256_loadu_ps(from + i), 0));
#endif
  for (; i < n; ++i) to[i] = Imath::half(from[i]);
}

// A row of the coarser level: each texel the mean of four. `sums` has room for a row of the finer one.
void halve_rows(const float* upper, const float* lower, int width, int channels, WrapMode wrap, float* sums,
                float* out) {
  const size_t c = static_cast<size_t>(channels), n = c * static_cast<size_t>(width);
  if (width > 1 && lower) {
    // All sums of neighbours, of which every second is wanted: arithmetic that vectorises, for three channels too.
    for (size_t i = 0; i < n - c; ++i) sums[i] = 0.25f * (upper[i] + upper[i + c] + lower[i] + lower[i + c]);
  } else {
    // A side that is 1 already takes texel 1 from outside: the same texel again when the texture repeats or clamps, nothing
    // when it is black there (as in pbrt-v3).
    const size_t right = width > 1 ? c : 0;
    const bool has_right = right > 0 || wrap_along_s(wrap) != WrapMode::Black;
    for (size_t i = 0; i < std::max(n - c, c); ++i) {
      float sum = upper[i];
      if (has_right) sum += upper[i + right];
      if (lower) sum += lower[i];
      if (lower && has_right) sum += lower[i + right];
      sums[i] = 0.25f * sum;
    }
  }
  const size_t count = static_cast<size_t>(std::max(1, width / 2));
  if (c == 1) {
    for (size_t s = 0; s < count; ++s) out[s] = sums[2 * s];
  } else {
    for (size_t s = 0; s < count; ++s) std::copy_n(sums + 6 * s, 3, out + 3 * s);
  }
}

// For lookups that are only asked which level they need.
constexpr float kNoTexel[3] = {};

// Rows of texels of a picture that comes in, those that enlarging it still wants: the latest, and the first, which a texture
// that repeats has behind the last.
class ArrivingRows {
 public:
  static constexpr int kFirst = 16, kLatest = 8;

  // `next(to)` puts the next row of so many numbers to `to`.
  ArrivingRows(size_t numbers, std::function<void(float* to)> next) : next_(std::move(next)) {
    for (std::vector<float>& row : first_) row.resize(numbers);
    for (std::vector<float>& row : latest_) row.resize(numbers);
  }

  const std::vector<float>& row(int y) {
    for (; arrived_ <= y; ++arrived_) next_(place(arrived_).data());
    return place(y);
  }

 private:
  std::vector<float>& place(int y) {
    return y < kFirst ? first_[static_cast<size_t>(y)] : latest_[static_cast<size_t>(y % kLatest)];
  }

  std::function<void(float* to)> next_;
  std::array<std::vector<float>, kFirst> first_;
  std::array<std::vector<float>, kLatest> latest_;
  int arrived_ = 0;
};

// Rows of a picture in memory.
template <class Number>
class ArrayRows : public PictureRows {
 public:
  explicit ArrayRows(const PixelArray<Number>& image) : image_(image) { info = image; }
  const uint8_t* next_bytes() override { return next<uint8_t>(); }
  const float* next_floats() override { return next<float>(); }
  size_t memory() const override { return 0; }

 private:
  template <class N>
  const N* next() {
    if constexpr (std::is_same_v<N, Number>) return image_.pixel(0, row_++);
    else throw std::logic_error("the picture has other numbers");
  }
  const PixelArray<Number>& image_;
  int row_ = 0;
};

}  // namespace

// Fills levels of an outline.
class MipMap::Builder {
 public:
  Builder(MipMap& map, const ImageInfo& image, const MipMapOptions& options, int first,
          std::shared_ptr<const TexelBlock> room = nullptr)
      : map_(map),
        image_(image),
        options_(options),
        texels_(image, taken(options), options.gamma, scales_last(image, options) ? 1 : options.scale),
        below_(map.levels_.size()) {
    map.first_ = first;
    map.in_file_ = std::move(room);
    size_t at = 0;
    for (int i = first; i < map.level_count(); ++i) {
      map.levels_[i] = map.in_file_ ? map.level_in(map.in_file_, i, at) : allocate(i);
      at += ScratchFile::room_for(map.bytes_of(i));
    }
    row_.resize(numbers(0));
    sums_.resize(numbers(0));
    for (size_t i = 1; i < below_.size(); ++i) below_[i].row.resize(numbers(static_cast<int>(i)));
  }

  void read(PictureRows& rows) {
    flips_ = options_.flip != rows.bottom_first;
    if (!sides_are_powers_of_two(image_)) return read_and_enlarge(rows);
    for (int y = 0; y < image_.height; ++y) {
      const int t = flipped(y);
      if (image_.format != SampleFormat::UInt8) {
        texels_.convert(rows.next_floats(), row_.data());
        add_finest(t);
      } else {
        add_bytes(t, rows.next_bytes());
      }
    }
  }

 private:
  // What is needed to make rows of a level: the rows of the finer one of which only one of two has come in.
  struct Waiting {
    int t = -1;  // Its number; -1 for none.
    std::vector<float> row;
  };
  struct Below {
    std::vector<float> row;
    std::array<Waiting, 2> waiting;
  };

  // From the number of a row that comes in to that of a texel's, and back.
  int flipped(int y) const { return flips_ ? image_.height - 1 - y : y; }

  size_t numbers(int level) const { return static_cast<size_t>(map_.width(level)) * map_.channels_; }

  std::shared_ptr<const Level> allocate(int i) {
    auto level = std::make_shared<Level>();
    level->width = map_.width(i);
    level->height = map_.height(i);
    level->storage = map_.storage(i);
    level->memory = std::make_shared<TexelBlock>(map_.bytes_of(i));
    level->texels = level->memory->as<void>();
    return level;
  }

  // Of what has been written to a file so much is in memory.
  void note_written(size_t bytes) {
    constexpr size_t kMost = size_t{16} << 20;
    if (!map_.in_file_ || (written_ += bytes) < kMost) return;
    map_.in_file_->give_back();
    written_ = 0;
  }

  // Where row t of a level goes: only the builder writes to it.
  template <class T>
  T* row_of(int i, int t) {
    return static_cast<T*>(const_cast<void*>(map_.levels_[i]->texels)) + numbers(i) * t;
  }

  void add_bytes(int t, const uint8_t* pixels) {
    if (map_.storage(0) != Storage::Bytes) {
      texels_.convert(pixels, row_.data());
      return add_finest(t);
    }
    if (map_.first_ == 0) texels_.pick(pixels, row_of<uint8_t>(0, t)), note_written(numbers(0));
    if (map_.level_count() == 1) return;
    texels_.convert(pixels, row_.data());
    descend(0, t, row_.data());
  }

  // row_, of level 0, its texels still without the scale if that comes last.
  void add_finest(int t) {
    if (map_.storage(0) == Storage::Halves) {
      if (image_.format == SampleFormat::Half && !fit_halves(row_.data(), row_.size())) throw ExceedsHalves();
    } else if (scales_last(image_, options_)) {
      for (float& v : row_) v *= options_.scale;
    }
    add(0, t, row_.data());
  }

  void add(int i, int t, const float* row) {
    if (i >= map_.first_) {
      if (map_.storage(i) == Storage::Halves) to_halves(row, numbers(i), row_of<Imath::half>(i, t));
      else std::copy_n(row, numbers(i), row_of<float>(i, t));
      note_written(sizeof(float) * numbers(i));
    }
    if (i + 1 < map_.level_count()) descend(i, t, row);
  }

  // Row t of level i and the one that it makes a row of the next level with, when both are there. They come in order or in
  // reverse order, but for the first few, which may come last: so two wait at most.
  void descend(int i, int t, const float* row) {
    Below& next = below_[i + 1];
    const float *upper = row, *lower = wrap_along_t(map_.wrap_) == WrapMode::Black ? nullptr : row;
    if (map_.height(i) > 1) {
      const auto waiting = [&](int number) {
        return std::find_if(next.waiting.begin(), next.waiting.end(), [&](const Waiting& w) { return w.t == number; });
      };
      const auto other = waiting(t ^ 1);
      if (other == next.waiting.end()) {
        Waiting& place = *waiting(-1);
        place.t = t;
        return place.row.assign(row, row + numbers(i));
      }
      other->t = -1;
      upper = t % 2 == 0 ? row : other->row.data();
      lower = t % 2 == 0 ? other->row.data() : row;
    }
    halve_rows(upper, lower, map_.width(i), map_.channels_, map_.wrap_, sums_.data(), next.row.data());
    add(i + 1, t / 2, next.row.data());
  }

  // Where the texture repeats, the first rows are made of the picture's last too, and are made last.
  void read_and_enlarge(PictureRows& rows) {
    const bool bytes = image_.format == SampleFormat::UInt8;
    const size_t row = static_cast<size_t>(image_.width) * map_.channels_;
    ArrivingRows arriving(row, [&](float* to) {
      if (bytes) texels_.convert(rows.next_bytes(), to);
      else texels_.convert(rows.next_floats(), to);
    });
    EnlargedRows enlarged(image_.width, image_.height, map_.channels_, map_.wrap_,
                          [&](int t, float* to) { std::copy_n(arriving.row(flipped(t)).data(), row, to); });
    const int height = map_.height();
    const auto make = [&](int t) {
      enlarged.make(t, row_.data());
      add_finest(t);
    };
    const auto wants_last = [&](int t) {
      const auto is_last = [&](int small) {
        return small >= 0 && flipped(small) >= image_.height - EnlargedRows::kTaps;
      };
      const auto& small = enlarged.rows_of(t);
      return std::any_of(small.begin(), small.end(), is_last);
    };
    std::vector<int> late;
    for (int y = 0; y < height; ++y) {
      const int t = flips_ ? height - 1 - y : y;
      // All of a picture of few rows are there.
      if (image_.height > ArrivingRows::kFirst && y < height / 2 && wants_last(t)) late.push_back(t);
      else make(t);
    }
    // The picture is read to its end, which tells whether it is whole.
    arriving.row(image_.height - 1);
    for (const int t : late) make(t);
  }

  MipMap& map_;
  const ImageInfo& image_;
  const MipMapOptions& options_;
  TexelRows texels_;
  bool flips_ = false;
  std::vector<float> row_, sums_;
  std::vector<Below> below_;
  size_t written_ = 0;  // to a file, since memory was given back
};

MipMap::MipMap(const ImageInfo& image, const MipMapOptions& options)
    : channels_(channels_of(image, options)), wrap_(options.wrap) {
  finest_storage_ = keeps_bytes(image, options) ? Storage::Bytes : Storage::Halves;
  coarse_storage_ = Storage::Halves;
  if (!scales_last(image, options) || options.floats) finest_storage_ = coarse_storage_ = Storage::Floats;
  gain_ = coarse_storage_ == Storage::Halves ? options.scale : 1;
  if (finest_storage_ == Storage::Bytes) {
    byte_values_ = byte_values(options.gamma);
    for (float& v : byte_values_) v *= options.scale;
  }
  auto width = std::bit_ceil(static_cast<unsigned>(image.width)),
       height = std::bit_ceil(static_cast<unsigned>(image.height));
  for (;; width = std::max(1u, width / 2), height = std::max(1u, height / 2)) {
    const auto level = std::make_shared<Level>();
    levels_.push_back(level);
    level->width = static_cast<int>(width);
    level->height = static_cast<int>(height);
    if (width > 1 || height > 1) continue;
    level->texels = kNoTexel;
    break;
  }
  first_ = level_count();
}

MipMap::MipMap(PictureRows& rows, const MipMapOptions& options, int first, std::shared_ptr<const TexelBlock> room)
    : MipMap(rows.info, options) {
  Builder(*this, rows.info, options, first, std::move(room)).read(rows);
}

MipMap::MipMap(const Image& image, const MipMapOptions& options)
    : MipMap(static_cast<const ImageInfo&>(image), options) {
  ArrayRows rows(image);
  Builder(*this, image, options, 0).read(rows);
}

MipMap::MipMap(const ByteImage& image, const MipMapOptions& options)
    : MipMap(static_cast<const ImageInfo&>(image), options) {
  ArrayRows rows(image);
  Builder(*this, image, options, 0).read(rows);
}

MipMap::MipMap(const MipMap& whole, int first) : MipMap(whole) {
  for (int i = first_; i < first; ++i) {
    const auto gone = std::make_shared<Level>();
    gone->width = width(i);
    gone->height = height(i);
    levels_[i] = gone;
  }
  first_ = first;
}

size_t MipMap::bytes_of(int level) const {
  const size_t n = static_cast<size_t>(width(level)) * height(level) * channels_;
  switch (storage(level)) {
    case Storage::Bytes: return n;
    case Storage::Halves: return n * sizeof(Imath::half);
    default: return n * sizeof(float);
  }
}

size_t MipMap::bytes_to_build(const PictureRows& rows, const MipMapOptions& options, int first) {
  const MipMap outline(rows.info, options);
  size_t sum = rows.memory() + bytes_to_read(rows.info, options);
  for (int i = first; i < outline.level_count(); ++i) sum += outline.bytes_of(i);
  return sum;
}

size_t MipMap::bytes_to_read(const ImageInfo& image, const MipMapOptions& options) {
  const size_t row = sizeof(float) * channels_of(image, options);
  const size_t strips = row * 12 * std::bit_ceil(static_cast<unsigned>(image.width));
  if (sides_are_powers_of_two(image)) return strips;
  return strips + row * (ArrivingRows::kFirst + ArrivingRows::kLatest) * static_cast<size_t>(image.width);
}

size_t MipMap::bytes_of_levels(const ImageInfo& image, const MipMapOptions& options, int first) {
  const MipMap outline(image, options);
  size_t sum = 0;
  for (int i = first; i < outline.level_count(); ++i) sum += ScratchFile::room_for(outline.bytes_of(i));
  return sum;
}

// A level as it is in a part of a file, from a byte on.
std::shared_ptr<const MipMap::Level> MipMap::level_in(const std::shared_ptr<const TexelBlock>& room, int i,
                                                      size_t at) const {
  const auto level = std::make_shared<Level>(*levels_[i]);
  level->storage = storage(i);
  level->memory = room;
  level->texels = room->as<void>(at);
  return level;
}

size_t MipMap::bytes() const {
  size_t sum = 0;
  for (int i = first_; i < level_count(); ++i) sum += bytes_of(i);
  return sum;
}

std::unique_ptr<const MipMap> MipMap::in_file(ScratchFile& file) const {
  std::vector<std::span<const std::byte>> pieces;
  for (int i = first_; i < level_count(); ++i)
    pieces.push_back({static_cast<const std::byte*>(levels_[i]->texels), bytes_of(i)});
  auto copy = std::unique_ptr<MipMap>(new MipMap(*this));
  copy->in_file_ = file.write(pieces);
  if (!copy->in_file_) return nullptr;
  size_t at = 0;
  for (int i = first_; i < level_count(); ++i) {
    copy->levels_[i] = level_in(copy->in_file_, i, at);
    at += ScratchFile::room_for(bytes_of(i));
  }
  return copy;
}

}  // namespace whit
