#!/usr/bin/env python3
"""The models of Debian's package assimp-testmodels: each renders, or is refused for a reason that is right.

    tests/gltf/public_models_test.py [--table]     --table prints the table of docs/gltf.md

What is expected of the wrong ones is below, with what is wrong with each; all others make a picture, in which something is seen.
Skipped where the package is not installed.
"""
import glob
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import pixels  # noqa: E402

WHIT = os.path.abspath(os.environ.get("WHIT", "build/release/whit"))
ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
MODELS = "/usr/share/assimp/models"

# The part of the message that names what is wrong.
REFUSED = {
    "glTF2/BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf": 'requires the extension "KHR_technique_webgl"',
    "glTF2/IncorrectVertexArrays/Cube.gltf": "/bufferViews/2: ends at byte 936 of a buffer of 514 bytes",
    "glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf": "/meshes/0/primitives/0/indices: ",
    "glTF2/IndexOutOfRange/IndexOutOfRange.gltf": "/meshes/0/primitives/0/indices: ",
    "glTF2/MissingBin/BoxTextured.gltf": "/buffers/0/uri: cannot open",
    "glTF2/RecursiveNodes/RecursiveNodes.gltf": "/nodes/0: is its own ancestor",
    "glTF2/SchemaFailures/sceneWrongType.gltf": "/scene: must be a whole number",
    "glTF2/TestNoRootNode/NoScene.gltf": "/scene: is 0, and the file has no scenes",
    "glTF2/wrongTypes/badArray.gltf": "/meshes/0/primitives: must be an array",
    "glTF2/wrongTypes/badExtension.gltf": "KHR_texture_transform: must be an object",
    "glTF2/wrongTypes/badNumber.gltf": "/materials/0/normalTexture/scale: must be a number",
    "glTF2/wrongTypes/badObject.gltf": "/materials/0/pbrMetallicRoughness: must be an object",
    "glTF2/wrongTypes/badString.gltf": "/scenes/0/name: must be a string",
    "glTF2/wrongTypes/badUint.gltf": "/materials/0/pbrMetallicRoughness/baseColorTexture/index: must be at least 0",
}
# Points and lines, which are not shown, a scene without nodes, and a box of infinite size: the sky is seen alone.
EMPTY = [f"Mesh_PrimitiveMode_{i:02}.gltf" for i in (0, 1, 2, 3, 7, 8, 9, 10)] + ["SceneWithoutNodes.gltf", "BoxWithInfinites.glb"]
OLD = "glTF 1.0 is not read"  # all of the folder glTF


def render(path, folder):
    """Exit code and messages, the path in them shortened."""
    done = subprocess.run([WHIT, path, "--quick", "--display", "none", "-o", os.path.join(folder, "out.exr")], capture_output=True, text=True,
                          timeout=120)
    return done.returncode, done.stderr.replace(MODELS + "/", "")


def models():
    return sorted(os.path.relpath(p, MODELS) for ending in ("gltf", "glb") for p in glob.glob(f"{MODELS}/**/*.{ending}", recursive=True))


def row(name, folder):
    code, said = render(os.path.join(MODELS, name), folder)
    if code == 0:
        return f"| {name} | rendered |"
    reason = next(line for line in said.split("\n") if line.startswith("error: "))
    reason = reason.removeprefix("error: ").removeprefix(name + ": ")
    reason = re.sub(r'cannot open "[^"]*/', 'cannot open "', reason)
    return f"| {name} | {reason.replace('|', '/')} |"


class PublicModelsTest(unittest.TestCase):
    def test_each_renders_or_gives_its_reason(self):
        found = models()
        self.assertEqual(len(found), 53)
        with tempfile.TemporaryDirectory() as folder:
            for name in found:
                with self.subTest(model=name):
                    code, said = render(os.path.join(MODELS, name), folder)
                    reason = OLD if name.startswith("glTF/") else REFUSED.get(name)
                    if reason:
                        self.assertIn(code, (3, 4), said)
                        self.assertIn(reason, said)
                    else:
                        self.assertEqual(code, 0, said)
                        picture = pixels(os.path.join(folder, "out.exr"))
                        self.assertTrue(np.isfinite(picture).all())
                        # The sky is a gradient of some steps a pixel; edges of things are more.
                        self.assertGreater(np.abs(np.diff(picture, axis=1)).max(), 0 if name.split("/")[-1] in EMPTY else 0.05)

    def test_the_table_of_the_page_is_of_today(self):
        with open(os.path.join(ROOT, "docs", "gltf.md")) as f:
            page = f.read()
        with tempfile.TemporaryDirectory() as folder:
            for name in models():
                self.assertIn(row(name, folder), page)


if __name__ == "__main__":
    if not os.path.isdir(MODELS):
        print("assimp-testmodels is not installed")
        sys.exit(77)
    if sys.argv[1:] == ["--table"]:
        with tempfile.TemporaryDirectory() as out:
            print("| model | |\n|---|---|\n" + "\n".join(row(name, out) for name in models()))
    else:
        unittest.main()
