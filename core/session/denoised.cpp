#include "core/session/denoised.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/render/aovs.h"

namespace whit {
namespace {

constexpr const char *kAlbedo = "albedo", *kNormal = "N";

/// Three channels, as pixels: of AOVs that the result has.
std::vector<float> pixels_of(const AovPicture& aovs, const char* name) {
  const std::vector<std::string>& names = find_aov(name)->channels;
  std::vector<float> pixels;
  for (size_t c = 0; c < 3; ++c) {
    const auto channel = std::find_if(aovs.channels.begin(), aovs.channels.end(),
                                      [&](const AovPicture::Channel& one) { return one.name == names[c]; });
    pixels.resize(3 * channel->values.size());
    for (size_t i = 0; i < channel->values.size(); ++i) pixels[3 * i + c] = channel->values[i];
  }
  return pixels;
}

std::string denoised_name(const std::string& file) {
  std::filesystem::path name = file;
  name.replace_filename(name.stem().string() + "-denoised" + name.extension().string());
  return name.string();
}

}  // namespace

DenoisedPicture denoise(const Denoiser& denoiser, const RenderResult& result, int threads) {
  // What the film had: the heap keeps it, and what comes now is too large to be put there.
  ::malloc_trim(0);
  const std::vector<float> albedo = pixels_of(result.aovs, kAlbedo), normal = pixels_of(result.aovs, kNormal);
  const Picture& noisy = result.picture;
  Denoiser::Output made = denoiser.denoise({noisy.width(), noisy.height(), noisy.rgb, albedo, normal, threads});
  DenoisedPicture out;
  out.picture.resolution = noisy.resolution, out.picture.window = noisy.window;
  out.picture.rgb = std::move(made.rgb), out.error = std::move(made.error);
  return out;
}

void render_guides(OutputPlan& plan) {
  for (const char* name : {kAlbedo, kNormal}) {
    if (std::count(plan.aovs.begin(), plan.aovs.end(), name) == 0) plan.guides.emplace_back(name);
  }
}

OutputPlan plan_denoised(const OutputRequest& request, const OutputPlan& main, const Bound<Film>& film) {
  OutputRequest beside = request;
  beside.outfile = denoised_name(main.main_file);
  beside.display = main.display_file.empty() ? "none" : denoised_name(main.display_file);
  beside.aovs = {"none"};
  return plan_output(beside, film);
}

WrittenOutput write_denoised(const Denoiser& denoiser, const OutputPlan& plan, const RenderResult& result,
                             std::vector<OutputMetadata> metadata, int threads) {
  const Stopwatch watch;
  DenoisedPicture made = denoise(denoiser, result, threads);
  WrittenOutput out;
  if (made.error.empty()) {
    RenderResult denoised;
    denoised.picture = std::move(made.picture);
    metadata.push_back({"whit:denoised", denoiser.describe()});
    out = write_output(plan, denoised, metadata);
  } else {
    out.said.file_error({}, std::move(made.error));
  }
  out.elapsed = watch.elapsed();
  return out;
}

}  // namespace whit
