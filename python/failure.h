// How a call of the module ends where it cannot do what was asked, and what there is to say of a scene, in words.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "parser/source.h"

namespace whit::python {

/// A diagnostic that needs no sources any more.
struct Said {
  std::string severity;  ///< "error", "warning" or "note".
  std::string name;      ///< "unused-texture": as `whit check` calls it.
  std::string message, remedy;
  std::string file;               ///< "" where it has no place.
  uint64_t line = 0, column = 0;  ///< From 1; 0 where it has no place.
  std::string text;               ///< As the commands print it: place, message, the line of source, remedy.
};
Said said_of(const Sources& sources, const Diagnostic& diagnostic);
std::vector<Said> said_of(const Sources& sources, const Diagnostics& diagnostics);

/// Each is a class of exceptions in Python, and an exit code of the commands'.
enum class FailureKind : uint8_t {
  Usage,  ///< What is asked for makes no sense.
  Scene,  ///< The scene is wrong.
  File,   ///< A file cannot be read or written, or pictures cannot be compared.
  Limit   ///< There is not enough memory.
};

class Failure : public std::runtime_error {
 public:
  Failure(FailureKind failure_kind, const std::string& text, std::vector<Said> what_was_said = {})
      : std::runtime_error(text), kind(failure_kind), said(std::move(what_was_said)) {}
  FailureKind kind;
  std::vector<Said> said;
};

/// The failure that errors lead to; its text is that of all of them. `said` is what the exception holds.
Failure failure_of(const Sources& sources, const Diagnostics& errors, std::vector<Said> said);

}  // namespace whit::python
