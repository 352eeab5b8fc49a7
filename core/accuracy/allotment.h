// Where the samples of a picture go: what is known of the noise of a film's units, and how many samples each is to have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/bytes.h"
#include "core/render/film_render.h"

namespace whit {

/// A part of the film and what is known of its noise.
struct Allotment {
  double area = 0;       ///< Pixels.
  double variance = 0;   ///< Of one sample, summed over its pixels and channels.
  uint32_t samples = 0;  ///< Per pixel so far.
};

/// The numbers of samples at which the sum of variance / samples is `sum` with the fewest samples: in proportion to the
/// root of the variance per pixel (Neyman, 1934), and never fewer than there are nor more than `most`.
std::vector<double> allot(std::span<const Allotment> parts, double sum, double most);

/// Parts by how much of the sum each further sample takes away, the most first.
std::vector<size_t> by_need(std::span<const Allotment> parts);

/// The numbers of samples after a next pass on the way to a sum of variance / samples: twice as many where allot() wants
/// at least 1.4 times as many; where it wants that nowhere, in as many of the neediest parts as it takes. None stays below
/// a 32nd of the samples of the one that has the most, nor has to have more than `follow` for it: what looked quiet by
/// chance is looked at again.
std::vector<uint32_t> next_samples(std::span<const Allotment> parts, double sum, uint32_t most, uint32_t follow);

/// The noise of the units of an adaptive film, where each colour of the chessboard decides for the other.
///
/// A unit that two samples of its partner's have hit gets more samples, and then sees more itself, so that its partner gets
/// more again; two that missed both stay. So that no unit's samples decide about it by way of its partner, what counts is
/// what the partner's samples said when it had as many as the unit has.
class UnitNoise {
 public:
  explicit UnitNoise(std::span<const FilmRender::Unit> units);

  /// Notes what the film says now. `variance` is FilmRender::variance() of the window, `reach` how many pixels the filter
  /// reaches beyond its own.
  void look(const FilmRender& film, std::span<const FilmRender::Unit> units, std::span<const float> variance,
            const Box2i& window, int reach);

  /// By what is known after the last look. What differs by no more than the looks' own errors is taken for alike.
  std::vector<Allotment> allotments(std::span<const FilmRender::Unit> units) const;

  std::span<const double> areas() const { return areas_; }

  /// What the looks have told, to bytes and back, for the same number of units.
  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  /// Of one sample of a pixel: the variance, channels together, and the squared standard error of that figure.
  struct Noise {
    double variance = 0, error2 = 0;
  };
  std::vector<double> areas_;
  std::vector<std::vector<Noise>> known_;  ///< By unit, and by how often its samples had been doubled.
};

}  // namespace whit
