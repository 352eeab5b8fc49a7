"""What functions are called with, checked before the extension module gets it."""
from __future__ import annotations

import math
import os
from typing import Any, Mapping, Optional, Sequence, Union

from whit import _whit
from whit._errors import FileError, UsageError

PathOrText = Union[str, "os.PathLike[str]"]
NameOrNumber = Union[str, int, None]

MOST_SAMPLES = 1 << 30


def is_text(scene: PathOrText) -> bool:
    """Whether it is a scene's text rather than a path.

    >>> is_text("scene.pbrt"), is_text("WorldBegin WorldEnd")
    (False, True)
    """
    return isinstance(scene, str) and ("\n" in scene or "WorldBegin" in scene)


def source(scene: PathOrText) -> _whit.Source:
    if is_text(scene):
        return _whit.Source(b"", str(scene).encode("utf-8", "surrogateescape"))
    return _whit.Source(path(scene, "the scene"), None)


def path(given: Any, what: str) -> bytes:
    """A path as the system has it."""
    try:
        return os.fsencode(given)
    except TypeError:
        raise UsageError(f"{what}: a path or a text is needed, not {type(given).__name__}") from None


def whole(name: str, value: Any, least: int, most: int) -> Optional[int]:
    """A whole number within limits, or None."""
    if value is None:
        return None
    try:
        number = value.__index__()
    except (AttributeError, TypeError):
        raise UsageError(f"{name}: a whole number is needed, not {value!r}") from None
    if not least <= number <= most:
        raise UsageError(f"{name}: {number} is not within {least} and {most}")
    return number


def real(name: str, value: Any, above: float = -math.inf, below: float = math.inf) -> Optional[float]:
    """A finite number between limits, or None."""
    if value is None:
        return None
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise UsageError(f"{name}: a number is needed, not {value!r}") from None
    if not (above < number < below and math.isfinite(number)):
        limits = f"above {above:g}" if below == math.inf else f"between {above:g} and {below:g}"
        raise UsageError(f"{name}: {number:g} is no number {limits}")
    return number


def names(name: str, given: Any) -> Optional[list[str]]:
    """Names from a sequence, or from one text with commas between."""
    if given is None:
        return None
    if isinstance(given, str):
        return [one.strip() for one in given.split(",") if one.strip()]
    listed = list(given)
    for one in listed:
        if not isinstance(one, str):
            raise UsageError(f"{name}: a name is needed, not {one!r}")
    return listed


def name_or_number(name: str, given: Any) -> str:
    """What something of a model is called, or its number; "" for None."""
    if given is None:
        return ""
    if isinstance(given, str) and given:
        return given
    if isinstance(given, (str, bool)) or not hasattr(given, "__index__"):
        raise UsageError(f"{name}: a name or a number is needed, not {given!r}")
    return str(whole(name, given, 0, (1 << 31) - 1))


def model(given: Mapping[str, Any]) -> dict[str, Any]:
    """What of a glTF model is shown, checked: of the arguments that a function has."""
    chosen: dict[str, Any] = {name: name_or_number(name, given.get(name))
                              for name in ("model_scene", "model_camera", "model_variant")}
    chosen["model_time"] = real("model_time", given.get("model_time"))
    chosen["allow_outside"] = bool(given.get("allow_outside"))
    return chosen


def crop_window(crop: Optional[Sequence[float]]) -> Optional[list[float]]:
    """x0, x1, y0, y1 as fractions of the picture, or None."""
    if crop is None:
        return None
    window = [float(x) for x in crop]
    if len(window) != 4 or not (0 <= window[0] < window[1] <= 1 and 0 <= window[2] < window[3] <= 1):
        raise UsageError("crop: needs x0, x1, y0, y1 with x0 < x1 and y0 < y1 within [0, 1]")
    return window


def command(scene: PathOrText, flags: Sequence[tuple[str, Any]]) -> str:
    """The command that makes the same picture, for the header of files: without flags that are not given.

    >>> command("scene.pbrt", [("--spp", 4), ("--quick", False), ("--aov", ["N", "Z"])])
    'whit scene.pbrt --spp 4 --aov N,Z'
    """
    words = ["whit", "-" if is_text(scene) else os.fsdecode(path(scene, "the scene"))]
    for flag, value in flags:
        if value is None or value is False or value == [] or value == "":
            continue
        words.append(flag)
        if flag == "--cropwindow":
            words += [f"{x:g}" if float(f"{x:g}") == x else repr(x) for x in value]
        elif value is not True:
            words.append(",".join(value) if isinstance(value, list) else str(value))
    return " ".join(words)


def write_text(file: Any, text: str) -> None:
    """A text into a file, whole."""
    name = path(file, "html")
    try:
        with open(name, "w", encoding="utf-8", errors="surrogateescape") as out:
            out.write(text)
    except OSError as problem:
        raise FileError(f'cannot write "{os.fsdecode(name)}": {problem.strerror}') from problem
