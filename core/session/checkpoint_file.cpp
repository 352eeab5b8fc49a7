#include "core/session/checkpoint_file.h"

#include <algorithm>
#include <span>

#include "core/image/atomic_file.h"
#include "core/image/checksum.h"

namespace whit {
namespace {

constexpr std::string_view kMagic = "whit checkpoint\n";

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

bool is_possible(const FilmPart& part) {
  const Box2i& w = part.window;
  const SampleRange& s = part.samples;
  return w.min.x >= 0 && w.min.x <= w.max.x && w.max.x <= part.resolution.x && w.min.y >= 0 && w.min.y <= w.max.y &&
         w.max.y <= part.resolution.y && s.first <= s.last && s.last <= s.whole;
}

}  // namespace

void CheckpointHead::save(ByteWriter& out) const {
  out.numbers(std::span(kMagic));
  out.value(complete);
  identity.save(out);
  out.text(command.folder);
  out.text(command.scene);
  out.value(static_cast<uint32_t>(command.words.size()));
  for (const std::string& word : command.words) out.text(word);
  out.value(part);
}

void CheckpointHead::restore(ByteReader& in) {
  std::string magic(kMagic.size(), ' ');
  in.numbers(std::span(magic));
  if (magic != kMagic) in.fail();
  complete = in.value<uint8_t>() != 0;
  identity.restore(in);
  command.folder = in.text();
  command.scene = in.text();
  for (auto n = in.value<uint32_t>(); n > 0 && in.ok(); --n) command.words.push_back(in.text());
  part = in.value<FilmPart>();
  if (!is_possible(part)) in.fail();
}

CheckpointFile::CheckpointFile(const std::string& path) : file(path) {
  if (!(problem = file.error()).empty()) return;
  if (!is_checkpoint()) {
    problem = "it is no checkpoint";
    return;
  }
  const SummedBytes summed(file.bytes());
  ByteReader in(summed.bytes);
  head.restore(in);
  if (!in.ok() || !summed.are_whole()) problem = "it is damaged: its checksum is wrong";
  state = in.rest();
}

bool CheckpointFile::is_checkpoint() const { return file.bytes().starts_with(kMagic); }

std::string write_checkpoint(const std::string& path, const CheckpointHead& head, const FilmRender& film) {
  AtomicFile file(path);
  SummedFile summed(file);
  ByteWriter out([&](const void* bytes, size_t size) { summed.add(bytes, size); });
  head.save(out);
  film.save(out);
  summed.end();
  return file.commit();
}

}  // namespace whit
