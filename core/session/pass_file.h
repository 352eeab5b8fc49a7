// A pass of a render, in a file, for those who take shares of it; and the parts that come back.
//
// Of a render to an accuracy the sums decide what comes next, and one program has them. The samples of a pass may be taken
// by others: each is given the file of the pass and which share of how many is its own, and leaves a checkpoint, the part,
// of a film that has the samples of that share alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/mapped_file.h"
#include "core/render/film_render.h"
#include "core/session/render_identity.h"

namespace whit {

/// One of so many shares of a pass, from 1.
struct PassShare {
  uint32_t number = 1, of = 1;
};
/// "2/5", and back; nothing of any other text.
std::string share_text(PassShare share);
std::optional<PassShare> share_of_text(std::string_view text);

/// One that is there.
struct PassFile {
  explicit PassFile(const std::string& path);

  const MappedFile file;
  RenderIdentity identity;  ///< Of the render.
  std::string_view pass;    ///< FilmRender::save_pass()
  std::string id;           ///< Tells it from all others.
  std::string problem;      ///< "" where it is one and whole.
};

/// Writes what is left of a film's pass, which is the `number`-th of its render; why it could not, or "".
std::string write_pass(const std::string& path, const RenderIdentity& identity, uint32_t number,
                       const FilmRender& film);

/// What a part is of, when the render, the pass and the share are those.
RenderIdentity identity_of_share(RenderIdentity render, const std::string& pass_id, PassShare share);

/// The parts of one pass, as they come.
class PassParts {
 public:
  PassParts(RenderIdentity render, std::string pass_id) : render_(std::move(render)), pass_id_(std::move(pass_id)) {}

  enum class Trouble { None, Unreadable, Different, Unusable };
  struct Problem {
    Trouble trouble = Trouble::None;
    std::string text;
  };
  /// Adds a part's samples to the film. One that cannot be read, has not ended, is of something else or was there before is
  /// a problem, and then the film is as it was; but where its samples are none of the pass it is Unusable.
  Problem add(FilmRender& film, const std::string& path);
  /// "" or which shares are missing.
  std::string missing() const;

 private:
  Problem problem_of(const RenderIdentity& identity, const std::string& path, PassShare& share) const;

  const RenderIdentity render_;
  const std::string pass_id_;
  uint32_t of_ = 0;                      ///< How many shares there are, by the first.
  std::map<uint32_t, std::string> got_;  ///< Files, by share.
};

}  // namespace whit
