"""Whether two pictures differ, by how much and where."""
from __future__ import annotations

import os
import tempfile
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from whit import _arguments, _whit
from whit._errors import FileError, UsageError
from whit._picture import Picture

Side = Union[str, "os.PathLike[str]", Picture, np.ndarray]


class Comparison:
    """What two pictures differ by. `report` has all that `whit diff --json` prints."""

    def __init__(self, core: _whit.Comparison) -> None:
        self._core = core
        #: The keys of `whit diff --json` (docs/diff.md). What is null there for being infinite is inf here.
        self.report: dict[str, Any] = core.report()

    def __repr__(self) -> str:
        return f"<whit.Comparison {self.verdict}>"

    @property
    def same(self) -> bool:
        """Whether all limits hold."""
        return self._core.same()

    @property
    def verdict(self) -> str:
        """One line: "same: ...", or "differs: " with the worst failure."""
        return self._core.verdict()

    @property
    def failures(self) -> list[str]:
        """A sentence for each limit that does not hold, the worst first."""
        return self._core.failures()

    @property
    def measures(self) -> dict[str, float]:
        """Of the picture itself, by names of `whit.measures()`; other layers are in `report["layers"]`."""
        return self.report["measures"]

    @property
    def noise(self) -> Optional[dict[str, Any]]:
        """What asking for `noise` found: "same", "p", "regions" ...; else None."""
        return self.report["noise"]

    def save_heatmap(self, path: Any, *, signed: bool = False, scale: float = 0) -> None:
        """Writes a .png of |a - b|, or of a - b if `signed`; `scale` is what the map's end stands for, 0 takes what 99.9 %
        of the pixels are within. Raises FileError."""
        if scale != 0:
            scale = _arguments.real("scale", scale, above=0) or 0
        self._core.save_heatmap(_arguments.path(path, "path"), bool(signed), scale)

    def save_html(self, path: Any) -> None:
        """Writes a page with both pictures, to swipe, blink and zoom. Raises FileError."""
        _arguments.write_text(path, self._core.page(f"{self.report['a']} against {self.report['b']}"))

    def _repr_png_(self) -> bytes:
        """What Jupyter shows: the heat map."""
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "heatmap.png")
            self.save_heatmap(file)
            with open(file, "rb") as png:
                return png.read()


def diff(a: Side, b: Side, *, exact: bool = False, noise: bool = False, alpha: Optional[float] = None,
         channels: Optional[str] = None, colour_space: Optional[str] = None, crop: Optional[Sequence[int]] = None,
         fail_above: Optional[Mapping[str, float]] = None, fail_below: Optional[Mapping[str, float]] = None,
         fail_pixels: Optional[float] = None, pixel_error: Optional[float] = None, hard_fail: Optional[float] = None,
         allow_nonfinite: bool = False, measures: Sequence[str] = ()) -> Comparison:
    """Whether picture `a` differs from the reference `b`: `whit diff`, of files, Pictures and arrays.

    >>> import numpy, whit
    >>> a = numpy.full((16, 16, 3), 0.5, numpy.float32)
    >>> whit.diff(a, a).same, whit.diff(a * 1.1, a).same
    (True, False)
    >>> round(whit.diff(a * 1.1, a).measures["ratio"], 6)
    1.1

    a, b: paths; Pictures; or arrays of linear numbers, height x width or height x width x 1 to 4: Y, Y A, R G B, R G B A.
    exact: every number of every channel must be equal. noise: whether it is only noise, in the place of the default
        limits; `alpha` of pairs that differ by noise alone are called different.
    channels: patterns, as "R,G,B,Albedo.*" or "!variance.*". colour_space: of files with whole numbers.
    crop: x0, x1, y0, y1 in pixels, of which x1 and y1 are the first left out.
    fail_above, fail_below: limits by measure, as {"relmse": 0.01}; inf switches one off.
    fail_pixels: share of the pixels in [0, 1] that may be off by more than `pixel_error`. hard_fail: what no channel of any
        pixel may be off by. allow_nonfinite: NaN and infinity are no failure by themselves.
    measures: those to take although they are slow: "ssim", "flip".

    Raises FileError where a file cannot be read or the two cannot be compared (other channels, other sizes), UsageError.
    """
    options = {
        "exact": exact or None, "noise": noise or None, "allow_nonfinite": allow_nonfinite or None,
        "alpha": _arguments.real("alpha", alpha, above=0, below=0.5), "channels": channels,
        "colour_space": colour_space, "crop": _pixel_window(crop), "measures": _arguments.names("measures", measures),
        "fail_above": _limits("fail_above", fail_above), "fail_below": _limits("fail_below", fail_below),
        "fail_pixels": _share(fail_pixels), "pixel_error": _not_negative("pixel_error", pixel_error),
        "hard_fail": _not_negative("hard_fail", hard_fail),
    }
    return Comparison(_whit.compare(_operand("a", a), _operand("b", b), options))


def measures() -> list[str]:
    """Names of the measures; docs/diff.md says what they are.

    >>> import whit
    >>> whit.measures()[:2]
    ['relmse_robust', 'ratio']
    """
    return _whit.measure_names()


def _operand(name: str, given: Side) -> Any:
    if isinstance(given, Picture):
        return given._core
    if isinstance(given, (str, bytes, os.PathLike)):
        file = _arguments.path(given, name)
        if os.path.isdir(file):
            raise FileError(f'"{os.fsdecode(file)}" is a folder; the command compares folders: whit diff A B')
        return file
    array = np.asarray(given)
    if array.ndim == 2:
        array = array[:, :, None]
    if array.ndim != 3 or not 1 <= array.shape[2] <= 4 or array.size == 0 or array.dtype.kind not in "fiu":
        raise UsageError(f"{name}: a path, a Picture or an array of height x width x 1 to 4 numbers is needed, not "
                         f"{type(given).__name__} of shape {array.shape} and type {array.dtype}")
    if array.dtype.kind != "f":
        raise UsageError(f"{name}: an array of {array.dtype} may be linear or not; make it floats of linear light")
    return np.ascontiguousarray(array, dtype=np.float32)


def _pixel_window(crop: Optional[Sequence[int]]) -> Optional[list[int]]:
    if crop is None:
        return None
    window = [_arguments.whole("crop", n, -(1 << 30), 1 << 30) or 0 for n in crop]
    if len(window) != 4 or window[0] >= window[1] or window[2] >= window[3]:
        raise UsageError("crop: needs pixels x0, x1, y0, y1, of which x1 and y1 are the first left out")
    return window


def _limits(name: str, given: Optional[Mapping[str, float]]) -> dict[str, float]:
    try:
        return {str(measure): float(limit) for measure, limit in (given or {}).items()}
    except (AttributeError, TypeError, ValueError):
        raise UsageError(f'{name}: needs numbers by measure, as {{"relmse": 0.01}}') from None


def _share(given: Optional[float]) -> Optional[float]:
    if given is None:
        return None
    if not 0 <= given <= 1:
        raise UsageError(f"fail_pixels: {given} is no share of the pixels between 0 and 1")
    return float(given)


def _not_negative(name: str, given: Optional[float]) -> Optional[float]:
    if given is None:
        return None
    if not given >= 0:
        raise UsageError(f"{name}: {given} is below 0 (inf switches a limit off)")
    return float(given)
