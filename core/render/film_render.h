// A picture that grows: passes add samples to those that are there.
//
// The film is cut into units that count their samples by themselves: tiles of 16 x 16 pixels; or, for renders that give
// more samples where they are needed, the two colours of a chessboard of pixels in tiles of 8 x 8. However passes divide
// the samples, the picture has the same bits. A pixel is the mean
// over the film of what the filter reaches, each unit's samples weighed by one over their number, so that units with
// many pull no filter their way.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/render/render.h"

namespace whit {

/// What a film is of a picture.
struct FilmPart {
  Vec2i resolution{0, 0};  ///< Of the full picture.
  Box2i window{};          ///< Of its pixels: min inclusive, max exclusive.
  SampleRange samples{};   ///< Of each pixel; of none where units have different numbers of samples.
};

class FilmRender {
 public:
  /// Keeps references to the scene, whose sampler must go on (Sampler::extends()) or be prepared for the samples that
  /// each pass adds.
  FilmRender(const Scene& scene, const RenderOptions& options);
  ~FilmRender();
  FilmRender(const FilmRender&) = delete;
  FilmRender& operator=(const FilmRender&) = delete;

  /// Adds samples until every unit has `samples` of them per pixel. False when RenderOptions::progress stopped it;
  /// units may then have different numbers of samples, and the picture is still one.
  bool extend(uint32_t samples);
  /// The same, with a number for each unit; those that have as many stay as they are. `note` is kept with what save()
  /// says of this pass, for whoever decides about the next.
  bool extend(std::span<const uint32_t> samples, std::string note = {});
  /// Begins a pass as extend() does, whose samples go_on() takes, or others do (save_pass()).
  void begin_pass(std::span<const uint32_t> samples, std::string note = {});
  /// Extends several films of one size, tile by tile in turn, so that the machine's moods meet all alike. They must have
  /// the same pixels and kind of units.
  static bool extend_in_turn(std::span<FilmRender* const> films, uint32_t samples);

  /// All that there is, in the middle of a pass too: from any thread, while others render. A pass cannot begin
  /// meanwhile, and tiles wait for each other no longer than it takes to copy one.
  void save(ByteWriter& out) const;
  /// Makes a film on which nothing was rendered what another was of which this is the state: one of the same scene and
  /// options. False, and the film is of no use, when it is not.
  bool restore(ByteReader& in);
  /// What a part that is merged may leave out: nothing, so that the picture has the bits of a render of all samples; or
  /// samples anywhere, for looks at what there is, of which each pixel is the mean.
  enum class Gaps { None, Allowed };
  /// Adds what another film saved: one of the same scene and options, but for RenderOptions::part, whose samples come
  /// after those that there are, in every unit. False, and the film is of no use, when it is not of that kind.
  bool merge(ByteReader& in, Gaps gaps = Gaps::None);
  /// Ends the pass that was under way in a state that was restored; what comes of it has the bits that it would have had
  /// there. As extend().
  bool go_on();

  /// What is left of a pass.
  struct PassRest {
    size_t tiles = 0;    ///< Of 16 x 16 pixels, which lack samples.
    double samples = 0;  ///< Over all pixels.
  };
  PassRest rest() const;
  /// What is left of the pass that has begun, to bytes; of sums there are none among them.
  void save_pass(ByteWriter& out) const;
  /// Makes a film on which nothing was rendered one share of such a pass of another: one of the same scene and options.
  /// go_on() takes those samples, and those alone. Shares are the tiles by turns, those with the most samples first, so
  /// that all take alike: the `share`-th of `of`, from 0. Its result() has no pixels. False, and the film is of no use,
  /// when it is no such pass.
  bool take_share(ByteReader& in, size_t share, size_t of);
  /// Adds what a film saved that took a share of this one's pass and all of its samples. The picture has the bits that
  /// go_on() would have given it, however many shares there are and in whatever order they come. False, and the film is
  /// of no use, when samples are not those that are left.
  bool add_share(ByteReader& in);

  FilmPart part() const;
  /// Whether it was restored; and the note of the last pass.
  bool restored() const;
  const std::string& note() const;
  /// The most samples that a unit was to have by now.
  uint32_t wanted() const;

  /// The picture by now, with AOVs and statistics. Passes may follow.
  RenderResult result() const;
  /// Processor seconds that the passes took so far, over all threads.
  double cpu_seconds() const;

  /// Linear RGB so far, without the rest of result(): for looks between passes.
  Picture picture() const;
  /// Variance of each pixel's channels (of the mean, not of a sample), three for each pixel of the picture's window, by
  /// four blocks of samples: a bit too high where samples are better spread than random ones. Needs RenderOptions::blocks.
  /// Of the samples of one colour of units if that is given: infinite for pixels that have none.
  std::vector<float> variance(int colour = -1) const;

  /// What the film is cut into.
  struct Unit {
    Box2i pixels;          ///< Of its tile, whose samples are taken; the borders that a filter reaches included.
    int colour = 0;        ///< Of the chessboard: pixels with (x + y) % 2 == colour; -1 for all.
    uint32_t samples = 0;  ///< Per pixel, so far.
    bool holds(int x, int y) const { return colour < 0 || ((x + y) & 1) == colour; }
    /// Pixels that it holds.
    int64_t area() const;
  };
  std::vector<Unit> units() const;

 private:
  static bool extend_tasks(std::span<FilmRender* const> films);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace whit
