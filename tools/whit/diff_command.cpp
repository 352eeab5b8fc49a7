// `whit diff`: how far a picture is from its reference.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/image/compare.h"
#include "tools/whit/command_line.h"
#include "tools/whit/terminal.h"

namespace whit {

int diff_command(const Arguments& args) {
  std::string out_path, ref_path;
  CompareLimits limits;
  bool json = false, exact = false;
  CLI::App app("Measures how far a picture is from its reference. Exit code 1 when beyond the limits.", "whit diff");
  app.add_option("out", out_path, "The picture")->required();
  app.add_option("reference", ref_path, "The truth")->required();
  app.add_option("--relmse", limits.relmse, "Limit of the relative mean square error");
  app.add_option("--ratio", limits.ratio, "Limit of |mean(out) / mean(reference) - 1|");
  app.add_option("--block", limits.block, "Limit of the largest relative difference of 8x8 blocks");
  app.add_flag("--exact", exact, "Every pixel must be equal");
  app.add_flag("--json", json, "Print the measures as JSON");
  int code = kDone;
  if (!parse_arguments(app, args, code)) return code;
  const Result<Image> out = read_image(out_path), ref = read_image(ref_path);
  for (const auto* r : {&out, &ref}) {
    if (!r->ok()) {
      say("whit diff: " + r->error);
      return kFileError;
    }
  }
  const Comparison c = compare_images(out.value, ref.value);
  std::vector<std::string> why = judge(c, limits);
  if (exact && why.empty() && c.differing_pixels > 0) why.push_back("not equal");
  if (json) {
    nlohmann::json j = {{"equal", c.failure.empty() && c.differing_pixels == 0},
                        {"accepted", why.empty()},
                        {"why", why},
                        {"relmse", c.relmse},
                        {"ratio", c.ratio},
                        {"block", c.block},
                        {"max_difference", c.max_difference},
                        {"differing_pixels", c.differing_pixels}};
    if (c.shifted) j["shift"] = {c.shift_x, c.shift_y};
    fmt::print("{}\n", j.dump(1));
  } else if (!c.failure.empty()) {
    fmt::print("{}\n", c.failure);
  } else {
    fmt::print(
        "relMSE {:.3g}  ratio {:.5f}  block {:.4f}  shift {}  largest difference {:.3g}  {} pixels differ  PSNR {:.1f} "
        "dB\n",
        c.relmse, c.ratio, c.block, c.shifted ? fmt::format("{:+d},{:+d}", c.shift_x, c.shift_y) : "-",
        c.max_difference, c.differing_pixels, c.psnr);
  }
  return why.empty() ? kDone : kNo;
}

}  // namespace whit
