// What a scene file says `whit check` need not say: comments like `# whit: allow unused-texture`.
#pragma once

#include <string>
#include <vector>

#include "parser/source.h"

namespace whit {

/// The comments of some files. One that stands alone on its line before the first statement of a file is for the whole
/// file; alone on any other line for the statement that follows; behind a statement for what begins on that line. It
/// names one or several findings, with commas or spaces between.
class Allowances {
 public:
  explicit Allowances(const Sources& sources);

  bool allows(const std::string& name, SourcePos where) const;

  /// Names that no finding has, at their places.
  const Diagnostics& said() const { return said_; }

 private:
  /// Bytes of a file in which findings of a name are allowed.
  struct Allowance {
    std::string name;
    uint32_t file;
    uint64_t begin, end;
  };
  void read(uint32_t file, std::string_view text);
  /// `place` is where its name stands.
  void take(Allowance allowance, uint64_t place);

  std::vector<Allowance> all_;
  Diagnostics said_;
};

}  // namespace whit
