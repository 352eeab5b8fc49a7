// What accuracy costs in time, for the scene at hand: what is asked, and what is known after measuring.
//
// The measure with a promise is nRMSE: the root mean square error over pixels and the three linear channels, divided by
// the mean radiance of the picture. Error is what remains against the same integrator at its best, not against reality.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/diagnostics.h"
#include "core/base/vec.h"
#include "core/session/session.h"

namespace whit {

/// A value with the ends of its confidence interval of 95 %.
struct Estimate {
  double value = 0, low = 0, high = 0;
  bool operator==(const Estimate&) const = default;
};

/// A piece of a picture for a report: linear RGB, row by row, three floats a pixel.
struct CostImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

struct CostRequest {
  double seconds = 60;           ///< Wall clock, for all of it, counted from `started`.
  bool quick = false;            ///< Samples alone: no knobs, no effects.
  bool all_samplers = false;     ///< Every sampler, not only the scene's, sobol and random.
  int threads = 0;               ///< 0: one per core.
  uint32_t seed = 0;             ///< Of the first replicate; references are from seeds far from it.
  std::string scene_path;        ///< As the commands name it.
  std::string program = "whit";  ///< Likewise.
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  Elapsed before;  ///< What starting the program and parsing took, as they take with every command.
  /// Called now and then with the share done in [0,1] and what is being done; returning false ends the study, which
  /// then reports what it has.
  std::function<bool(double, const std::string&)> progress;
};

/// How a setting differs from the scene as it stands, by pictures in pairs of the same seeds and samples.
struct CostChange {
  std::string from;               ///< The scene's value of the knob.
  Estimate seconds;               ///< CPU seconds of rendering that it takes more than the scene's.
  bool resolved = false;          ///< The interval leaves out zero.
  double share = 0;               ///< The same as a share of the scene's: -0.3 saves 30 %.
  std::optional<Estimate> noise;  ///< Its nRMSE over the scene's at the same samples, where both have one limit.
  double mean_change = 0;         ///< Of the mean radiance, relative.
  double pixels_changed = 0;  ///< Share of the pixels whose luminance it changes by more than 1 % (beyond the noise).
};

/// One way to render the scene, measured.
struct CostSetting {
  std::string knob;     ///< "samples", "lights", "sampler", "maxdepth", "texture filter", "traversal", "integrator" ...
  std::string value;    ///< "64", "random": of the knob.
  int samples = 0;      ///< Per pixel.
  std::string command;  ///< To paste: without --outfile and --seed.
  Estimate seconds;  ///< Of the whole command, start and writing included: median of the replicates, least, greatest.
  Estimate cpu_seconds;
  Estimate nrmse;      ///< Against the scene's own reference: noise and bias together.
  double upper95 = 0;  ///< Of nRMSE, one-sided.
  /// nRMSE of what more samples do not take away, where the setting has another limit than the scene as it stands.
  std::optional<Estimate> bias;
  std::optional<CostChange> change;  ///< Against the scene as it stands, with the same samples; not of "samples".
  double relmse = 0;                 ///< mean((x - ref)^2 / (ref^2 + e)), e = (0.1 mean radiance)^2; no promise.
  double flip = 0;                   ///< Mean LDR-FLIP of the display pictures, at 67 pixels per degree; no promise.
  double share_2_255 = 0;            ///< Of the pixels, off by more than 2/255 in the display picture; no promise.
  double quantile95 = 0;             ///< Of |x - ref| / mean radiance over pixels and channels; no promise.
  bool pareto = false;               ///< Nothing measured is both faster and nearer.
  CostImage crop;                    ///< The same place of every setting's first replicate.
};

/// The scene without one of its effects, paired with the scene as it is.
struct CostEffect {
  std::string name;  ///< As --without takes it.
  std::string command;
  int samples = 0;            ///< Per pixel, of the figures below.
  int replicates = 0;         ///< Pairs of pictures.
  Estimate seconds;           ///< CPU seconds of rendering that the effect takes.
  bool resolved = false;      ///< The interval leaves out zero.
  double share = 0;           ///< Of the scene's CPU seconds of rendering.
  Estimate wall_seconds;      ///< Beside it.
  double mean_change = 0;     ///< What the effect adds to the mean radiance, as a share of it: -0.1 takes 10 % away.
  double pixels_changed = 0;  ///< Share of the pixels whose luminance it changes by more than 1 % (beyond the noise).
  CostImage where;            ///< Thumbnail: |difference| / mean radiance.
};

/// A sentence that answers, and the command that does what it says.
struct CostAnswer {
  std::string text, command;
  Estimate nrmse;        ///< Predicted: low and high.
  Estimate cpu_seconds;  ///< Likewise.
  bool extrapolated = false;
};

/// A pixel, or many of one thing, that carry much of the error.
struct CostWorst {
  Vec2i pixel{0, 0};
  double share = 0;   ///< Of the squared error.
  std::string shape;  ///< "sphere scene.pbrt:12", "" where the ray leaves the scene.
  std::string light;  ///< Likewise of an emitter met there or next to it; "".
};

struct CostReport {
  std::string scene;    ///< Path.
  std::string machine;  ///< Processor, threads, instruction set.
  std::string integrator, sampler;
  Vec2i resolution{0, 0};
  int own_samples = 0;  ///< What the scene asks for.

  // The reference: the scene's own settings with many samples, in two halves of different seeds.
  int reference_samples = 0;  ///< Of both halves together.
  double reference_seconds = 0;
  double reference_noise = 0;  ///< nRMSE of the reference itself, by its halves; subtracted from squared measures.
  double mean_radiance = 0;

  int replicates = 0;
  Estimate order;                                    ///< Of convergence: nRMSE falls as samples^-order.
  double fixed_seconds = 0, per_sample_seconds = 0;  ///< CPU: a + b * samples per pixel.
  double fixed_wall = 0, per_sample_wall = 0;
  std::vector<CostSetting> settings;  ///< The levels of "samples" first.
  std::vector<CostEffect> effects;
  std::vector<CostAnswer> answers;
  std::vector<CostWorst> worst;        ///< That carry half of the squared error at the last level, most first.
  size_t half_error_pixels = 0;        ///< So many pixels carry half of it.
  std::vector<std::string> not_known;  ///< What was cut, and what the figures do not say.
  CostImage picture, error;            ///< The last level's first replicate, and its |error| / mean radiance.
  bool complete = true;                ///< False when time or the user ended it early.
};

/// Studies one world of a file. Problems of the scene are in `said`; without a scene the report has no settings. The
/// world's statements are others while variants are built, and what they were in the end.
struct CostStudy {
  CostReport report;
  Diagnostics said;
};
CostStudy study_cost(ParsedFile& file, size_t world, const CostRequest& request);

}  // namespace whit
