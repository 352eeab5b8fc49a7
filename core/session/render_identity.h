// What a render is of: whatever its picture depends on, so that states and parts of others are told from its own.
#pragma once

#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/session/session.h"

namespace whit {

/// What a render is of, part by part: what each is, as messages call it, and its value.
struct RenderIdentity {
  struct Part {
    std::string what, value;
    bool operator==(const Part&) const = default;
  };
  std::vector<Part> parts;

  void add(std::string what, std::string value) { parts.push_back({std::move(what), std::move(value)}); }

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);
};

/// The program's own bytes, those of the scene's text and of every file that it reads.
RenderIdentity identity_of(const std::string& scene, const ParsedFile& file);

/// "" or the first difference in words: "the seed was 1 and is 2".
std::string difference(const RenderIdentity& was, const RenderIdentity& is);

}  // namespace whit
