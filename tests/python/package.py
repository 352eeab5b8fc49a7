"""Finds the package in the portable build (PYTHONPATH comes first), and the program of that build, whose pictures it has."""
import os
import sys

ROOT = os.environ.get("WHIT_SOURCE_DIR") or os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
BUILD = os.path.join(ROOT, "build", "portable")
WHIT = os.path.join(BUILD, "whit")
FOLDER = os.path.join(BUILD, "python")

sys.path.append(FOLDER)
try:
    import whit  # noqa: F401
except ImportError as problem:
    sys.exit("%s: build it first: cmake --preset portable && ninja -C build/portable whit whit_python" % problem)

# A ball under a lamp that throws soft shadows, sampled at random; 40 x 30 pixels.
SCENE = """\
Film "image" "integer xresolution" [40] "integer yresolution" [30] "string filename" ["film-name.exr"]
Sampler "random" "integer pixelsamples" [4]
LookAt 0 2 6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [35]
WorldBegin
  AttributeBegin
    AreaLightSource "diffuse" "rgb L" [8 8 8]
    Translate 0 4 1
    Rotate 90 1 0 0
    Shape "disk" "float radius" [1]
  AttributeEnd
  Material "matte" "rgb Kd" [0.6 0.3 0.2]
  Shape "sphere" "float radius" [1]
  Material "matte" "rgb Kd" [0.5 0.5 0.5]
  Translate 0 -1 0
  Rotate -90 1 0 0
  Shape "disk" "float radius" [6]
WorldEnd
"""
# Of many samples: long enough to be interrupted, whatever the machine.
LONG = SCENE.replace('"integer pixelsamples" [4]', '"integer pixelsamples" [1000000]')
