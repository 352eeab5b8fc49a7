#include "core/image/texture_store.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "core/base/file_state.h"
#include "core/base/vec.h"
#include "core/image/texture_memory.h"

namespace whit {

namespace {

// Of a texture that is one of three channels, which: those share what is decoded of the picture. -1 of others.
int channel_of_rgb(const TextureSpec& spec) {
  const bool one_of_three = spec.kind == TextureKind::Float && spec.channel != TextureChannel::Luminance &&
                            spec.channel != TextureChannel::Alpha;
  return one_of_three ? static_cast<int>(spec.channel) - static_cast<int>(TextureChannel::Red) : -1;
}

// What is decoded for a texture.
TextureSpec source_of(TextureSpec spec) {
  if (channel_of_rgb(spec) >= 0) spec.kind = TextureKind::Rgb;
  if (spec.kind == TextureKind::Rgb) spec.channel = TextureChannel::Luminance;
  if (spec.channel == TextureChannel::Alpha) spec.gamma = false;
  if (spec.bytes) spec.path = spec.bytes->name;
  return spec;
}

}  // namespace

ImageTexture::ImageTexture(TextureMemory& memory, TextureSource& source, TextureSpec spec)
    : memory_(memory), source_(source), spec_(std::move(spec)) {}

// Calls look(pyramid), which returns the finest level it needed, again if the pyramid does not have that any more.
// False when the file cannot be decoded.
template <class Look>
bool ImageTexture::with_pyramid(int n, const Look& look) const {
  for (int level = TextureMemory::kAnyLevel;;) {
    const auto map = memory_.resident(source_, level);
    if (!map) return false;
    level = look(*map);
    source_.note(std::exchange(n, 0), level);
    if (level >= map->first_level()) return true;
  }
}

std::shared_ptr<const MipMap> ImageTexture::pyramid() const {
  source_.note(0, 0);
  return memory_.resident(source_, 0);
}

void ImageTexture::lookup(int n, const float* s, const float* t, const float* dsdx, const float* dtdx,
                          const float* dsdy, const float* dtdy, float* r, float* g, float* b) const {
  const LookupPoints points{n, s, t, dsdx, dtdx, dsdy, dtdy};
  const MipFilter filter{spec_.filter, spec_.max_anisotropy};
  look_up_rgb(n, {r, g, b}, [&](const MipMap& map, float* const* out) { return map.lookup(points, filter, out); });
}

void ImageTexture::lookup_width(int n, const float* s, const float* t, const float* width, float* r, float* g,
                                float* b) const {
  look_up_rgb(n, {r, g, b},
              [&](const MipMap& map, float* const* out) { return map.lookup_width(n, s, t, width, out); });
}

template <class Look>
void ImageTexture::look_up_rgb(int n, const std::array<float*, 3>& out, const Look& look) const {
  const bool good = with_pyramid(n, [&](const MipMap& map) {
    const int level = look(map, out.data());
    if (map.channels() == 1) {
      std::copy_n(out[0], n, out[1]);
      std::copy_n(out[0], n, out[2]);
    }
    return level;
  });
  if (good) return;
  for (float* channel : out) std::fill_n(channel, n, 0.0f);
}

void ImageTexture::lookup_float(int n, const float* s, const float* t, const float* dsdx, const float* dtdx,
                                const float* dsdy, const float* dtdy, float* out) const {
  const MipFilter filter{spec_.filter, spec_.max_anisotropy};
  const bool good = with_pyramid(n, [&](const MipMap& map) {
    if (map.channels() == 1) return map.lookup({n, s, t, dsdx, dtdx, dsdy, dtdy}, filter, &out);
    constexpr int kChunk = 128;
    std::array<std::array<float, kChunk>, 3> rgb;
    int level = map.level_count() - 1;
    for (int first = 0; first < n; first += kChunk) {
      const int count = std::min(kChunk, n - first);
      const auto from = [first](const float* p) { return p ? p + first : nullptr; };
      float* const channels[3] = {rgb[0].data(), rgb[1].data(), rgb[2].data()};
      const LookupPoints chunk{count, s + first, t + first, from(dsdx), from(dtdx), from(dsdy), from(dtdy)};
      level = std::min(level, map.lookup(chunk, filter, channels));
      if (const int c = channel_of_rgb(spec_); c >= 0) {
        std::copy_n(channels[c], count, out + first);
        continue;
      }
      for (int i = 0; i < count; ++i) out[first + i] = luminance(RGB(rgb[0][i], rgb[1][i], rgb[2][i]));
    }
    return level;
  });
  if (!good) std::fill_n(out, n, 0.0f);
}

// Which specs are the same: the first key's files are decoded alike.
struct TextureStore::Textures {
  using SourceKey = std::tuple<std::string, const PictureBytes*, TextureKind, TextureChannel, WrapMode,
                               std::optional<bool>, float, bool>;
  using TextureKey = std::tuple<SourceKey, TextureKind, TextureChannel, TextureFilter, float>;
  std::mutex mutex;
  std::map<SourceKey, TextureSource*> sources;
  std::map<TextureKey, std::unique_ptr<ImageTexture>> textures;
  std::map<std::string, FileState> files;
};

bool TextureStore::is_current() const {
  const std::lock_guard lock(textures_->mutex);
  return std::all_of(textures_->files.begin(), textures_->files.end(),
                     [](const auto& file) { return file_state(file.first) == file.second; });
}

TextureStore::TextureStore()
    : memory_(std::make_unique<TextureMemory>(kDefaultMemory)), textures_(std::make_unique<Textures>()) {}

TextureStore::~TextureStore() = default;

const ImageTexture* TextureStore::add(const TextureSpec& spec, SourcePos where) {
  const TextureSpec decoded = source_of(spec);
  const Textures::SourceKey source_key{decoded.path, decoded.bytes.get(), decoded.kind,  decoded.channel,
                                       decoded.wrap, decoded.gamma,       decoded.scale, decoded.flip};
  const std::lock_guard lock(textures_->mutex);
  TextureSource*& source = textures_->sources[source_key];
  FileState file;
  if (!spec.bytes) file = textures_->files.try_emplace(spec.path, file_state(spec.path)).first->second;
  if (!source) source = &memory_->add(decoded, where, file);
  auto& texture = textures_->textures[{source_key, spec.kind, spec.channel, spec.filter, spec.max_anisotropy}];
  if (!texture) texture.reset(new ImageTexture(*memory_, *source, spec));
  return texture.get();
}

void TextureStore::set_memory_limit(size_t bytes) { memory_->set_limit(bytes); }
TextureStatistics TextureStore::statistics() const { return memory_->statistics(); }
void TextureStore::read_all() { memory_->read_all(); }
bool TextureStore::failed() const { return memory_->failed(); }
Diagnostics TextureStore::errors() const { return memory_->errors(); }

}  // namespace whit
