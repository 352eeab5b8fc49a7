// A picture inside of a mapped file.
#pragma once

#include <memory>
#include <string>

#include "core/base/attachment.h"
#include "core/base/mapped_file.h"

namespace whit {

/// PictureBytes that lie in a file to which others may write while they are decoded.
class MappedPicture final : public PictureBytes {
 public:
  explicit MappedPicture(std::shared_ptr<const MappedFile> file) : file_(std::move(file)) {}

  /// "", or what has happened to the file since it was opened: what was decoded is of no use then.
  std::string problem() const { return file_->problem(); }

 private:
  std::shared_ptr<const MappedFile> file_;
};

}  // namespace whit
