#include "core/image/texture_memory.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/image/decode.h"
#include "core/image/picture_change.h"
#include "core/plugin/memory_limit.h"

namespace whit {
namespace {

PictureFile picture_of(const TextureSpec& spec) {
  return spec.bytes ? PictureFile(spec.bytes) : PictureFile(spec.path);
}

/// Throws when a picture is no longer what its file was `before`: what was read then and what is read now do not belong
/// together.
void check_unchanged(const TextureSpec& spec, const FileState& before) {
  if (const std::string change = change_of(picture_of(spec), before); !change.empty()) throw std::runtime_error(change);
}

/// Adds the time of the thread's processor to a sum of nanoseconds.
class ThreadTime {
 public:
  explicit ThreadTime(std::atomic<int64_t>& sum) : sum_(sum) {}
  ~ThreadTime() { sum_ += now() - start_; }
  ThreadTime(const ThreadTime&) = delete;
  ThreadTime& operator=(const ThreadTime&) = delete;

 private:
  static int64_t now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return int64_t{1000000000} * t.tv_sec + t.tv_nsec;
  }
  std::atomic<int64_t>& sum_;
  int64_t start_ = now();
};

}  // namespace

// Bytes of all pyramids alive, also of those dropped but still in use, and of what is being decoded; outlives the
// memory if a pyramid does.
struct TextureMemory::Account {
  std::atomic<size_t> bytes{0}, peak{0};
  void add(size_t n) {
    const size_t now = bytes.fetch_add(n) + n;
    size_t old = peak.load();
    while (old < now && !peak.compare_exchange_weak(old, now)) {}
  }
};

// A part of the cap for what is being decoded.
class TextureMemory::Workspace {
 public:
  Workspace(TextureMemory& memory, size_t bytes, const TextureSource& source) : memory_(memory), bytes_(bytes) {
    std::unique_lock lock(memory_.workspace_mutex_);
    // What another thread is decoding can be dropped when it is done. A texture larger than the cap is decoded alone.
    while (!memory_.make_room(bytes, source) && memory_.workspaces_ > 0) memory_.workspace_done_.wait(lock);
    ++memory_.workspaces_;
    memory_.account_->add(bytes);
  }
  ~Workspace() { become(0); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// The part ends, and what came of it counts instead.
  void become(size_t bytes) {
    if (bytes_ == 0) return;
    memory_.account_->bytes += bytes - std::exchange(bytes_, 0);
    const std::lock_guard lock(memory_.workspace_mutex_);
    --memory_.workspaces_;
    memory_.workspace_done_.notify_all();
  }

 private:
  TextureMemory& memory_;
  size_t bytes_;
};

TextureMemory::TextureMemory(size_t limit) : account_(std::make_shared<Account>()), limit_(limit) {}

TextureSource& TextureMemory::add(const TextureSpec& spec, SourcePos where, const FileState& file) {
  const std::lock_guard lock(mutex_);
  return *sources_.emplace_back(std::make_unique<TextureSource>(spec, where, file));
}

std::vector<TextureSource*> TextureMemory::all() const {
  std::vector<TextureSource*> all;
  const std::lock_guard lock(mutex_);
  for (const auto& source : sources_) all.push_back(source.get());
  return all;
}

// The source's pyramid with the levels from `level` on, decoded if need be. Others who want it meanwhile wait; nobody
// else does, but for those who decode when memory is short.
std::shared_ptr<const MipMap> TextureMemory::resident(TextureSource& source, int level) {
  // The latest user is left alone, so a scene with one texture does not fight over the clock.
  if (source.last_use_.load(std::memory_order_relaxed) != clock_.load(std::memory_order_relaxed))
    source.last_use_.store(++clock_, std::memory_order_relaxed);
  const std::lock_guard lock(source.mutex_);
  if (source.failed_) return nullptr;
  if (source.pyramid_ && source.pyramid_->first_level() <= level) {
    if (!source.in_memory_) bring_back(source);
    return source.pyramid_;
  }
  const ThreadTime time(decode_nanoseconds_);
  try {
    if (!source.outline_) open(source);
    if (level < source.outline_->first_level()) decode(source, level);
  } catch (const std::exception& e) {
    // A file that is being written looks like one that is damaged.
    const std::string changed = change_of(picture_of(source.spec_), source.file_);
    source.error_ = changed.empty() ? picture_error(source.spec_.path, e)
                                    : picture_error(source.spec_.path, std::runtime_error(changed));
    source.out_of_memory_ = changed.empty() && is_out_of_memory(e);
    source.outline_ = source.pyramid_ = nullptr;
    source.in_memory_ = false;
    source.rows_ = nullptr;
    source.failed_ = failed_ = true;
  }
  return source.pyramid_;
}

// What a lookup needs to tell its level: the picture's size. Called, as the next, with the source's mutex held.
void TextureMemory::open(TextureSource& source) {
  const TextureSpec& spec = source.spec_;
  source.rows_ = open_picture(picture_of(spec));
  check_unchanged(spec, source.file_);
  const ImageInfo& info = source.rows_->info;
  const bool gamma = spec.gamma.value_or(default_gamma(spec.path, info));
  source.options_ = {.single = spec.kind == TextureKind::Float,
                     .alpha = spec.channel == TextureChannel::Alpha,
                     .wrap = spec.wrap,
                     .gamma = gamma,
                     .scale = spec.scale,
                     .flip = spec.flip};
  source.pyramid_ = source.outline_ = std::make_shared<MipMap>(info, source.options_);
}

void TextureMemory::decode(TextureSource& source, int level) {
  const int first = std::max(0, std::min<int>(level, source.finest_) - kSpareLevels);
  replace(source, source.outline_, false);
  const auto rows = source.rows_ ? std::move(source.rows_) : open_picture(picture_of(source.spec_));
  const size_t whole = MipMap::bytes_to_build(*rows, source.options_, first);
  const std::shared_ptr<const TexelBlock> room = room_in_file(source, *rows, first);
  const size_t bytes = whole - (room ? MipMap::bytes_of_levels(rows->info, source.options_, first) : 0);
  need_memory(bytes, fmt::format("decoding its {} x {} pixels", rows->info.width, rows->info.height));
  Workspace workspace(*this, bytes, source);
  std::unique_ptr<const MipMap> map;
  try {
    map = std::make_unique<MipMap>(*rows, source.options_, first, room);
  } catch (const ExceedsHalves&) { source.options_.floats = true; }
  check_unchanged(source.spec_, source.file_);
  if (!map) return workspace.become(0), decode(source, level);
  ++source.decodes_;
  decoded_bytes_ += static_cast<int64_t>(map->bytes());
  if (room) {
    workspace.become(0);
    room->give_back();
    return replace(source, std::move(map), false);
  }
  workspace.become(map->bytes());
  replace(source, account(std::move(map)), true);
}

// Where the levels from `first` on are made if they alone are more than may be in memory; null for those that are not, and
// where there is no room for them.
std::shared_ptr<const TexelBlock> TextureMemory::room_in_file(const TextureSource& source, const PictureRows& rows,
                                                              int first) {
  constexpr size_t kLeast = size_t{4} << 20;  // for less a file is not worth it
  const size_t levels = MipMap::bytes_of_levels(rows.info, source.options_, first);
  return levels > std::max(kLeast, limit_.load()) ? scratch_.room(levels) : nullptr;
}

// Takes the pyramid's bytes off the sum when it goes.
std::shared_ptr<const MipMap> TextureMemory::account(std::unique_ptr<const MipMap> map) {
  return {map.release(), [account = account_](const MipMap* old) {
            account->bytes -= old->bytes();
            delete old;
          }};
}

// Texels in the file come back by being read. An outline takes nothing.
void TextureMemory::bring_back(TextureSource& source) {
  const size_t bytes = source.pyramid_->bytes();
  if (bytes == 0) return;
  // What could never be in memory whole is not counted: the system has of it there what is looked at.
  source.counted_ = bytes <= limit_ ? bytes : 0;
  if (source.counted_ > 0) Workspace(*this, source.counted_, source).become(source.counted_);
  source.in_memory_ = true;
  ++returns_;
}

// Frees memory until `wanted` more bytes fit: first levels finer than anyone has looked up, then whole pyramids, the least
// recently used first. False when that was not enough.
bool TextureMemory::make_room(size_t wanted, const TextureSource& wanting) {
  const auto fits = [&] { return account_->bytes.load() + wanted <= limit_.load(); };
  if (fits()) return true;
  struct Use {
    int64_t when;
    TextureSource* source;
    bool operator<(const Use& other) const { return when > other.when; }  // for a heap with the oldest first
  };
  std::vector<Use> uses;
  for (TextureSource* source : all())
    if (source != &wanting && source->in_memory_)
      uses.push_back({source->last_use_.load(std::memory_order_relaxed), source});
  // One that is being decoded, or looked for, is left alone.
  const auto reduce = [&](TextureSource& source, void (TextureMemory::*how)(TextureSource&)) {
    const std::unique_lock lock(source.mutex_, std::try_to_lock);
    if (lock && source.in_memory_) (this->*how)(source);
  };
  for (const Use& use : uses)
    if (!fits() && use.source->first_ < use.source->finest_) reduce(*use.source, &TextureMemory::trim);
  std::make_heap(uses.begin(), uses.end());
  while (!fits() && !uses.empty()) {
    std::pop_heap(uses.begin(), uses.end());
    reduce(*uses.back().source, &TextureMemory::evict);
    uses.pop_back();
  }
  return fits();
}

// Gives up the levels that no lookup has needed.
void TextureMemory::trim(TextureSource& source) {
  const int finest = source.finest_;
  if (finest == TextureSource::kNone || finest <= source.first_ || source.pyramid_->is_in_file()) return;
  auto rest = std::make_unique<MipMap>(*source.pyramid_, finest);
  account_->bytes += rest->bytes();
  replace(source, account(std::move(rest)), true);
  ++trims_;
}

// Gives up all levels, but for their place in the file, if they can have one.
void TextureMemory::evict(TextureSource& source) {
  ++evictions_;
  if (source.pyramid_->is_in_file()) return replace(source, source.pyramid_, false);
  std::shared_ptr<const MipMap> in_file = source.pyramid_->in_file(scratch_);
  replace(source, in_file ? std::move(in_file) : source.outline_, false);
}

// Pyramids in memory are accounted for until they go, those in the file while they are in use.
void TextureMemory::replace(TextureSource& source, std::shared_ptr<const MipMap> pyramid, bool in_memory) {
  if (source.in_memory_ && source.pyramid_->is_in_file()) {
    account_->bytes -= source.counted_;
    source.pyramid_->give_back();
  }
  source.pyramid_ = std::move(pyramid);
  source.first_ = source.pyramid_->first_level();
  source.in_memory_ = in_memory;
}

void TextureMemory::read_all() {
  const std::vector<TextureSource*> sources = all();
  tbb::parallel_for(size_t{0}, sources.size(), [&](size_t i) {
    TextureSource& source = *sources[i];
    const auto outline = resident(source, TextureSource::kNone);
    if (!outline) return;
    resident(source, outline->level_count() - 1);
    const std::lock_guard lock(source.mutex_);
    if (!source.failed_) replace(source, source.outline_, false);
  });
}

TextureStatistics TextureMemory::statistics() const {
  TextureStatistics s;
  s.resident_bytes = account_->bytes, s.peak_bytes = account_->peak;
  s.trims = trims_, s.evictions = evictions_, s.returns = returns_;
  s.decoded_bytes = decoded_bytes_, s.decode_seconds = 1e-9 * static_cast<double>(decode_nanoseconds_);
  for (const TextureSource* source : all()) {
    const int64_t decodes = source->decodes_;
    s.files += decodes > 0;
    s.decodes += decodes;
    s.lookups += source->lookups_.load(std::memory_order_relaxed);
  }
  return s;
}

Diagnostics TextureMemory::errors() const {
  Diagnostics errors;
  for (TextureSource* source : all()) {
    const std::lock_guard lock(source->mutex_);
    if (source->error_.empty()) continue;
    if (source->out_of_memory_) errors.add(limit_error(source->where_, source->error_, "a smaller picture takes less"));
    else errors.file_error(source->where_, source->error_);
  }
  return errors;
}

}  // namespace whit
