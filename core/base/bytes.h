// Numbers to bytes and back, for files that only the program that wrote them reads: no byte order, no names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace whit {

/// What may be copied byte by byte. Vectors of Imath count, though they spell out their constructors.
template <class T>
inline constexpr bool kPlainBytes = std::is_standard_layout_v<T>&& std::is_trivially_destructible_v<T>;

/// Gives bytes on as they come.
class ByteWriter {
 public:
  using Sink = std::function<void(const void* bytes, size_t size)>;
  explicit ByteWriter(Sink sink) : sink_(std::move(sink)) {}

  template <class T>
  void value(const T& v) {
    static_assert(kPlainBytes<T>);
    sink_(&v, sizeof v);
  }
  /// As many as the reader knows of.
  template <class T>
  void numbers(std::span<const T> v) {
    static_assert(kPlainBytes<T>);
    if (!v.empty()) sink_(v.data(), v.size_bytes());
  }
  /// How many, and then they.
  template <class T>
  void list(std::span<const T> v) {
    value(static_cast<uint64_t>(v.size()));
    numbers(v);
  }
  void text(std::string_view v) { list(std::span<const char>(v)); }

 private:
  Sink sink_;
};

/// Takes them apart again. Bytes from a file may be anything: the first that are missing make it fail, and from then on
/// all that is read is 0 or empty; so callers ask once, at the end.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T value() {
    static_assert(kPlainBytes<T>);
    T v{};
    take(&v, sizeof v);
    return v;
  }
  template <class T>
  void numbers(std::span<T> v) {
    static_assert(kPlainBytes<T>);
    if (!v.empty()) take(v.data(), v.size_bytes());
  }
  template <class T>
  std::vector<T> list() {
    const auto n = value<uint64_t>();
    if (n > rest_.size() / sizeof(T)) fail();
    std::vector<T> v(ok_ ? static_cast<size_t>(n) : 0);
    numbers(std::span(v));
    return v;
  }
  std::string text() {
    const std::vector<char> v = list<char>();
    return {v.begin(), v.end()};
  }

  void fail() { ok_ = false, rest_ = {}; }
  bool ok() const { return ok_; }
  std::string_view rest() const { return rest_; }

 private:
  void take(void* to, size_t size) {
    if (size > rest_.size()) fail();
    if (!ok_) {
      std::memset(to, 0, size);
      return;
    }
    std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
  }

  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace whit
