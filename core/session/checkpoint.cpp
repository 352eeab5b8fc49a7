#include "core/session/checkpoint.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/base/file_names.h"
#include "core/image/atomic_file.h"
#include "core/render/film_render.h"

namespace whit {

Checkpoint::Checkpoint(std::string path, Seconds every, RenderIdentity identity, RenderCommand command)
    : path_(std::move(path)), every_(every), identity_(std::move(identity)), command_(std::move(command)) {}

Checkpoint::~Checkpoint() { end_writer(); }

void Checkpoint::end_writer() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ends_.notify_all();
  if (writer_.joinable()) writer_.join();
}

Checkpoint::Problem Checkpoint::resume(const std::string& path) {
  const CheckpointFile kept(path);
  std::string state(kept.state);
  const std::string problem = kept.problem.empty() ? kept.file.problem() : kept.problem;
  if (!problem.empty()) return {Trouble::Unreadable, fmt::format("cannot go on from \"{}\": {}", path, problem)};
  const std::string other = difference(kept.head.identity, identity_);
  if (!other.empty())
    return {Trouble::Different, fmt::format("cannot go on from \"{}\", which is of another render: {}", path, other)};
  kept_ = std::move(state);
  return {};
}

std::string Checkpoint::reason_against(const std::string& path) {
  std::error_code failed;
  if (std::filesystem::exists(path, failed)) {
    const CheckpointFile kept(path);
    if (!kept.file.bytes().empty() && !kept.is_checkpoint())
      return fmt::format("\"{}\" is there already and no checkpoint; name another file", path);
    if (kept.problem.empty() && !kept.head.complete) {
      return fmt::format(
          "\"{}\" holds a render that has not ended; --resume {} goes on with it (remove the file to begin anew)", path,
          shell_word(path));
    }
  }
  const std::string problem = AtomicFile(path).failure();
  return problem.empty() ? "" : fmt::format("cannot write \"{}\": {}", path, problem);
}

bool Checkpoint::begin(FilmRender& film) {
  if (!kept_.empty()) {
    ByteReader in(kept_);
    fits_ = film.restore(in);
    kept_ = {};
    if (!fits_) return false;
  }
  if (every_.count() > 0) writer_ = std::thread([this, &film] { write_now_and_then(film); });
  return true;
}

void Checkpoint::end(FilmRender& film, bool complete) {
  end_writer();
  write(film, complete);
}

void Checkpoint::write_now_and_then(const FilmRender& film) {
  std::unique_lock lock(mutex_);
  while (!ends_.wait_for(lock, every_, [this] { return ended_; })) {
    lock.unlock();
    write(film, false);
    lock.lock();
  }
}

void Checkpoint::write(const FilmRender& film, bool complete) {
  const std::string problem = write_checkpoint(path_, {complete, identity_, command_, film.part()}, film);
  const std::lock_guard lock(mutex_);
  write_problem_ = problem.empty() ? "" : fmt::format("cannot write the checkpoint \"{}\": {}", path_, problem);
}

std::string Checkpoint::write_problem() const {
  const std::lock_guard lock(mutex_);
  return write_problem_;
}

}  // namespace whit
