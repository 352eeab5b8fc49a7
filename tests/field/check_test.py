#!/usr/bin/env python3
"""`whit check` says all that a render says: each scene here has one mistake that only a render used to find."""
import os
import re
import subprocess
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
WHIT = os.environ.get("WHIT")
HEAD = '''Camera "perspective"
Film "image" "integer xresolution" 8 "integer yresolution" 8 "string filename" "x.exr"
WorldBegin
LightSource "point" "rgb I" [9 9 9]
Translate 0 0 5
'''
TRIANGLE = 'Shape "trianglemesh" "integer indices" [%s] "point P" [0 0 0 1 0 0 0 1 0]'


@unittest.skipUnless(WHIT, "the program is not built")
class Check(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="whit check ")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.write("bad.png", "text, not a picture")
        # The signature and header of a picture of 1 x 1 pixels (RFC 2083, 11.2.1), and nothing behind it.
        self.write("cut.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\b\2\0\0\0\x90wS\xde")
        self.write("cut.exr", b"\x76\x2f\x31\x01\x02\0\0\0channels\0")
        self.write("bad.ply", "junk")
        self.write("bad.dat", "a b c")
        self.write("bad.bsdf", "junk")

    def write(self, name, content):
        with open(os.path.join(self.folder, name), "wb") as f:
            f.write(content if isinstance(content, bytes) else content.encode())

    def run_whit(self, *arguments):
        done = subprocess.run([WHIT, *arguments], cwd=self.folder, capture_output=True, text=True, check=False, timeout=60,
                              stdin=subprocess.DEVNULL)
        said = re.findall(r"^(s\.pbrt:\d+:\d+): (?:error|warning): (.*)$", done.stderr, re.M)
        return done.returncode, said, done.stderr

    def same(self, name, statements, head=HEAD, ball='\nShape "sphere"\n'):
        """That both say the same, once, and that check says no."""
        with self.subTest(name):
            self.write("s.pbrt", head + statements + ball + "WorldEnd\n")
            checked, said_by_check, words = self.run_whit("check", "s.pbrt")
            _, said_by_render, _ = self.run_whit("s.pbrt", "--quiet", "--display", "none")
            self.assertEqual(checked, 1, words)
            self.assertEqual(len(said_by_render), 1, said_by_render)
            self.assertEqual(said_by_check, said_by_render)

    def test_files(self):
        texture = 'Texture "t" "color" "imagemap" "string filename" "%s" Material "matte" "texture Kd" "t"'
        for name in ("bad.png", "cut.png", "cut.exr", "gone.png"):
            self.same(name, texture % name)
        self.same("alpha", 'Texture "t" "float" "imagemap" "string filename" "cut.png"', ball='Shape "disk" "texture alpha" "t"\n')
        self.same("ply", 'Shape "plymesh" "string filename" "bad.ply"')
        self.same("bsdf", 'Material "fourier" "string bsdffile" "bad.bsdf"')
        self.same("lens", "", HEAD.replace('"perspective"', '"realistic" "string lensfile" "bad.dat"'))
        for light, parameter in (("infinite", "mapname"), ("projection", "mapname"), ("goniometric", "mapname"), ("skybox", "mapname")):
            self.same(light, 'LightSource "%s" "string %s" "bad.png"' % (light, parameter))

    def test_geometry(self):
        self.same("degenerate", TRIANGLE % "0 1 1")
        self.same("coincident", 'Shape "sphere"')
        self.same("empty", 'Shape "trianglemesh" "integer indices" [0 1 2]')

    def test_the_film(self):
        self.same("extension", "", HEAD.replace("x.exr", "x.bmp"))
        self.same("folder", "", HEAD.replace("x.exr", "nowhere/x.exr"))
        self.same("view", "", HEAD.replace('"x.exr"', '"x.exr" "string view" "nonsense"'))
        # What a flag names instead is none of the scene's business.
        self.write("s.pbrt", HEAD.replace("x.exr", "x.bmp") + 'Shape "sphere"\nWorldEnd\n')
        self.assertEqual(self.run_whit("s.pbrt", "--quiet", "--outfile", "y.exr", "--display", "none"), (0, [], ""))

    def test_surprises(self):
        self.same("media", 'MakeNamedMedium "m" "string type" "homogeneous" MediumInterface "m" ""')
        with open(os.path.join(HERE, "no-lights.pbrt"), encoding="utf-8") as f:
            self.same("no lights", "", f.read().replace("WorldEnd\n", ""), ball="")

    def test_what_is_right(self):
        self.write("s.pbrt", HEAD + 'Shape "sphere"\nWorldEnd\n')
        self.assertEqual(self.run_whit("check", "s.pbrt"), (0, [], ""))


if __name__ == "__main__":
    unittest.main()
