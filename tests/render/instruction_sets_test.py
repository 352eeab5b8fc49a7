#!/usr/bin/env python3
"""The portable build (x86-64-v3): it makes the same picture as the build for this machine, and under Valgrind, which counts
the instructions of the render loop, it takes no more of them than instruction_counts.json says, within 3 %.

The counts are those of Debian 12's compiler and libraries. They guard the work per sample: a change that adds to it fails,
and a change that saves some must lower them, with `tests/render/instruction_sets_test.py --store`.
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.environ.get("WHIT_SOURCE_DIR") or os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
NATIVE = os.environ.get("WHIT") or os.path.join(ROOT, "build", "release", "whit")
PORTABLE = os.path.join(ROOT, "build", "portable", "whit")
STORED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "instruction_counts.json")
TOLERANCE = 0.03

HEAD = """
Film "image" "integer xresolution" 48 "integer yresolution" 48
Sampler "halton" "integer pixelsamples" 4
Integrator "whitted" "integer maxdepth" 6
LookAt 0 -4 1.5  0 0 0  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
AttributeBegin
  Translate -2 -2.5 4
  AreaLightSource "diffuse" "rgb L" [60 58 52]
  Shape "sphere" "float radius" 0.5
AttributeEnd
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1]
"""
SCENES = {
    "plastic": HEAD + 'Material "plastic" "float roughness" 0.1 Shape "loopsubdiv" "integer levels" 3 "integer indices" '
               '[0 1 2 0 2 3 0 3 4 0 4 1 5 2 1 5 3 2 5 4 3 5 1 4] "point P" [0 0 1 1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 -1]\nWorldEnd\n',
    "glass": HEAD + 'Material "glass" Shape "sphere" "float radius" 0.9\n'
             'Material "mirror" Translate 1.2 1.2 0 Shape "sphere" "float radius" 0.7\nWorldEnd\n',
    "texture": HEAD + 'Texture "t" "color" "fbm" "integer octaves" 4 Texture "b" "float" "wrinkled"\n'
               'Material "uber" "texture Kd" "t" "texture bumpmap" "b" Shape "sphere" "float radius" 0.9\nWorldEnd\n',
    "path": HEAD.replace('"whitted" "integer maxdepth" 6', '"path"') + 'Material "plastic" "float roughness" 0.1\n'
            'AttributeBegin Shape "sphere" "float radius" 0.9 AttributeEnd\n'
            'Material "matte" Shape "sphere" "float radius" 7\nWorldEnd\n',
}


def run(*command):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode != 0:
        raise AssertionError("%s: exit %d\n%s" % (" ".join(command), done.returncode, done.stderr))
    return done


def instructions_per_sample(scene):
    """Of whit::render() and all it calls, on one thread."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.pbrt")
        with open(path, "w", encoding="utf-8") as f:
            f.write(SCENES[scene])
        done = run("valgrind", "--tool=callgrind", "--callgrind-out-file=" + os.path.join(folder, "out"),
                   "--toggle-collect=whit::render(whit::Scene const&, whit::RenderOptions const&)", PORTABLE, "render", path,
                   "--nthreads", "1", "--quiet", "--display", "none", "--outfile", os.path.join(folder, "out.exr"))
        return int(re.search(r"Collected : (\d+)", done.stderr).group(1)) / (48 * 48 * 4)


class InstructionSets(unittest.TestCase):
    def test_the_work_of_a_sample_has_not_grown(self):
        with open(STORED, encoding="utf-8") as f:
            stored = json.load(f)
        self.assertEqual(sorted(stored), sorted(SCENES))
        for scene, expected in stored.items():
            with self.subTest(scene):
                found = instructions_per_sample(scene)
                self.assertGreater(found, 100, "nothing was counted")
                self.assertLess(found, expected * (1 + TOLERANCE), "the work per sample has grown")
                self.assertGreater(found, expected * (1 - TOLERANCE), "less work: lower %s (--store)" % STORED)

    def test_the_picture_is_the_same(self):
        """Beyond rounding: a sample may fall on the other side of an edge, which moves one sample of a pixel."""
        with tempfile.TemporaryDirectory() as folder:
            for scene, text in SCENES.items():
                path = os.path.join(folder, scene + ".pbrt")
                with open(path, "w", encoding="utf-8") as f:
                    f.write(text)
                pictures = [os.path.join(folder, scene + name) for name in ("-native.exr", "-portable.exr")]
                for whit, picture in zip((NATIVE, PORTABLE), pictures):
                    run(whit, "render", path, "--quiet", "--display", "none", "--type", "float", "--outfile", picture)
                done = run(NATIVE, "diff", *pictures, "--relmse", "1e-6", "--json")
                self.assertTrue(json.loads(done.stdout)["same"], scene)


if __name__ == "__main__":
    if sys.argv[1:] == ["--store"]:
        with open(STORED, "w", encoding="utf-8") as out:
            json.dump({s: round(instructions_per_sample(s)) for s in SCENES}, out, indent=1)
            out.write("\n")
    else:
        unittest.main()
