"""Exceptions, and what there is to say of a scene."""
from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Mapping, Sequence


@dataclass(frozen=True)
class Diagnostic:
    """Something there is to say of a scene.

    `severity` is "error", "warning" or "note"; `name` is what `whit check` calls it; `line` and `column` count from 1,
    and are 0, with `file` "", where it has no place. `str()` of it is what the commands print: the place, the message,
    the line of the scene with a mark, the remedy.
    """

    severity: str
    message: str
    file: str = ""
    line: int = 0
    column: int = 0
    remedy: str = ""
    name: str = ""
    text: str = ""

    def __str__(self) -> str:
        return self.text.rstrip("\n") or self.message


class Error(Exception):
    """What the package raises. `diagnostics` is all that was said of the scene, warnings included."""

    diagnostics: list[Diagnostic]

    def __init__(self, message: str = "", diagnostics: Sequence[Diagnostic] = ()) -> None:
        super().__init__(message)
        self.diagnostics = list(diagnostics)


class SceneError(Error):
    """The scene is wrong; the command's exit code is 3."""


class FileError(Error, OSError):
    """A file cannot be read or written, or two pictures cannot be compared; exit code 4."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class UsageError(Error, ValueError):
    """An argument makes no sense; exit code 2."""


class LimitError(Error, MemoryError):
    """There is not enough memory; exit code 5."""


_KINDS = {"usage": UsageError, "scene": SceneError, "file": FileError, "limit": LimitError}


def diagnostics_of(said: Sequence[Mapping[str, Any]]) -> list[Diagnostic]:
    """From what the extension module says."""
    return [Diagnostic(**one) for one in said]


def make_error(kind: str, message: str, said: Sequence[Mapping[str, Any]]) -> Error:
    """Called by the extension module. Flags of the command are arguments here: --texture-filter is texture_filter."""
    if kind == "usage":
        message = re.sub(r"--([a-z][a-z-]*)", lambda flag: flag.group(1).replace("-", "_"), message)
    return _KINDS[kind](message, diagnostics_of(said))
