// The state of a render in a file, from which it goes on: after a kill, or with more samples.
//
// A checkpoint appears complete or not at all and ends in a checksum. It is of one program, one scene with all its files,
// and the settings that a picture depends on; what goes on from it has the bits of a render that was never stopped.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/render/film_keeper.h"
#include "core/session/checkpoint_file.h"

namespace whit {

class Checkpoint final : public FilmKeeper {
 public:
  using Seconds = std::chrono::duration<double>;
  /// Will write to `path` every so many seconds, and at the end.
  Checkpoint(std::string path, Seconds every, RenderIdentity identity, RenderCommand command);
  ~Checkpoint() override;
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  enum class Trouble { None, Unreadable, Different };
  struct Problem {
    Trouble trouble = Trouble::None;
    std::string text;  ///< "cannot go on from ...".
  };
  /// Films go on from what this file holds. With a problem nothing has changed.
  Problem resume(const std::string& path);

  /// Why nothing should be written to `path`: it is of something else, or of a render that has not ended, whose state would
  /// be lost; or the folder takes no file. "" where it may.
  static std::string reason_against(const std::string& path);

  bool begin(FilmRender& film) override;
  void end(FilmRender& film, bool complete) override;

  const std::string& path() const { return path_; }
  /// Whether the file that resume() read is of a film like the one that began.
  bool fits() const { return fits_; }
  /// Why the last attempt to write failed, or "".
  std::string write_problem() const;

 private:
  void end_writer();
  void write_now_and_then(const FilmRender& film);
  void write(const FilmRender& film, bool complete);

  const std::string path_;
  const Seconds every_;
  const RenderIdentity identity_;
  const RenderCommand command_;
  std::string kept_;  ///< The state of a film that resume() read.
  bool fits_ = true;
  std::thread writer_;
  mutable std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  std::string write_problem_;
};

}  // namespace whit
