"""Pictures that were rendered."""
from __future__ import annotations

import os
import tempfile
import warnings
from typing import Any, Optional

import numpy as np

from whit import _arguments, _whit
from whit._errors import Diagnostic, diagnostics_of


class Picture:
    """A rendered picture: linear light in memory that the renderer made, without a copy.

    Arrays are views that cannot be written to and keep the picture alive; `.copy()` of one is yours.

    >>> import whit
    >>> picture = whit.render(whit._examples.SPHERE, spp=1, aovs=["N", "variance"])
    >>> picture
    <whit.Picture 32 x 16, 1 samples per pixel, R G B N.X N.Y N.Z variance.R variance.G variance.B>
    >>> picture.channels["N.X"].shape
    (16, 32)
    """

    def __init__(self, core: _whit.Picture) -> None:
        self._core = core
        self._pixels = core.pixels()

    def __repr__(self) -> str:
        return (f"<whit.Picture {self.width} x {self.height}, {self.samples_per_pixel:g} samples per pixel, "
                f"{' '.join(self.channels)}>")

    @property
    def pixels(self) -> np.ndarray:
        """height x width x 3, float32: linear Rec.709 radiance, top row first. Read-only, not copied."""
        return self._pixels

    @property
    def channels(self) -> dict[str, np.ndarray]:
        """height x width arrays by the names that an .exr gives them: "R", "G", "B", then those of `aovs`, as "N.X"."""
        return {**{name: self._pixels[:, :, c] for c, name in enumerate("RGB")}, **self._core.layers()}

    @property
    def variance(self) -> Optional[np.ndarray]:
        """height x width x 3, float32: the variance of each pixel's value (of the mean, not of one sample), infinite where
        it is not known. None unless "variance" is among the picture's `aovs`. A copy."""
        layers = self._core.layers()
        if "variance.R" not in layers:
            return None
        return np.stack([layers["variance." + c] for c in "RGB"], axis=2)

    @property
    def width(self) -> int:
        """Of what was rendered, in pixels."""
        return int(self._pixels.shape[1])

    @property
    def height(self) -> int:
        """Likewise."""
        return int(self._pixels.shape[0])

    @property
    def window(self) -> tuple[int, int, int, int]:
        """x0, y0, x1, y1 of what was rendered, in pixels of the full picture; x1 and y1 are the first left out."""
        return self._core.window()

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height of the full picture, of which a crop is a part."""
        return self._core.resolution()

    @property
    def samples_per_pixel(self) -> float:
        """On average."""
        return self._core.samples_per_pixel()

    @property
    def complete(self) -> bool:
        """False where `progress` ended the render early: there are fewer samples."""
        return self._core.complete()

    @property
    def statistics(self) -> dict[str, Any]:
        """Seconds by step, rays by kind, textures, bytes of memory, settings: the keys of `whit --stats FILE.json`.
        Seconds are wall clock, and of processors in "cpu_seconds"."""
        return self._core.statistics()

    @property
    def target(self) -> Optional[dict[str, Any]]:
        """What `target_error` or `time_limit` came to, with the keys of `whit --json`; an error that is not known is
        infinite. None where neither was asked for."""
        return self._core.target()

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Warnings; and the errors that `keep_going` went past."""
        return diagnostics_of(self._core.said())

    def display(self, *, view: str = "", exposure: Optional[float] = None, ocio: str = "") -> np.ndarray:
        """height x width x 3, uint8: display values as a .png has them.

        `view` is "sRGB", "ACES SDR", "exposure=E" or one of the OpenColorIO config that `ocio` or $OCIO names; `exposure`
        is in stops. Without them the scene's film decides.

        Raises UsageError for a view that there is not, FileError for a config that cannot be read.
        """
        return self._core.display(view, os.fsencode(ocio), _arguments.real("exposure", exposure))

    def save(self, path: Any, *, display: Any = None, full_float: bool = False, view: str = "",
             exposure: Optional[float] = None, ocio: str = "") -> None:
        """Writes a file as the command does; its ending chooses: .exr .pfm (linear) .png .jpg .tga .tiff (display).

        An .exr holds all channels, as half floats unless `full_float`; others hold the colours alone. `display` names a
        display picture beside a linear one. `view`, `exposure`, `ocio`: as `display()`. What the file cannot hold as it
        is comes as a warning (UserWarning).

        Raises FileError where it cannot be written; the file that was there then stays.
        """
        beside = b"" if display is None else _arguments.path(display, "display")
        said = self._core.save(_arguments.path(path, "path"), beside, view, os.fsencode(ocio),
                               _arguments.real("exposure", exposure), full_float)
        for warning in said:
            warnings.warn(warning, UserWarning, stacklevel=2)

    def _repr_png_(self) -> bytes:
        """What Jupyter shows."""
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "picture.png")
            self.save(file)
            with open(file, "rb") as png:
                return png.read()

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> np.ndarray:
        """numpy.asarray() gives `pixels`."""
        if dtype is not None and np.dtype(dtype) != self._pixels.dtype:
            return self._pixels.astype(dtype)
        return self._pixels.copy() if copy else self._pixels
