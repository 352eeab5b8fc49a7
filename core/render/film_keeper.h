// Where the state of a render is kept outside of memory, as far as the render needs to know.
#pragma once

namespace whit {

class FilmRender;

/// Asked by whoever makes a film, before the first pass and after the last.
class FilmKeeper {
 public:
  virtual ~FilmKeeper() = default;
  /// A film without samples: it may be given what was kept of an earlier one (FilmRender::restore()). From now on its state
  /// may be asked for, until end(). False when what was kept is not of such a film: nothing is to be rendered.
  virtual bool begin(FilmRender& film) = 0;
  /// The last pass is over, or was stopped.
  virtual void end(FilmRender& film, bool complete) = 0;
};

}  // namespace whit
