#!/usr/bin/env python3
"""--keep-going with files that are there and broken: each is an error, said once; what used the file gets what it would
get were the file missing; and without the flag there is no picture.
"""
import os
import re
import struct
import subprocess
import tempfile
import unittest
import zlib

WHIT = os.environ.get("WHIT")
FIELD = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "field"))
SCENE = """Camera "perspective" "float fov" 40
Film "image" "integer xresolution" 16 "integer yresolution" 16
Sampler "halton" "integer pixelsamples" 4
Integrator "whitted"
WorldBegin
LightSource "point" "rgb I" [20 20 20]
%s
Translate 0 0 5
%s
WorldEnd
"""
SPHERE = 'Shape "sphere"'
COLOUR = 'Texture "t" "color" "imagemap" "string filename" "%s"\n'
NUMBER = 'Texture "t" "float" "imagemap" "string filename" "%s"\n'
TRIANGLE = 'Shape "trianglemesh" "integer indices" [0 1 2] "point P" [-1 -1 0  1 -1 0  0 1 0] '
# What uses a picture, and what the scene is without it: material and shape.
PICTURES = {
    "colour": (COLOUR + 'Material "matte" "texture Kd" "t"', SPHERE, "", SPHERE),
    # The plan of a scene of mirrors has no light in it, but the default material needs some.
    "mirror": (COLOUR + 'Material "mirror" "texture Kr" "t"', SPHERE, "", SPHERE),
    "bump": (NUMBER + 'Material "mirror" "texture bumpmap" "t"', SPHERE, "", SPHERE),
    "inside another": (COLOUR + 'Texture "s" "color" "scale" "texture tex1" "t" "rgb tex2" [.5 .5 .5]\n'
                       'Material "mirror" "texture Kr" "s"', SPHERE, "", SPHERE),
    "in a mix": (COLOUR + 'MakeNamedMaterial "a" "string type" "mirror" "texture Kr" "t"\n'
                 'MakeNamedMaterial "b" "string type" "mirror"\n'
                 'Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b"', SPHERE, "", SPHERE),
    "alpha": (NUMBER, TRIANGLE + '"texture alpha" "t" ' + SPHERE, "", SPHERE),
    "a shape's own": (COLOUR + 'Material "mirror"', SPHERE + ' "texture Kr" "t"', "", SPHERE),
    "sky": ('LightSource "infinite" "string mapname" "%s"', SPHERE, "", SPHERE),
    "skybox": ('LightSource "skybox" "string mapname" "%s"', SPHERE, "", SPHERE),
    "projection": ('LightSource "projection" "string mapname" "%s"', SPHERE, "", SPHERE),
    "goniometric": ('LightSource "goniometric" "string mapname" "%s"', SPHERE, "", SPHERE),
}
POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n"


def png_without_rows():
    """Signature and header of a good PNG, and then nothing."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 2, 0, 0, 0))


@unittest.skipUnless(WHIT, "the program is not built")
class KeepGoing(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def write(self, name, data):
        with open(os.path.join(self.folder, name), "wb") as f:
            f.write(data if isinstance(data, bytes) else data.encode())
        return name

    def whit(self, scene, *flags):
        done = subprocess.run([WHIT, scene, "--display", "none", "-o", "out.pfm", *flags], capture_output=True, text=True,
                              check=False, cwd=self.folder, stdin=subprocess.DEVNULL, timeout=60)
        return done.returncode, done.stderr

    def picture(self):
        path = os.path.join(self.folder, "out.pfm")
        if not os.path.exists(path):
            return None
        with open(path, "rb") as f:
            data = f.read()
        os.remove(path)
        return data

    def kept_going(self, scene):
        """The picture of a scene with one error, which is said once and stops the render without the flag."""
        code, said = self.whit(scene, "--quiet")
        self.assertIn(code, (3, 4), said)
        self.assertEqual(len(re.findall(r"(?m): error: ", said)), 1, said)
        self.assertIsNone(self.picture())
        code, said = self.whit(scene, "--keep-going")
        self.assertEqual(code, 0, said)
        self.assertEqual(len(re.findall(r"(?m): error: ", said)), 1, said)
        self.assertRegex(said, r"not the whole scene: 1 error was passed over")
        return self.picture()

    def test_pictures(self):
        os.mkdir(os.path.join(self.folder, "folder.png"))
        files = ["missing.png", "folder.png", self.write("text.png", "this is not a picture\n"), self.write("empty.png", b""),
                 self.write("empty.exr", b""), self.write("pointer.png", POINTER), self.write("pointer.exr", POINTER)]
        for name, (world, shape, world_without, shape_without) in PICTURES.items():
            self.assertEqual(self.whit(self.write("plain.pbrt", SCENE % (world_without, shape_without)), "--quiet"), (0, ""))
            plain = self.picture()
            for file in files if name == "mirror" else ("missing.png", "text.png", "pointer.exr"):
                with self.subTest(use=name, file=file):
                    scene = self.write("scene.pbrt", SCENE % (world % file, shape))
                    self.assertEqual(self.kept_going(scene), plain)

    def test_rows_that_cannot_be_read(self):
        # Found out when the first ray asks for the picture, which is then black: the sphere is lit by nothing but the lamp.
        file = self.write("cut.png", png_without_rows())
        for name, (world, shape, _, _) in PICTURES.items():
            with self.subTest(name):
                self.assertIsNotNone(self.kept_going(self.write("scene.pbrt", SCENE % (world % file, shape))))

    def test_other_files(self):
        plain = SCENE % ("", SPHERE)
        self.whit(self.write("plain.pbrt", plain), "--quiet")
        picture = self.picture()
        for file in ("missing", self.write("text", "this is no such thing\n"), self.write("empty", b""),
                     self.write("pointer", POINTER)):
            with self.subTest(file=file):
                bsdf = SCENE % ('Material "fourier" "string bsdffile" "%s"' % file, SPHERE)
                self.assertEqual(self.kept_going(self.write("scene.pbrt", bsdf)), picture)
                mesh = SCENE % ("", 'Shape "plymesh" "string filename" "%s" ' % file + SPHERE)
                self.assertEqual(self.kept_going(self.write("scene.pbrt", mesh)), picture)
                # Nothing can be seen without a lens.
                lens = re.sub("^Camera.*", 'Camera "realistic" "string lensfile" "%s"' % file, plain)
                code, said = self.whit(self.write("scene.pbrt", lens), "--keep-going")
                self.assertEqual(code, 3, said)
                self.assertEqual(len(re.findall(": error: ", said)), 1, said)
                self.assertIsNone(self.picture())

    def test_nothing_is_seen_without_what_every_picture_needs(self):
        # Found by the mutator: memory was estimated of a filter that was none.
        plain = SCENE % ("", SPHERE)
        for statement in ('Film "image" "integer xresolution" -3', 'PixelFilter "mitchell" "float xwidth" -0.1',
                          'PixelFilter "sinc" "float ywidth" -2', 'Camera "perspective" "float fov" 400',
                          'Sampler "random" "integer pixelsamples" -1'):
            with self.subTest(statement):
                text = re.sub("(?m)^%s .*" % statement.split()[0], "", plain)
                code, said = self.whit(self.write("scene.pbrt", text.replace("WorldBegin", statement + "\nWorldBegin")),
                                       "--keep-going", "--quiet")
                self.assertEqual(code, 3, said)
                self.assertEqual(len(re.findall("error: ", said)), 1, said)
                self.assertIsNone(self.picture())

    def test_each_problem_is_said_once(self):
        # A file that does not parse is reported whole, and planned again to go on.
        text = SCENE % ('Rotate 1 0 0 0\nMaterial "matte" "float sigma" -1e400 "rgb kd" [1 1 1]\n'
                        'Texture "t" "color" "nope"', 'Shape "sphere" "float radius" -1 ' + SPHERE)
        code, said = self.whit(self.write("scene.pbrt", text), "--keep-going", "--quiet")
        self.assertEqual(code, 0)
        lines = re.findall(r"(?m)^scene.pbrt:\d.*: (?:error|warning): .*$", said)
        self.assertGreaterEqual(len(lines), 4)
        self.assertEqual(len(lines), len(set(lines)), said)

    def test_worlds_of_one_file_say_it_once(self):
        # Both worlds include the same statement.
        self.write("part.pbrt", 'Shape "plymesh" "string filename" "gone.ply"\nMaterial "matte" "rgb kd" [1 1 1]\n')
        world = SCENE % ('Include "part.pbrt"', SPHERE)
        code, said = self.whit(self.write("scene.pbrt", world + world), "--keep-going", "--quiet")
        self.assertEqual(code, 0, said)
        lines = re.findall(r"(?m)^part.pbrt:\d.*: (?:error|warning): .*$", said)
        self.assertEqual(len(lines), 2, said)

    def test_the_file_met_in_the_field(self):
        for name in ("keep-going-unreadable-picture.pbrt", "not-a-picture.png"):
            with open(os.path.join(FIELD, name), "rb") as f:
                self.write(name, f.read())
        self.assertIsNotNone(self.kept_going("keep-going-unreadable-picture.pbrt"))


if __name__ == "__main__":
    unittest.main()
