"""What can be asked of a scene without having its picture."""
from __future__ import annotations

import json
from typing import Any, Callable, Optional, Sequence

from whit import _arguments, _whit
from whit._arguments import NameOrNumber, PathOrText
from whit._errors import Diagnostic, diagnostics_of
from whit._scene import plan_arguments


def check(scene: PathOrText, *, allow: Sequence[str] = (), also: Sequence[str] = (), model_scene: NameOrNumber = None,
          model_camera: NameOrNumber = None, model_time: Optional[float] = None, model_variant: NameOrNumber = None,
          allow_outside: bool = False) -> list[Diagnostic]:
    """Everything wrong with a scene, and what it does that its author hardly meant, as `whit check` finds it.

    >>> import whit
    >>> scene = whit._examples.SPHERE.replace('"sphere"', '"sphere" "float raduis" 2')
    >>> for found in whit.check(scene):
    ...     print(found.severity, found.line, found.message, found.remedy, sep="; ")
    warning; 8; sphere has no parameter "raduis"; did you mean "radius"?

    `allow` leaves findings of these names out (no error can be), `also` looks for what is not looked for by default.
    `model_scene` and so on are those of `render`. An empty list is a scene that is right. Errors of the scene are in the
    list; it raises UsageError alone.
    """
    model = _arguments.model(dict(locals()))
    return diagnostics_of(_whit.check(_arguments.source(scene), model, _arguments.names("allow", allow),
                                      _arguments.names("also", also)))


def explain(scene: PathOrText, *, memory: bool = False, integrator: Optional[str] = None,
            sampler: Optional[str] = None, maxdepth: Optional[int] = None, rrthreshold: Optional[float] = None,
            lights: Optional[str] = None, texture_filter: Optional[str] = None,
            without: Optional[Sequence[str]] = None, only: Optional[Sequence[str]] = None,
            model_scene: NameOrNumber = None, model_camera: NameOrNumber = None, model_time: Optional[float] = None,
            model_variant: NameOrNumber = None, allow_outside: bool = False) -> dict[str, Any]:
    """The effect plan: what is simulated, what called for it, and what is left out, with the keys of `whit explain
    --json`; with `memory` each world has the bytes that rendering it is going to take under "memory", too. The other
    arguments are those of `render`.

    >>> import whit
    >>> world, = whit.explain(whit._examples.SPHERE)["worlds"]
    >>> [e["effect"] for e in world["effects"] if e["on"]]
    ['diffuse', 'delta-lights', 'shadows']

    Raises SceneError, FileError, UsageError.
    """
    given = dict(locals())
    return _whit.explain(_arguments.source(scene), {**plan_arguments(given), **_arguments.model(given)}, bool(memory))


def cost(scene: PathOrText, *, seconds: float = 60, quick: bool = False, all_samplers: bool = False, threads: int = 0,
         seed: int = 0, html: Any = None, progress: Optional[Callable[[float], Any]] = None,
         model_scene: NameOrNumber = None, model_camera: NameOrNumber = None, model_variant: NameOrNumber = None,
         allow_outside: bool = False) -> dict[str, Any]:
    """What accuracy costs in time: measures for `seconds`, all in all, and returns the keys of `whit cost --json`.

    scene: a path, or a text, as those of `render`.
    quick: samples alone, no other settings, no effects. all_samplers: every sampler.
    threads: 0 for one per core; it holds for the whole process meanwhile. seed: of the first picture, 0 to 2**32 - 1.
    html: a file for the report as a page.
    progress: as that of `render`; when it returns False the report has what was measured by then.
    model_scene, model_camera, model_variant, allow_outside: as those of `render`.

    Times are of the renders in this process: those of the command have its start on top, some 10 ms.

    Raises SceneError, FileError, UsageError.
    """
    model = _arguments.model(dict(locals()))
    options = {
        **model, "seconds": _arguments.real("seconds", seconds, above=0), "quick": bool(quick),
        "all_samplers": bool(all_samplers), "threads": _arguments.whole("threads", threads, 0, 4096),
        "seed": _arguments.whole("seed", seed, 0, (1 << 32) - 1), "page": html is not None,
    }
    report, page = _whit.cost(_arguments.source(scene), options, progress)
    if html is not None:
        _arguments.write_text(html, page)
    return json.loads(report)


def aovs() -> list[str]:
    """Names of what pictures can hold beside their colours; `whit help aovs` says what they are.

    >>> import whit
    >>> "albedo" in whit.aovs()
    True
    """
    return _whit.aov_names()


def effects() -> list[str]:
    """Names of the effects that a scene can call for.

    >>> import whit
    >>> "shadows" in whit.effects()
    True
    """
    return _whit.effect_names()
