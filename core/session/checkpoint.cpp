#include "core/session/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/base/file_names.h"
#include "core/base/mapped_file.h"
#include "core/image/atomic_file.h"
#include "core/image/checksum.h"
#include "core/render/film_render.h"
#include "core/session/files.h"

namespace whit {
namespace {

constexpr std::string_view kMagic = "whit checkpoint\n";
constexpr size_t kSum = sizeof(uint64_t);

/// Writes in pieces of some size, and sums up what it wrote.
class SummedFile {
 public:
  explicit SummedFile(AtomicFile& file) : file_(file) { buffer_.reserve(kPiece); }

  void add(const void* bytes, size_t size) {
    const char* from = static_cast<const char*>(bytes);
    while (size > 0) {
      const size_t n = std::min(size, kPiece - buffer_.size());
      buffer_.append(from, n);
      from += n, size -= n;
      if (buffer_.size() == kPiece) flush();
    }
  }
  void end() {
    flush();
    const uint64_t sum = sum_;
    file_.write_at(&sum, sizeof sum, at_);
  }

 private:
  static constexpr size_t kPiece = size_t{1} << 20;
  void flush() {
    sum_ = checksum(buffer_, sum_);
    file_.write_at(buffer_.data(), buffer_.size(), at_);
    at_ += static_cast<int64_t>(buffer_.size());
    buffer_.clear();
  }

  AtomicFile& file_;
  std::string buffer_;
  int64_t at_ = 0;
  uint64_t sum_ = 0;
};

/// What stands before the state of the film.
struct Head {
  bool complete = false;
  RenderIdentity identity;

  void save(ByteWriter& out) const {
    out.numbers(std::span(kMagic));
    out.value(complete);
    out.value(static_cast<uint32_t>(identity.parts.size()));
    for (const RenderIdentity::Part& p : identity.parts) out.text(p.what), out.text(p.value);
  }
  void restore(ByteReader& in) {
    std::string magic(kMagic.size(), ' ');
    in.numbers(std::span(magic));
    if (magic != kMagic) in.fail();
    complete = in.value<uint8_t>() != 0;
    for (auto n = in.value<uint32_t>(); n > 0 && in.ok(); --n) {
      std::string what = in.text();
      identity.add(std::move(what), in.text());
    }
  }
};

/// A checkpoint that is there.
struct Kept {
  explicit Kept(const std::string& path) : file(path) {
    std::string_view bytes = file.bytes();
    if (!(problem = file.error()).empty()) return;
    if (!is_checkpoint()) {
      problem = "it is no checkpoint";
      return;
    }
    uint64_t sum = 0;
    if (bytes.size() >= kMagic.size() + kSum) std::memcpy(&sum, bytes.data() + bytes.size() - kSum, kSum);
    bytes.remove_suffix(std::min(bytes.size(), kSum));
    ByteReader in(bytes);
    head.restore(in);
    if (!in.ok() || checksum(bytes) != sum) problem = "it is damaged: its checksum is wrong";
    state = in.rest();
  }
  bool is_checkpoint() const { return file.bytes().starts_with(kMagic); }

  const MappedFile file;
  Head head;
  std::string_view state;
  std::string problem;  ///< "" where it is one and whole.
};

}  // namespace

RenderIdentity identity_of(const std::string& scene, const ParsedFile& file) {
  RenderIdentity identity;
  const auto sum_of = [](const std::string& path) {
    const std::optional<uint64_t> sum = file_checksum(path);
    return sum ? checksum_text(*sum) : "missing";
  };
  identity.add("the program", sum_of("/proc/self/exe"));
  uint64_t text = 0;
  for (uint32_t i = 0; i < file.sources->size(); ++i) text = checksum(file.sources->text(i), text);
  identity.add("the scene's text", checksum_text(text));
  const std::filesystem::path folder = std::filesystem::absolute(scene).parent_path();
  for (const std::string& path : assets_of(file)) {
    const std::filesystem::path in_scene = std::filesystem::path(path).lexically_proximate(folder);
    identity.add(fmt::format("the file {}", in_scene.string()), sum_of(path));
  }
  return identity;
}

std::string difference(const RenderIdentity& was, const RenderIdentity& is) {
  const size_t n = std::max(was.parts.size(), is.parts.size());
  for (size_t i = 0; i < n; ++i) {
    if (i >= was.parts.size()) return fmt::format("{} was not part of it", is.parts[i].what);
    if (i >= is.parts.size()) return fmt::format("{} was part of it", was.parts[i].what);
    const RenderIdentity::Part &a = was.parts[i], &b = is.parts[i];
    if (a == b) continue;
    if (a.what != b.what) return fmt::format("it had {}, and here is {}", a.what, b.what);
    const bool is_sum = a.value.size() == 16 || b.value.size() == 16 || b.value == "missing";
    if (is_sum) return fmt::format("{} is another one", a.what);
    const auto shown = [](const std::string& value) { return value.empty() ? std::string("none") : value; };
    return fmt::format("{} was {} and is {}", a.what, shown(a.value), shown(b.value));
  }
  return {};
}

Checkpoint::Checkpoint(std::string path, Seconds every, RenderIdentity identity)
    : path_(std::move(path)), every_(every), identity_(std::move(identity)) {}

Checkpoint::~Checkpoint() { end_writer(); }

void Checkpoint::end_writer() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ends_.notify_all();
  if (writer_.joinable()) writer_.join();
}

Checkpoint::Problem Checkpoint::resume(const std::string& path) {
  const Kept kept(path);
  std::string state(kept.state);
  const std::string problem = kept.problem.empty() ? kept.file.problem() : kept.problem;
  if (!problem.empty()) return {Trouble::Unreadable, fmt::format("cannot go on from \"{}\": {}", path, problem)};
  const std::string other = difference(kept.head.identity, identity_);
  if (!other.empty())
    return {Trouble::Different, fmt::format("cannot go on from \"{}\", which is of another render: {}", path, other)};
  kept_ = std::move(state);
  return {};
}

std::string Checkpoint::reason_against(const std::string& path) {
  std::error_code failed;
  if (std::filesystem::exists(path, failed)) {
    const Kept kept(path);
    if (!kept.file.bytes().empty() && !kept.is_checkpoint())
      return fmt::format("\"{}\" is there already and no checkpoint; name another file", path);
    if (kept.problem.empty() && !kept.head.complete) {
      return fmt::format(
          "\"{}\" holds a render that has not ended; --resume {} goes on with it (remove the file to begin anew)", path,
          shell_word(path));
    }
  }
  const std::string problem = AtomicFile(path).failure();
  return problem.empty() ? "" : fmt::format("cannot write \"{}\": {}", path, problem);
}

bool Checkpoint::begin(FilmRender& film) {
  if (!kept_.empty()) {
    ByteReader in(kept_);
    fits_ = film.restore(in);
    kept_ = {};
    if (!fits_) return false;
  }
  if (every_.count() > 0) writer_ = std::thread([this, &film] { write_now_and_then(film); });
  return true;
}

void Checkpoint::end(FilmRender& film, bool complete) {
  end_writer();
  write(film, complete);
}

void Checkpoint::write_now_and_then(const FilmRender& film) {
  std::unique_lock lock(mutex_);
  while (!ends_.wait_for(lock, every_, [this] { return ended_; })) {
    lock.unlock();
    write(film, false);
    lock.lock();
  }
}

void Checkpoint::write(const FilmRender& film, bool complete) {
  AtomicFile file(path_);
  SummedFile summed(file);
  ByteWriter out([&](const void* bytes, size_t size) { summed.add(bytes, size); });
  Head{complete, identity_}.save(out);
  film.save(out);
  summed.end();
  const std::string problem = file.commit();
  const std::lock_guard lock(mutex_);
  write_problem_ = problem.empty() ? "" : fmt::format("cannot write the checkpoint \"{}\": {}", path_, problem);
}

std::string Checkpoint::write_problem() const {
  const std::lock_guard lock(mutex_);
  return write_problem_;
}

}  // namespace whit
