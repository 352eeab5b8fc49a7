#include "tests/fuzz/shared/fuzz.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <string_view>

namespace whit::fuzz {

MemoryFile::MemoryFile() : fd_(memfd_create("input", MFD_CLOEXEC)) { require(fd_ >= 0); }

MemoryFile::~MemoryFile() { close(fd_); }

void MemoryFile::set(const uint8_t* data, size_t size) {
  require(ftruncate(fd_, 0) == 0 && pwrite(fd_, data, size, 0) == static_cast<ssize_t>(size));
}

uint64_t Dice::next() {
  uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

std::string odd_number(Dice& dice) {
  static constexpr std::string_view kUsual[] = {"0",  "1",    "-1",    "0.5", "2",  "3",   "4",
                                                "10", "0.01", "-0.25", "45",  "90", "180", "7.5"};
  static constexpr std::string_view kOdd[] = {"-0",
                                              "1e-45",
                                              "1e-38",
                                              "1e-30",
                                              "1e-12",
                                              "-1e-6",
                                              "1e6",
                                              "1e7",
                                              "-1e12",
                                              "1e14",
                                              "1e20",
                                              "-1e20",
                                              "1e38",
                                              "3.4e38",
                                              "-3.4e38",
                                              "1e39",
                                              "1e308",
                                              "1e400",
                                              "1e-400",
                                              "255",
                                              "256",
                                              "65535",
                                              "65536",
                                              "2147483647",
                                              "2147483648",
                                              "-2147483648",
                                              "4294967295",
                                              "4294967296",
                                              "9223372036854775807",
                                              "nan",
                                              "inf",
                                              "-inf",
                                              "1e",
                                              "0x10",
                                              "1,",
                                              "-"};
  const std::string_view chosen = dice.one_in(3) ? dice.one_of(kOdd) : dice.one_of(kUsual);
  return std::string(chosen);
}

size_t put_text(const std::string& text, uint8_t* data, size_t max_size) {
  const size_t size = std::min(text.size(), max_size);
  std::copy_n(text.begin(), size, data);
  return size;
}

size_t exchange_number(uint8_t* data, size_t size, size_t max_size, Dice& dice) {
  std::string text = text_of(data, size);
  const auto is_space = [](char c) { return c == ' ' || c == '\n' || c == '\t'; };
  size_t begin = dice.below(size + 1), end = begin;
  while (begin > 0 && !is_space(text[begin - 1])) --begin;
  while (end < text.size() && !is_space(text[end])) ++end;
  text.replace(begin, end - begin, odd_number(dice));
  return put_text(text, data, max_size);
}

}  // namespace whit::fuzz
