"""Renders pbrt-v3 scenes and glTF models, and says what pictures cost and whether they differ.

>>> import whit
>>> scene = '''
... Film "image" "integer xresolution" 32 "integer yresolution" 16
... LookAt 0 0 -4  0 0 0  0 1 0
... Camera "perspective" "float fov" 40
... WorldBegin
... LightSource "infinite"
... Shape "sphere"
... WorldEnd
... '''
>>> picture = whit.render(scene, spp=4)
>>> picture.pixels.shape, str(picture.pixels.dtype)
((16, 32, 3), 'float32')

Pictures have the same bits as those of the command `whit` of the same build. Wherever a function takes a scene, a
`pathlib.Path` is a file, and so is a str; but a str that has several lines, or the word WorldBegin, is a scene's text.

Errors are exceptions: `whit.SceneError`, `whit.FileError`, `whit.UsageError` and `whit.LimitError`, all of them
`whit.Error`, with what there is to say of the scene in `diagnostics`.
"""
from whit import _processor

# Before the extension module is loaded, which would end Python by an illegal instruction.
if _processor.lacks():
    raise ImportError(f"whit: this processor has no {', '.join(_processor.lacks())}, which this module is compiled for "
                      f"({_processor.architecture()}); build it on this machine (docs/python.md)")

from whit import _examples as _examples  # noqa: E402
from whit._compare import Comparison, diff, measures  # noqa: E402
from whit._errors import Diagnostic, Error, FileError, LimitError, SceneError, UsageError  # noqa: E402
from whit._inquiries import aovs, check, cost, effects, explain  # noqa: E402
from whit._picture import Picture  # noqa: E402
from whit._scene import Scene, look_at, render  # noqa: E402
from whit._whit import version as _version  # noqa: E402

__version__ = _version()
__all__ = ["Comparison", "Diagnostic", "Error", "FileError", "LimitError", "Picture", "Scene", "SceneError", "UsageError",
           "aovs", "check", "cost", "diff", "effects", "explain", "look_at", "measures", "render"]
