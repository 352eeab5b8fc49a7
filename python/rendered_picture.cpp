#include "python/rendered_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "core/plugin/registry.h"

namespace whit::python {
namespace {

/// A film that asks for nothing, since all that is wanted is said.
Bound<Film> blank_film() {
  Bound<Film> film;
  film.plugin = std::shared_ptr<Film>(static_cast<Film*>(find_plugin("film", "image")->make().release()));
  return film;
}

OutputRequest request_of(const RenderedPicture& picture, const SaveWish& wish) {
  OutputRequest request;
  request.outfile = wish.path;
  request.display = wish.display.empty() ? "none" : wish.display;
  request.view = wish.view.empty() ? picture.view : wish.view;
  request.ocio = wish.ocio;
  request.exposure = wish.exposure.value_or(picture.exposure);
  request.full_float = wish.full_float;
  request.aovs = picture.aovs;
  if (request.aovs.empty() || !holds_layers(wish.path)) request.aovs = {"none"};
  request.read = picture.read;
  return request;
}

/// Nothing of it has a place in a scene.
void fail_on_errors(const Diagnostics& said) {
  static const Sources none;
  if (said.has_errors()) throw failure_of(none, said, {});
}

ImageInfo header(Vec2i size, std::vector<std::string> names) {
  ImageInfo info;
  info.width = info.full_width = size.x, info.height = info.full_height = size.y;
  info.channels = static_cast<int>(names.size());
  info.channel_names = std::move(names);
  return info;
}

/// Every `step`-th number.
std::vector<float> strided(const float* first, size_t step, size_t n) {
  std::vector<float> out(n);
  for (size_t i = 0; i < n; ++i) out[i] = first[i * step];
  return out;
}

}  // namespace

std::vector<std::string> save(const RenderedPicture& picture, const SaveWish& wish) {
  const OutputPlan plan = plan_output(request_of(picture, wish), blank_film());
  fail_on_errors(plan.said);
  const WrittenOutput written = write_output(plan, picture.result, picture.metadata);
  fail_on_errors(written.said);
  std::vector<std::string> warnings;
  for (const Diagnostics* said : {&plan.said, &written.said})
    for (const Diagnostic& d : said->all()) warnings.push_back(d.message);
  return warnings;
}

std::vector<uint8_t> display_values(const RenderedPicture& picture, const DisplayWish& wish) {
  DisplaySpec spec;
  spec.config_path = wish.ocio;
  spec.view = wish.view.empty() ? picture.view : wish.view;
  spec.exposure = static_cast<float>(wish.exposure.value_or(picture.exposure));
  const DisplayResult display = make_display_transform(spec);
  if (!display.error.empty()) throw Failure(display.bad_config ? FailureKind::File : FailureKind::Usage, display.error);
  std::vector<float> values = picture.result.picture.rgb;
  display.transform->apply(values.data(), values.size() / 3);
  std::vector<uint8_t> bytes(values.size());
  // As files have them: half is rounded up.
  std::transform(values.begin(), values.end(), bytes.begin(),
                 [](float v) { return static_cast<uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); });
  return bytes;
}

PicturePlanes planes_of(const RenderedPicture& picture) {
  const Picture& p = picture.result.picture;
  PicturePlanes out;
  static_cast<ImageInfo&>(out) = header({p.width(), p.height()}, {"R", "G", "B"});
  out.x = p.window.min.x, out.y = p.window.min.y;
  out.full_width = p.resolution.x, out.full_height = p.resolution.y;
  for (size_t c = 0; c < 3; ++c) out.planes.push_back(strided(p.rgb.data() + c, 3, p.rgb.size() / 3));
  for (const AovPicture::Channel& channel : picture.result.aovs.channels) {
    out.channel_names.push_back(channel.name);
    out.planes.push_back(channel.values);
  }
  out.channels = static_cast<int>(out.channel_names.size());
  out.formats.assign(out.channel_names.size(), SampleFormat::Float);
  for (const std::vector<OutputMetadata>* entries : {&picture.metadata, &picture.result.aovs.header}) {
    for (const OutputMetadata& entry : *entries)
      out.metadata[entry.name] = std::visit([](const auto& value) { return fmt::format("{}", value); }, entry.value);
  }
  return out;
}

PicturePlanes planes_of(const ArrayView& array) {
  static const std::vector<std::vector<std::string>> kNames{{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  PicturePlanes out;
  const auto channels = static_cast<size_t>(array.channels);
  static_cast<ImageInfo&>(out) = header({array.width, array.height}, kNames[channels - 1]);
  const size_t pixels = static_cast<size_t>(array.width) * static_cast<size_t>(array.height);
  for (size_t c = 0; c < channels; ++c) out.planes.push_back(strided(array.values + c, channels, pixels));
  out.formats.assign(channels, SampleFormat::Float);
  return out;
}

}  // namespace whit::python
