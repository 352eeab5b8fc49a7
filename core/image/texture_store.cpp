#include "core/image/texture_store.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <utility>

#include "core/base/vec.h"

namespace whit {
// Bytes of all pyramids alive, also of those dropped but still in use, and of what is being decoded; outlives the store
// if a pyramid does.
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
  static constexpr int kNone = std::numeric_limits<int>::max();

  TextureSpec spec;
  SourcePos where;   // of the first that asked for it
  std::mutex mutex;  // held while decoding, so that it happens once; guards the next three
  std::shared_ptr<const MipMap> pyramid;
  std::string error;
  bool failed = false;
  std::atomic<int> finest{kNone};     // the finest level that lookups have needed
  std::atomic<int64_t> last_use{-1};  // the store's clock at the latest lookup
  alignas(64) std::atomic<int64_t> lookups{0};

  void note_level(int level) {
    int old = finest.load(std::memory_order_relaxed);
    while (level < old && !finest.compare_exchange_weak(old, level)) {}
  }
};

ImageTexture::ImageTexture(TextureStore& store, Source& source, TextureSpec spec)
    : store_(store), source_(source), spec_(std::move(spec)) {}

// Calls look(pyramid), which returns the finest level it needed, again if the pyramid does not have that any more.
// False when the file cannot be decoded.
template <class Look>
bool ImageTexture::with_pyramid(int n, const Look& look) const {
  source_.lookups.fetch_add(n, std::memory_order_relaxed);
  for (int level = Source::kNone;;) {
    const auto map = store_.resident(source_, level);
    if (!map) return false;
    level = look(*map);
    source_.note_level(level);
    if (level >= map->first_level()) return true;
  }
}

std::shared_ptr<const MipMap> ImageTexture::pyramid() const {
  source_.note_level(0);
  return store_.resident(source_, 0);
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
      for (int i = 0; i < count; ++i) out[first + i] = luminance(RGB(rgb[0][i], rgb[1][i], rgb[2][i]));
    }
    return level;
  });
  if (!good) std::fill_n(out, n, 0.0f);
}

// A part of the cap for what is being decoded.
class TextureStore::Workspace {
 public:
  Workspace(TextureStore& store, size_t bytes, const ImageTexture::Source& source) : store_(store), bytes_(bytes) {
    std::unique_lock lock(store_.workspace_mutex_);
    // What another thread is decoding can be dropped when it is done. A texture larger than the cap is decoded alone.
    while (!store_.make_room(bytes, source) && store_.workspaces_ > 0) store_.workspace_done_.wait(lock);
    ++store_.workspaces_;
    store_.memory_->add(bytes);
  }
  ~Workspace() { become(0); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// The part ends, and what came of it counts instead.
  void become(size_t bytes) {
    if (bytes_ == 0) return;
    store_.memory_->bytes += bytes - std::exchange(bytes_, 0);
    const std::lock_guard lock(store_.workspace_mutex_);
    --store_.workspaces_;
    store_.workspace_done_.notify_all();
  }

 private:
  TextureStore& store_;
  size_t bytes_;
};

TextureStore::TextureStore() : memory_(std::make_shared<Memory>()) {}
TextureStore::~TextureStore() = default;

const ImageTexture* TextureStore::add(const TextureSpec& spec, SourcePos where) {
  const SourceKey source_key{spec.path, spec.kind, spec.wrap, spec.gamma, spec.scale, spec.flip};
  const TextureKey key{source_key, spec.filter, spec.max_anisotropy};
  const std::lock_guard lock(mutex_);
  auto& source = sources_[source_key];
  if (!source) {
    source = std::make_unique<ImageTexture::Source>();
    source->spec = spec;
    source->where = where;
  }
  auto& texture = textures_[key];
  if (!texture) texture.reset(new ImageTexture(*this, *source, spec));
  return texture.get();
}

void TextureStore::set_memory_limit(size_t bytes) { limit_ = bytes; }

// The source's pyramid with the levels from `level` on, decoded if need be. Others who want it meanwhile wait; nobody
// else does, but for those who decode when memory is short.
std::shared_ptr<const MipMap> TextureStore::resident(ImageTexture::Source& source, int level) {
  // The latest user is left alone, so a scene with one texture does not fight over the clock.
  if (source.last_use.load(std::memory_order_relaxed) != clock_.load(std::memory_order_relaxed))
    source.last_use.store(++clock_, std::memory_order_relaxed);
  const std::lock_guard lock(source.mutex);
  if (source.failed || (source.pyramid && source.pyramid->first_level() <= level)) return source.pyramid;
  source.pyramid.reset();
  decode(source);
  return source.pyramid;
}

// Called with the source's mutex held. While this thread waits for the parallel parts of decoding it must not
// pick up a task that wants the same mutex: hence the isolation.
void TextureStore::decode(ImageTexture::Source& source) {
  const TextureSpec& spec = source.spec;
  try {
    const Result<ImageInfo> info = probe_image(spec.path);
    source.error = info.error;
    if (info.ok()) {
      const bool gamma = spec.gamma.value_or(default_gamma(spec.path, info.value));
      const MipMapOptions options{spec.kind == TextureKind::Float, spec.wrap, gamma, spec.scale, spec.flip};
      Workspace workspace(*this, MipMap::bytes_to_build(info.value, options), source);
      const bool bytes = info.value.format == SampleFormat::UInt8;
      tbb::this_task_arena::isolate([&] {
        source.pyramid = bytes ? keep(read_byte_image(spec.path), options, source.error, workspace)
                               : keep(read_image(spec.path), options, source.error, workspace);
      });
    }
  } catch (const std::exception& e) {
    source.error = fmt::format("cannot decode image \"{}\": {}", spec.path, e.what());
  }
  source.failed = !source.pyramid;
  if (source.failed) failed_ = true;
}

// Makes the pyramid and accounts for it until it is gone.
template <class Picture>
std::shared_ptr<const MipMap> TextureStore::keep(Result<Picture> image, const MipMapOptions& options,
                                                 std::string& error, Workspace& workspace) {
  error = image.error;
  if (!image.ok()) return nullptr;
  ++decodes_;
  auto map = std::make_unique<MipMap>(std::move(image.value), options);
  workspace.become(map->bytes());
  return account(std::move(map));
}

// Takes the pyramid's bytes off the sum when it goes.
std::shared_ptr<const MipMap> TextureStore::account(std::unique_ptr<const MipMap> map) {
  return {map.release(), [memory = memory_](const MipMap* old) {
            memory->bytes -= old->bytes();
            delete old;
          }};
}

// Frees memory until `wanted` more bytes fit: first levels finer than anyone has looked up (one of them is kept if
// possible, because the next ray may be a little nearer), then whole pyramids, the least recently used first. False when
// that was not enough.
bool TextureStore::make_room(size_t wanted, const ImageTexture::Source& wanting) {
  const auto fits = [&] { return memory_->bytes.load() + wanted <= limit_.load(); };
  if (fits()) return true;
  std::vector<ImageTexture::Source*> oldest;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& entry : sources_)
      if (entry.second.get() != &wanting) oldest.push_back(entry.second.get());
  }
  std::stable_sort(oldest.begin(), oldest.end(), [](const auto* a, const auto* b) {
    return a->last_use.load(std::memory_order_relaxed) < b->last_use.load(std::memory_order_relaxed);
  });
  const auto each = [&](auto reduce) {
    for (ImageTexture::Source* source : oldest) {
      if (fits()) return;
      const std::unique_lock lock(source->mutex, std::try_to_lock);
      if (lock && source->pyramid) reduce(*source);  // else being decoded, or not resident
    }
  };
  for (const int spare : {1, 0}) each([&](ImageTexture::Source& source) { trim(source, spare); });
  each([&](ImageTexture::Source& source) {
    source.pyramid.reset();
    source.finest = ImageTexture::Source::kNone;
    ++evictions_;
  });
  return fits();
}

// Gives up the levels that no lookup has needed, but for `spare` of them.
void TextureStore::trim(ImageTexture::Source& source, int spare) {
  const int finest = source.finest, first = finest - spare;
  if (finest == ImageTexture::Source::kNone || first <= source.pyramid->first_level()) return;
  auto rest = std::make_unique<MipMap>(*source.pyramid, first);
  memory_->bytes += rest->bytes();
  source.pyramid = account(std::move(rest));
  ++trims_;
}

void TextureStore::read_all() {
  std::vector<ImageTexture::Source*> sources;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& entry : sources_) sources.push_back(entry.second.get());
  }
  tbb::parallel_for(size_t{0}, sources.size(), [&](size_t i) {
    ImageTexture::Source& source = *sources[i];
    resident(source, 0);
    const std::lock_guard lock(source.mutex);
    source.pyramid.reset();
  });
}

TextureStatistics TextureStore::statistics() const {
  TextureStatistics s;
  s.resident_bytes = memory_->bytes, s.peak_bytes = memory_->peak;
  s.decodes = decodes_, s.trims = trims_, s.evictions = evictions_;
  const std::lock_guard lock(mutex_);
  for (const auto& entry : sources_) s.lookups += entry.second->lookups.load(std::memory_order_relaxed);
  return s;
}

Diagnostics TextureStore::errors() const {
  std::vector<ImageTexture::Source*> sources;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& entry : sources_) sources.push_back(entry.second.get());
  }
  Diagnostics all;
  for (ImageTexture::Source* source : sources) {
    // Without the store's mutex: who decodes holds the source's, and may want the store's.
    const std::lock_guard lock(source->mutex);
    if (!source->error.empty()) all.file_error(source->where, source->error);
  }
  return all;
}

}  // namespace whit
