#include "core/image/exr_header.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/plain_text.h"
#include "core/image/decode.h"

namespace whit {
namespace {

constexpr size_t kLongestName = 255;
constexpr uint32_t kMultiPart = 0x1000;  // a flag of the version

class Reader {
 public:
  explicit Reader(const PictureFile& file) : file_(open_to_read(file)) {
    std::fseek(file_.get(), 0, SEEK_END);
    size_ = static_cast<uint64_t>(std::ftell(file_.get()));
    std::rewind(file_.get());
  }

  uint64_t size() const { return size_; }
  uint64_t left() const { return size_ - static_cast<uint64_t>(std::ftell(file_.get())); }
  void skip(uint32_t bytes) { std::fseek(file_.get(), static_cast<long>(bytes), SEEK_CUR); }

  std::optional<uint32_t> number() {
    std::array<uint8_t, 4> b{};
    if (std::fread(b.data(), 1, b.size(), file_.get()) != b.size()) return {};
    return uint32_t{b[0]} | uint32_t{b[1]} << 8 | uint32_t{b[2]} << 16 | uint32_t{b[3]} << 24;
  }

  /// Up to a zero; nothing when there is none, or when it is too long to be a name.
  std::optional<std::string> name() {
    std::string text;
    for (int c = std::fgetc(file_.get()); c > 0; c = std::fgetc(file_.get())) {
      text += static_cast<char>(c);
      if (text.size() > kLongestName) return {};
    }
    if (std::feof(file_.get())) return {};
    return text;
  }

 private:
  FilePtr file_;
  uint64_t size_ = 0;
};

/// An entry of a header: its name, "" at the header's end; nothing where the file ends or makes no sense.
std::optional<std::string> next_entry(Reader& in, std::string& problem) {
  const std::optional<std::string> name = in.name();
  if (!name || name->empty()) return name;
  const std::optional<std::string> type = in.name();
  const std::optional<uint32_t> bytes = type ? in.number() : std::nullopt;
  if (!bytes) return {};
  if (*bytes > in.left()) {
    problem = fmt::format("its header claims that {} has {} bytes, but the file has only {}", quoted_name(*name),
                          *bytes, in.size());
    return {};
  }
  in.skip(*bytes);
  return name;
}

}  // namespace

std::string exr_header_problem(const PictureFile& file) {
  constexpr uint32_t kMagic = 20000630;
  Reader in(file);
  if (in.number() != kMagic) return {};
  const std::optional<uint32_t> version = in.number();
  const bool many = version && (*version & kMultiPart) != 0;
  std::string problem;
  bool first_entry = true;
  while (const std::optional<std::string> name = next_entry(in, problem)) {
    // The headers of many parts end with an empty one.
    if (name->empty() && (!many || first_entry)) break;
    first_entry = name->empty();
  }
  return problem;
}

}  // namespace whit
