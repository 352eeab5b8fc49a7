// What `whit render` is asked to do.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/image/denoiser.h"
#include "core/session/output.h"
#include "tools/whit/commands.h"
#include "tools/whit/effect_flags.h"
#include "tools/whit/memory_flags.h"
#include "tools/whit/model_flags.h"
#include "tools/whit/sandbox.h"

namespace whit {

/// How far to render, where that is not a number of samples.
struct TargetFlags {
  std::string error, confidence = "95%", time_limit, json;  ///< As given: share_of(), duration_of(); "" for none.
  int max_samples = 1 << 16;
  bool any() const { return !error.empty() || !time_limit.empty(); }
};

/// Keeping the state of a render in a file, and going on from it.
struct CheckpointFlags {
  std::string file, every = "30s", resume, samples;  ///< As given; "" for none.
  bool any() const { return !file.empty() || !resume.empty(); }
  /// Where the state is kept: where it came from, unless another file is named.
  const std::string& kept_in() const { return file.empty() ? resume : file; }
  /// That many samples more than there are, of "+192"; 0 where it is none.
  uint32_t more_samples() const;
};

/// Passes of a render to an accuracy, which others take shares of.
struct PassFlags {
  std::string hand_out;     ///< The folder of the one who decides; "" for none.
  std::string pass, share;  ///< Of one who renders, as given: share_of_text(); "" for none.
  bool any() const { return !hand_out.empty() || !pass.empty() || !share.empty(); }
};

struct PartsPlan;

struct RenderSettings {
  std::vector<std::string> scenes;
  OutputRequest output;
  std::vector<double> crop;
  std::vector<int> crop_pixels;  ///< x0 x1 y0 y1, ends exclusive.
  std::vector<int> pixel;
  std::string sample_range;          ///< As given: samples_of(); "" for all.
  const PartsPlan* parts = nullptr;  ///< Of which the picture is made, in the place of samples.
  bool shown = false;                ///< The display server has the picture of an earlier command.
  std::string debug_pixel;
  EffectFlags effects;
  ModelFlags model;
  TargetFlags target;
  CheckpointFlags checkpoint;
  PassFlags passes;
  SandboxFlags sandbox;
  int threads = 0, spp = 0, footprint_spp = 0;
  uint32_t seed = 0;
  double texture_memory = 1024;
  MemoryFlags memory;
  bool quick = false, quiet = false, strict = false, keep_going = false, stats = false, verbose = false;
  std::string stats_file;  ///< For figures as JSON; "-" is standard output, "" none.
  bool cat = false, toply = false;
  bool denoise = false;
  std::shared_ptr<const Denoiser> denoiser;  ///< There when `denoise` asks for it.
  int verbosity = 0, min_log_level = 0;
  std::string display_server, log_dir, traversal = "robust", half_or_float = "half";
  std::string command_line;
  std::string picture_command;  ///< The same for the header of pictures: without what they do not depend on.
  Arguments picture_words;      ///< The words of that.
  /// Flags that samples depend on, and their values as text: "" where they are not given.
  std::vector<std::pair<std::string, std::string>> of_samples;
};

/// Reads the arguments into settings. Returns true when the command should go on; otherwise `code` is what to
/// exit with, and what is wrong has been printed.
bool read_render_flags(const Arguments& args, RenderSettings& settings, int& code);

/// The samples of "a:b", "a:" or ":b": from a on, b being the first that is not meant, of `whole` that a pixel has. Nothing
/// when the text is anything else; and a range may be empty or reach beyond those that there are.
std::optional<SampleRange> samples_of(const std::string& text, uint32_t whole);

/// The two or three whole numbers of "x,y,sample"; none when the text is anything else.
std::vector<int> numbers_of(const std::string& text);

}  // namespace whit
