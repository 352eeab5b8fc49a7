// The passes of a render to an accuracy, handed out to whoever renders: a farm.
//
// For each pass there is a file in a folder and a line of JSON on standard output; on standard input come the names of
// files with what was rendered, a line each, and an empty line when all are there.
#pragma once

#include <functional>
#include <string>

#include "core/accuracy/target.h"

namespace whit {

class HandOut {
 public:
  /// `look` is called now and then with a film that has more than before; it takes a tenth of the time at most.
  HandOut(std::string folder, RenderIdentity identity, std::function<void(const FilmRender&)> look)
      : folder_(std::move(folder)), identity_(std::move(identity)), look_(std::move(look)) {}

  /// TargetRequest::render_pass.
  PassEnd render_pass(FilmRender& film, const TargetState& state, const std::function<bool(double)>& progress);

  /// Why no more is waited for, or "", and the exit code.
  const std::string& problem() const { return problem_; }
  int code() const { return code_; }

 private:
  PassEnd fail(PassEnd end, int code, std::string problem);
  PassEnd collect(FilmRender& film, PassParts& parts, const std::function<bool(double)>& progress);
  PassEnd add(FilmRender& film, PassParts& parts, const std::string& name);
  void look(const FilmRender& film);

  const std::string folder_;
  const RenderIdentity identity_;
  const std::function<void(const FilmRender&)> look_;
  uint32_t passes_ = 0;
  double next_look_ = 0;  ///< By the clock, in seconds.
  std::string input_;     ///< What was read of the next lines.
  std::string problem_;
  int code_ = 0;
};

}  // namespace whit
