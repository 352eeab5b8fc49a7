// The picture that a denoiser makes of a render's, written beside it.
#pragma once

#include <string>
#include <vector>

#include "core/image/denoiser.h"
#include "core/session/output.h"

namespace whit {

/// A result's picture without noise, and with a bias; or why there is none.
struct DenoisedPicture {
  Picture picture;
  std::string error;
};
/// Of a result that has the guides. threads: 0 for one per core.
DenoisedPicture denoise(const Denoiser& denoiser, const RenderResult& result, int threads);

/// Has the denoiser's guides, AOVs that say what each pixel's surfaces are, rendered beside those that are written.
void render_guides(OutputPlan& plan);

/// Where the denoised pictures go: NAME-denoised for each NAME that `main` writes, without AOVs. `said` is as
/// plan_output()'s.
OutputPlan plan_denoised(const OutputRequest& request, const OutputPlan& main, const Bound<Film>& film);

/// Denoises a result that has guides and writes it as planned. The header has "whit:denoised", the denoiser's version. The
/// time is that of both.
WrittenOutput write_denoised(const Denoiser& denoiser, const OutputPlan& plan, const RenderResult& result,
                             std::vector<OutputMetadata> metadata, int threads);

}  // namespace whit
