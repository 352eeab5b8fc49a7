// Rendering to an accuracy or to a time.
//
// A first pass gives every pixel 4 to 64 samples in four blocks. Then, look after look, the error is estimated, and the units
// of the film that have the most variance for each sample get twice as many, until the error is below the target with the
// confidence asked for (core/accuracy/film_error.h), or time or samples are used up.
//
// The samples of a pixel do not decide how many it gets: in each tile of 8 x 8, pixels where x + y is even decide for the
// odd ones, and these for the even. So a pixel whose samples missed something by chance does not stop early because of it,
// and the picture has no bias (Kirk and Arvo, Unbiased Sampling Techniques for Image Synthesis, 1991).
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string_view>

#include "core/accuracy/film_error.h"
#include "core/session/pass_file.h"
#include "core/session/session.h"

namespace whit {

/// What is known while it renders.
struct TargetState {
  ErrorClaim claim;         ///< Of the last look; infinite before.
  double share = 0;         ///< Done, in [0,1]: of the samples that the target seems to take, or of the time.
  double samples_mean = 0;  ///< Per pixel.
};

/// How a pass ended that somebody else rendered: all samples are there; or some, and no more will come; or the film is of
/// no use any more.
enum class PassEnd { Over, Stopped, Failed };

struct TargetRequest {
  double error = 0;                                               ///< nRMSE to reach; 0: as far as the time reaches.
  double confidence = 0.95;                                       ///< That the error is below, in (0,1).
  std::optional<std::chrono::steady_clock::time_point> deadline;  ///< When rendering must end.
  uint32_t max_samples = 1 << 16;                                 ///< Per pixel.
  /// Called now and then, from one thread at a time; returning false stops.
  std::function<bool(const TargetState&)> progress{};
  /// With a deadline: called when every pixel has samples for the first time; the seconds it takes to write the picture,
  /// which the deadline then comes earlier by.
  std::function<double(const RenderResult&)> first_picture{};
  /// Without a deadline: has the samples of a pass that has begun taken by others (FilmRender::save_pass(), add_share()),
  /// and tells `progress` of its share that is there; where that returns false nothing more is waited for. The picture is
  /// that of one machine, bit by bit, since sums alone decide. Null: this machine takes them.
  std::function<PassEnd(FilmRender& film, const TargetState& state, const std::function<bool(double)>& progress)>
      render_pass{};
};

enum class TargetEnd { Met, Time, Samples, Stopped, Failed };

struct TargetOutcome {
  RenderedWorld rendered;
  TargetEnd end = TargetEnd::Stopped;
  ErrorClaim claim;  ///< Of the pixels that are not doubted.
  Doubts doubts;
  bool whole = false;  ///< Every pixel has samples.
};

/// Renders until the target is met or there is no more time. Sets the world's samples (set_samples()) where its sampler
/// cannot go on beyond its number.
TargetOutcome render_to_target(BuiltWorld& world, RenderOptions options, const TargetRequest& request, uint32_t seed);

/// Takes one share of a pass (FilmRender::save_pass()) that a render of the same scene and options to a target error has
/// begun. The film is given to the options' keeper, and of no use for anything but FilmRender::add_share(). Nothing, where
/// it is no pass of such a film.
std::optional<RenderedWorld> render_share(BuiltWorld& world, RenderOptions options, std::string_view pass,
                                          PassShare share, uint32_t seed);

}  // namespace whit
