// A file's bytes, mapped into memory.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace whit {

/// Mapped read-only for as long as this lives; the file must not be shortened meanwhile. Only regular files are: opening
/// anything else says so, and does not wait for somebody to write to a pipe.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// "", or why it cannot be read: "No such file or directory".
  const std::string& error() const { return error_; }
  std::string_view bytes() const { return {data_, data_ ? size_ : 0}; }

 private:
  const char* data_ = nullptr;
  size_t size_ = 0;
  std::string error_;
};

}  // namespace whit
