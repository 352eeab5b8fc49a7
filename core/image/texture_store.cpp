#include "core/image/texture_store.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <exception>

#include "core/base/vec.h"

namespace whit {
namespace {

template <class Picture>
MipMap* make_pyramid(Result<Picture> image, const MipMapOptions& options, std::string& error) {
  error = image.error;
  return image.ok() ? new MipMap(std::move(image.value), options) : nullptr;
}

// The pyramid of a file, or null and why there is none.
MipMap* read_pyramid(const std::string& path, const MipMapOptions& options, std::string& error) {
  const Result<ImageInfo> info = probe_image(path);
  error = info.error;
  if (!info.ok()) return nullptr;
  if (info.value.format == SampleFormat::UInt8) return make_pyramid(read_byte_image(path), options, error);
  return make_pyramid(read_image(path), options, error);
}

}  // namespace

// Bytes of all pyramids alive, also of those dropped but still in use; outlives the store if a pyramid does.
struct TextureStore::Memory {
  std::atomic<size_t> bytes{0}, peak{0};
  void add(size_t n) {
    const size_t now = bytes.fetch_add(n) + n;
    size_t old = peak.load();
    while (old < now && !peak.compare_exchange_weak(old, now)) {}
  }
};

// A decoded file, shared by the textures that differ only in their filter.
struct ImageTexture::Source {
  TextureSpec spec;
  std::mutex mutex;  // held while decoding, so that it happens once; guards the next three
  std::shared_ptr<const MipMap> pyramid;
  std::string error;
  bool failed = false;
  std::atomic<int64_t> last_use{-1};  // the store's clock at the latest lookup
  alignas(64) std::atomic<int64_t> lookups{0};
};

ImageTexture::ImageTexture(TextureStore& store, Source& source, TextureSpec spec)
    : store_(store), source_(source), spec_(std::move(spec)) {}

std::shared_ptr<const MipMap> ImageTexture::acquire(int n) const {
  source_.lookups.fetch_add(n, std::memory_order_relaxed);
  return store_.resident(source_);
}

std::shared_ptr<const MipMap> ImageTexture::pyramid() const { return acquire(0); }

void ImageTexture::lookup(int n, const float* s, const float* t, const float* dsdx, const float* dtdx,
                          const float* dsdy, const float* dtdy, float* r, float* g, float* b) const {
  float* const out[3] = {r, g, b};
  const auto map = acquire(n);
  if (!map) {
    for (float* channel : out) std::fill_n(channel, n, 0.0f);
    return;
  }
  map->lookup({n, s, t, dsdx, dtdx, dsdy, dtdy}, {spec_.trilinear, spec_.max_anisotropy}, out);
  if (map->channels() == 1) {
    std::copy_n(r, n, g);
    std::copy_n(r, n, b);
  }
}

void ImageTexture::lookup_float(int n, const float* s, const float* t, const float* dsdx, const float* dtdx,
                                const float* dsdy, const float* dtdy, float* out) const {
  const auto map = acquire(n);
  if (!map) {
    std::fill_n(out, n, 0.0f);
    return;
  }
  const MipFilter filter{spec_.trilinear, spec_.max_anisotropy};
  if (map->channels() == 1) return map->lookup({n, s, t, dsdx, dtdx, dsdy, dtdy}, filter, &out);
  constexpr int kChunk = 128;
  std::array<std::array<float, kChunk>, 3> rgb;
  for (int first = 0; first < n; first += kChunk) {
    const int count = std::min(kChunk, n - first);
    const auto from = [first](const float* p) { return p ? p + first : nullptr; };
    float* const channels[3] = {rgb[0].data(), rgb[1].data(), rgb[2].data()};
    map->lookup({count, s + first, t + first, from(dsdx), from(dtdx), from(dsdy), from(dtdy)}, filter, channels);
    for (int i = 0; i < count; ++i) out[first + i] = luminance(RGB(rgb[0][i], rgb[1][i], rgb[2][i]));
  }
}

void ImageTexture::lookup_width(int n, const float* s, const float* t, const float* width, float* r, float* g,
                                float* b) const {
  float* const out[3] = {r, g, b};
  const auto map = acquire(n);
  if (!map) {
    for (float* channel : out) std::fill_n(channel, n, 0.0f);
    return;
  }
  map->lookup_width(n, s, t, width, out);
  if (map->channels() == 1) {
    std::copy_n(r, n, g);
    std::copy_n(r, n, b);
  }
}

TextureStore::TextureStore() : memory_(std::make_shared<Memory>()) {}
TextureStore::~TextureStore() = default;

const ImageTexture* TextureStore::add(const TextureSpec& spec) {
  const SourceKey source_key{spec.path, spec.kind, spec.wrap, spec.gamma, spec.scale, spec.flip};
  const TextureKey key{source_key, spec.trilinear, spec.max_anisotropy};
  const std::lock_guard lock(mutex_);
  auto& source = sources_[source_key];
  if (!source) {
    source = std::make_unique<ImageTexture::Source>();
    source->spec = spec;
  }
  auto& texture = textures_[key];
  if (!texture) texture.reset(new ImageTexture(*this, *source, spec));
  return texture.get();
}

void TextureStore::set_memory_limit(size_t bytes) { limit_ = bytes; }

// The source's pyramid, decoded if need be. Others who want it meanwhile wait; nobody else does.
std::shared_ptr<const MipMap> TextureStore::resident(ImageTexture::Source& source) {
  // The latest user is left alone, so a scene with one texture does not fight over the clock.
  if (source.last_use.load(std::memory_order_relaxed) != clock_.load(std::memory_order_relaxed))
    source.last_use.store(++clock_, std::memory_order_relaxed);
  std::shared_ptr<const MipMap> map;
  {
    const std::lock_guard lock(source.mutex);
    if (source.pyramid || source.failed) return source.pyramid;
    map = decode(source);
  }
  if (map && memory_->bytes.load() > limit_.load()) evict(source);
  return map;
}

// Called with the source's mutex held. While this thread waits for the parallel parts of decoding it must not
// pick up a task that wants the same mutex: hence the isolation.
std::shared_ptr<const MipMap> TextureStore::decode(ImageTexture::Source& source) {
  const TextureSpec& spec = source.spec;
  const MipMapOptions options{spec.kind == TextureKind::Float, spec.wrap, spec.gamma, spec.scale, spec.flip};
  try {
    MipMap* made = tbb::this_task_arena::isolate([&] { return read_pyramid(spec.path, options, source.error); });
    if (made) {
      memory_->add(made->bytes());
      source.pyramid = {made, [memory = memory_](const MipMap* map) {
                          memory->bytes -= map->bytes();
                          delete map;
                        }};
      ++decodes_;
    }
  } catch (const std::exception& e) {
    source.error = fmt::format("cannot decode image \"{}\": {}", spec.path, e.what());
  }
  source.failed = !source.pyramid;
  if (source.failed) failed_ = true;
  return source.pyramid;
}

void TextureStore::evict(const ImageTexture::Source& keep) {
  const std::lock_guard lock(mutex_);
  std::vector<ImageTexture::Source*> oldest;
  for (const auto& entry : sources_)
    if (entry.second.get() != &keep) oldest.push_back(entry.second.get());
  std::stable_sort(oldest.begin(), oldest.end(), [](const auto* a, const auto* b) {
    return a->last_use.load(std::memory_order_relaxed) < b->last_use.load(std::memory_order_relaxed);
  });
  for (ImageTexture::Source* source : oldest) {
    if (memory_->bytes.load() <= limit_.load()) return;
    const std::unique_lock source_lock(source->mutex, std::try_to_lock);
    if (!source_lock || !source->pyramid) continue;  // being decoded, or not resident
    source->pyramid.reset();
    ++evictions_;
  }
}

TextureStatistics TextureStore::statistics() const {
  TextureStatistics s{memory_->bytes.load(), memory_->peak.load(), decodes_.load(), evictions_.load(), 0};
  const std::lock_guard lock(mutex_);
  for (const auto& entry : sources_) s.lookups += entry.second->lookups.load(std::memory_order_relaxed);
  return s;
}

std::vector<std::string> TextureStore::errors() const {
  std::vector<std::string> all;
  const std::lock_guard lock(mutex_);
  for (const auto& entry : sources_) {
    const std::lock_guard source_lock(entry.second->mutex);
    if (!entry.second->error.empty()) all.push_back(entry.second->error);
  }
  return all;
}

}  // namespace whit
