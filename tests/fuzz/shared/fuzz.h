// What libFuzzer's targets share: promises, files in memory, and chance for mutators.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string>

namespace whit::fuzz {

/// Ends the program where something is not what its header promises. libFuzzer keeps the input.
inline void require(bool kept) {
  if (!kept) std::abort();
}

/// The input as text.
inline std::string text_of(const uint8_t* data, size_t size) { return {reinterpret_cast<const char*>(data), size}; }

/// A regular file in memory, for what is read by its path. Its content can be replaced as often as one likes.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  void set(const uint8_t* data, size_t size);
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }
  int descriptor() const { return fd_; }

 private:
  int fd_;
};

/// What a mutator decides by: a function of libFuzzer's seed alone (SplitMix64, Steele et al. 2014).
class Dice {
 public:
  explicit Dice(uint64_t seed) : state_(seed) {}
  uint64_t next();
  /// From 0 to n - 1; 0 where n is 0.
  size_t below(size_t n) { return n == 0 ? 0 : next() % n; }
  bool one_in(size_t n) { return below(n) == 0; }
  template <class List>
  const auto& one_of(const List& all) {
    return *std::next(std::begin(all), static_cast<std::ptrdiff_t>(below(std::size(all))));
  }

 private:
  uint64_t state_;
};

/// A number as a scene file writes it: mostly one that makes sense, else one at the end of some range.
std::string odd_number(Dice& dice);

/// Puts an odd number in the place of one of the words of a text. Returns the text's new size.
size_t exchange_number(uint8_t* data, size_t size, size_t max_size, Dice& dice);

/// Copies as much of a text as there is room for. Returns its size.
size_t put_text(const std::string& text, uint8_t* data, size_t max_size);

}  // namespace whit::fuzz

/// libFuzzer's own mutator of bytes, for custom ones to call.
extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);
