// Parts of a picture that were rendered by themselves, of some pixels, some samples or both, to one picture: that of a
// single render, bit by bit.
#pragma once

#include <string>
#include <vector>

#include "core/session/checkpoint_file.h"

namespace whit {

/// Parts of the same pixels, in the order of their samples: all samples there are, but for a look at what there is.
struct PartWindow {
  Box2i window;
  std::vector<std::string> paths;
};

/// What is to be joined, and of what it is.
struct PartsPlan {
  RenderCommand command;    ///< Asks for the whole picture.
  RenderIdentity identity;  ///< Of that.
  Vec2i resolution{0, 0};
  uint32_t samples = 0;  ///< Per pixel.
  FilmRender::Gaps gaps = FilmRender::Gaps::None;
  std::vector<PartWindow> windows;
  std::string problem;      ///< Why they cannot be joined: missing or twice, not ended, of different renders.
  bool unreadable = false;  ///< The problem is that a file cannot be read.
};

/// Sorts checkpoints into windows. Parts whose samples overlap, or between which samples are missing, are a problem, which
/// names the files and the samples. Where gaps are allowed, what is missing and what has not ended yet is no problem.
PartsPlan plan_parts(const std::vector<std::string>& paths, FilmRender::Gaps gaps = FilmRender::Gaps::None);

/// "" or what there is here that is not as it was for the parts: the program, the scene, a file, a flag.
std::string identity_problem(const PartsPlan& plan, const RenderIdentity& here);

/// "" or which pixels of `wanted` are in no part, where no gaps are allowed, or which parts have others.
std::string cover_problem(const PartsPlan& plan, const Box2i& wanted);

/// The picture of `window` that the parts make: the world is that which the plan's command asks for, and is not traced.
/// Pixels of no part are black; RenderResult::share says how much there is. What cannot be read is said.
RenderedWorld join_parts(const BuiltWorld& world, RenderOptions options, const PartsPlan& plan, const Box2i& window);

/// The words of a command, without those that only say which part of a picture it makes.
std::vector<std::string> words_of_whole(const std::vector<std::string>& words);

}  // namespace whit
