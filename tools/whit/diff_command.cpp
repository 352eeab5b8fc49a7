// `whit diff`: how far a picture is from its reference.

#include <fmt/format.h>

#include "core/image/compare.h"
#include "tools/whit/command_line.h"
#include "tools/whit/json.h"
#include "tools/whit/terminal.h"

namespace whit {

int diff_command(const Arguments& args) {
  std::string out_path, ref_path;
  CompareLimits limits;
  bool as_json = false, exact = false;
  const CommandLine command{"whit diff",
                            "Measures how far a picture is from its reference. Exit code 1 when beyond the limits.",
                            {{"out", &out_path, "The picture", {.required = true}},
                             {"reference", &ref_path, "The truth", {.required = true}},
                             {"--relmse", &limits.relmse, "Limit of the relative mean square error"},
                             {"--ratio", &limits.ratio, "Limit of |mean(out) / mean(reference) - 1|"},
                             {"--block", &limits.block, "Limit of the largest relative difference of 8x8 blocks"},
                             {"--exact", &exact, "Every pixel must be equal"},
                             {"--json", &as_json, "Print the measures as JSON"}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
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
  if (as_json) {
    Json::Object j{{"equal", c.failure.empty() && c.differing_pixels == 0},
                   {"accepted", why.empty()},
                   {"why", why},
                   {"relmse", c.relmse},
                   {"ratio", c.ratio},
                   {"block", c.block},
                   {"max_difference", c.max_difference},
                   {"differing_pixels", c.differing_pixels}};
    if (c.shifted) j.emplace_back("shift", Json::Array{c.shift_x, c.shift_y});
    fmt::print("{}\n", to_text(j));
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
