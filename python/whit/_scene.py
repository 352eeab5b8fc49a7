"""Rendering, once and again."""
from __future__ import annotations

import os
from typing import Any, Callable, Optional, Sequence

import numpy as np

from whit import _arguments, _whit
from whit._arguments import NameOrNumber, PathOrText
from whit._errors import Diagnostic, UsageError, diagnostics_of
from whit._picture import Picture

Progress = Callable[[float], Any]


def plan_arguments(given: dict[str, Any]) -> dict[str, Any]:
    """Those that stand instead of the scene's statements, checked."""
    return {
        "integrator": given["integrator"], "sampler": given["sampler"], "lights": given["lights"],
        "texture_filter": given["texture_filter"],
        "maxdepth": _arguments.whole("maxdepth", given["maxdepth"], -(1 << 31), (1 << 31) - 1),
        "rrthreshold": _arguments.real("rrthreshold", given["rrthreshold"]),
        "without": _arguments.names("without", given["without"]), "only": _arguments.names("only", given["only"]),
    }


def _scene_arguments(given: dict[str, Any]) -> dict[str, Any]:
    return {
        **plan_arguments(given),
        "spp": _arguments.whole("spp", given["spp"], 1, _arguments.MOST_SAMPLES),
        "footprint_spp": _arguments.whole("footprint_spp", given["footprint_spp"], 1, _arguments.MOST_SAMPLES),
        "seed": _arguments.whole("seed", given["seed"], 0, (1 << 32) - 1),
        "world": _arguments.whole("world", given["world"], 0, (1 << 31) - 1),
        "texture_memory": _arguments.real("texture_memory", given["texture_memory"], above=0),
        "quick": bool(given["quick"]), "strict": bool(given["strict"]), "keep_going": bool(given["keep_going"]),
        **_arguments.model(given),
    }


def _flags(given: dict[str, Any]) -> list[tuple[str, Any]]:
    """The command's, in the order in which `render` has them."""
    return [("--" + name.removeprefix("model_").replace("_", "-"), given.get(name))
            for name in ("spp", "seed", "crop", "integrator", "sampler", "maxdepth", "rrthreshold", "lights",
                         "texture_filter", "without", "only", "aov", "target_error", "confidence", "time_limit",
                         "max_samples", "footprint_spp", "quick", "keep_going", "model_camera", "model_scene", "model_time",
                         "model_variant", "allow_outside")]


def _rendered(core: _whit.Picture, progress: Optional[Progress]) -> Picture:
    picture = Picture(core)
    if progress is not None and picture.complete:
        progress(1.0)
    return picture


def render(scene: PathOrText, *, spp: Optional[int] = None, seed: Optional[int] = None,
           crop: Optional[Sequence[float]] = None, integrator: Optional[str] = None, aovs: Sequence[str] = (),
           target_error: Optional[float] = None, threads: int = 0, quick: bool = False,
           progress: Optional[Progress] = None, confidence: float = 0.95, time_limit: Optional[float] = None,
           max_samples: int = 1 << 16, sampler: Optional[str] = None, maxdepth: Optional[int] = None,
           rrthreshold: Optional[float] = None, lights: Optional[str] = None, texture_filter: Optional[str] = None,
           without: Optional[Sequence[str]] = None, only: Optional[Sequence[str]] = None,
           footprint_spp: Optional[int] = None, texture_memory: float = 1024, strict: bool = False,
           keep_going: bool = False, model_scene: NameOrNumber = None, model_camera: NameOrNumber = None,
           model_time: Optional[float] = None, model_variant: NameOrNumber = None, allow_outside: bool = False,
           world: int = 0) -> Picture:
    """Renders a scene: the picture that `whit SCENE` makes with the flags of the same names.

    >>> import whit
    >>> whit.render(whit._examples.SPHERE, spp=2, crop=(0, 0.5, 0, 1)).window
    (0, 0, 16, 16)

    scene: a path, or a text with several lines or the word WorldBegin.
    spp: samples per pixel instead of the scene's, 1 to 2**30, as its sampler rounds them.
    seed: 0 to 2**32 - 1.
    crop: x0, x1, y0, y1 as fractions of the picture.
    integrator, sampler, maxdepth, rrthreshold, lights ("all", "tree"), texture_filter ("ewa", "trilinear", "point"):
        instead of what the scene says.
    aovs: what the picture has beside its colours, names of `whit.aovs()`; () takes the film's, ("none",) none.
    target_error, time_limit: render until the error (nRMSE) is below, 0.01 for 1 %, or for so many seconds, reading
        included; with `confidence` in (0, 1) and `max_samples` per pixel at most. What came of it is in
        `Picture.target`; the picture is returned whether the target was met or not.
    threads: 0 for one per core. The picture does not depend on it.
    quick: a quarter of the resolution each way, one sample per pixel.
    progress: called about 20 times a second with the share done in [0, 1], in the calling thread, and with 1 at the end.
        When it returns False the render ends, and the picture has what there is (`Picture.complete`).
    without, only: effects to leave out, or to keep of those that the scene calls for; names of `whit.effects()`.
    footprint_spp: samples that share a pixel's texture filtering; by default the scene's own number.
    texture_memory: MiB of decoded textures at most.
    strict: warnings are errors. keep_going: render what is usable despite errors.
    model_scene, model_camera, model_variant: of a glTF model the scene, the camera and the variant of its materials, by
        name or number from 0; by default the file's scene and its first camera, or one that frames it.
    model_time: seconds into the model's animations; by default as the file has the nodes.
    allow_outside: models may name files outside of their folder.
    world: which of the pictures of a file with several WorldBegin, from 0.

    Other Python threads run meanwhile, and may render too. Ctrl-C raises KeyboardInterrupt: at once while it renders,
    at the end of a step while the scene is read and built.

    Raises SceneError, FileError, UsageError, LimitError.
    """
    given = dict(locals())
    wish = {
        "crop": _arguments.crop_window(crop), "aovs": _arguments.names("aovs", aovs),
        "threads": _arguments.whole("threads", threads, 0, 4096),
        "target_error": _arguments.real("target_error", target_error, above=0),
        "confidence": _arguments.real("confidence", confidence, above=0, below=1),
        "time_limit": _arguments.real("time_limit", time_limit, above=0),
        "max_samples": _arguments.whole("max_samples", max_samples, 1, _arguments.MOST_SAMPLES),
    }
    has_target = target_error is not None or time_limit is not None
    if has_target and spp is not None:
        raise UsageError("spp says how many samples to take, target_error and time_limit how far to go; max_samples is a "
                         "limit")
    built = {**_scene_arguments(given), "extending": has_target}
    said = {**built, **wish, "aov": wish["aovs"]}
    if not has_target:
        said["confidence"] = said["max_samples"] = None
    flags = [("--cropwindow" if flag == "--crop" else flag, value) for flag, value in _flags(said)]
    wish["command"] = os.fsencode(_arguments.command(scene, flags))
    return _rendered(_whit.render(_arguments.source(scene), built, wish, progress), progress)


class Scene:
    """A scene that is read and built once, and rendered as often as one likes.

    >>> import whit
    >>> scene = whit.Scene(whit._examples.SPHERE)
    >>> first = scene.render(spp=1)
    >>> aside = scene.render(spp=1, camera=whit.look_at((2, 0, -4), (0, 0, 0), (0, 1, 0)))
    >>> bool((first.pixels == aside.pixels).all()), bool((first.pixels == scene.render(spp=1).pixels).all())
    (False, True)

    Arguments and errors as those of `render`. Renders of one Scene wait for each other; those of several do not.
    """

    def __init__(self, scene: PathOrText, *, spp: Optional[int] = None, seed: Optional[int] = None,
                 integrator: Optional[str] = None, quick: bool = False, sampler: Optional[str] = None,
                 maxdepth: Optional[int] = None, rrthreshold: Optional[float] = None, lights: Optional[str] = None,
                 texture_filter: Optional[str] = None, without: Optional[Sequence[str]] = None,
                 only: Optional[Sequence[str]] = None, footprint_spp: Optional[int] = None,
                 texture_memory: float = 1024, strict: bool = False, keep_going: bool = False,
                 model_scene: NameOrNumber = None, model_camera: NameOrNumber = None,
                 model_time: Optional[float] = None, model_variant: NameOrNumber = None, allow_outside: bool = False,
                 world: int = 0) -> None:
        self._given = _scene_arguments(dict(locals()))
        self._scene = scene
        self._core = _whit.Scene(_arguments.source(scene), self._given)

    def __repr__(self) -> str:
        name = "text" if _arguments.is_text(self._scene) else str(self._scene)
        return f"<whit.Scene {name}, {self.resolution[0]} x {self.resolution[1]}, {self.samples_per_pixel} samples per pixel>"

    def render(self, *, camera: Any = None, resolution: Optional[Sequence[int]] = None, spp: Optional[int] = None,
               seed: Optional[int] = None, crop: Optional[Sequence[float]] = None, aovs: Sequence[str] = (),
               threads: int = 0, progress: Optional[Progress] = None) -> Picture:
        """Renders what was built. What is not given is the scene's, whatever earlier calls said.

        camera: 4 x 4 from world to camera, for columns: a point p is at camera @ [x, y, z, 1], x to the right, y up and z
            ahead. As `Scene.camera` and `whit.look_at()`. The shutter then sees it standing still.
        resolution: width and height in pixels, up to 65536.

        Without camera and resolution the picture has the bits of whit.render() with the same arguments. A camera far
        from the scene's own has fewer digits there than in a scene that was built for it.
        """
        wish = {
            "camera": _matrix(camera), "resolution": _size(resolution),
            "spp": _arguments.whole("spp", spp, 1, _arguments.MOST_SAMPLES),
            "seed": _arguments.whole("seed", seed, 0, (1 << 32) - 1), "crop": _arguments.crop_window(crop),
            "aovs": _arguments.names("aovs", aovs), "threads": _arguments.whole("threads", threads, 0, 4096),
        }
        said = {**self._given, **{name: wish[name] for name in ("spp", "seed", "crop") if wish[name] is not None},
                "aov": wish["aovs"]}
        flags = [("--cropwindow" if flag == "--crop" else flag, value) for flag, value in _flags(said)]
        if camera is None and resolution is None:
            wish["command"] = os.fsencode(_arguments.command(self._scene, flags))
        return _rendered(self._core.render(wish, progress), progress)

    @property
    def camera(self) -> np.ndarray:
        """4 x 4, float64: where the scene has its camera, as `render` takes it; of one that moves, when the shutter
        opens."""
        return np.array(self._core.camera()).reshape(4, 4)

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height that the scene asks for, in pixels."""
        return self._core.resolution()

    @property
    def samples_per_pixel(self) -> int:
        """As it was built."""
        return self._core.samples_per_pixel()

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What was said of it so far."""
        return diagnostics_of(self._core.said())


def _matrix(camera: Any) -> Optional[list[float]]:
    if camera is None:
        return None
    try:
        matrix = np.asarray(camera, dtype=np.float64)
    except (TypeError, ValueError):
        raise UsageError("camera: a matrix of 4 x 4 numbers is needed") from None
    if matrix.shape != (4, 4):
        raise UsageError(f"camera: a matrix of 4 x 4 numbers is needed, not {' x '.join(map(str, matrix.shape))}")
    return [float(x) for x in matrix.ravel()]


def _size(resolution: Optional[Sequence[int]]) -> Optional[list[int]]:
    if resolution is None:
        return None
    size = list(resolution)
    if len(size) != 2:
        raise UsageError("resolution: needs width and height")
    return [_arguments.whole("resolution", n, 1, 65536) or 1 for n in size]


def look_at(eye: Sequence[float], at: Sequence[float], up: Sequence[float]) -> np.ndarray:
    """4 x 4 from world to camera, for columns: at `eye`, looking at `at`, with `up` in the picture's upper half. What
    pbrt's LookAt makes.

    >>> import whit
    >>> whit.look_at((0, 0, -4), (0, 0, 0), (0, 1, 0)) @ [1, 2, 3, 1]
    array([1., 2., 7., 1.])

    Raises UsageError where these make no view.
    """
    eye_, ahead = np.asarray(eye, dtype=np.float64), np.asarray(at, dtype=np.float64) - np.asarray(eye, dtype=np.float64)
    right = np.cross(np.asarray(up, dtype=np.float64), ahead)
    lengths = np.linalg.norm(ahead), np.linalg.norm(right)
    if not (np.isfinite(lengths).all() and min(lengths) > 0):
        raise UsageError("look_at: eye and at must be apart, and up must point elsewhere than from one to the other")
    ahead, right = ahead / lengths[0], right / lengths[1]
    turned = np.stack([right, np.cross(ahead, right), ahead])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turned, -turned @ eye_
    return matrix
