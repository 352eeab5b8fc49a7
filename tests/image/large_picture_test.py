#!/usr/bin/env python3
"""Pictures that are larger than memory may be: levels that do not fit go to a file, and the rendering is the same; where a
picture has to be in memory whole, it is refused with the figure. Sides are no powers of two: such pictures are enlarged.
"""
import json
import os
import re
import struct
import subprocess
import tempfile
import unittest
import zlib

WHIT = os.environ.get("WHIT")
SANITIZED = os.environ.get("WHIT_SANITIZE")
MIB = 1 << 20

SCENE = """
Film "image" "integer xresolution" [64] "integer yresolution" [64] "string filename" ["x.exr"]
Sampler "halton" "integer pixelsamples" [1]
LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic"
WorldBegin
LightSource "distant" "point from" [0 0 1] "point to" [0 0 0]
Texture "t" "spectrum" "imagemap" "string filename" "%s" "float uscale" %g "float vscale" %g
Material "matte" "texture Kd" "t"
Shape "trianglemesh" "point P" [-2 -2 0 2 -2 0 2 2 0 -2 2 0] "float uv" [0 0 1 0 1 1 0 1] "integer indices" [0 1 2 0 2 3]
WorldEnd
"""
LIGHT = SCENE.replace("WorldEnd", 'LightSource "%s" "string mapname" "%s"\nWorldEnd').replace('"%s" "float u', '"small.png" "float u')


def png(path, width, height, interlaced=False):
    """Colours by place; of rows that are alike 64 times over, so that it is made soon."""
    pack = zlib.compressobj(1)

    def chunk(f, kind, body):
        f.write(struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)))

    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n")
        chunk(f, b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, int(interlaced)))
        if interlaced:  # Damaged, but who would take memory for it does so before that shows.
            chunk(f, b"IDAT", bytes(MIB))
        else:
            for y in range(height):
                if y % 64 == 0:
                    row = b"\0" + (bytes(((y // 64 * 5 + c * 80) % 256 for c in range(3))) * 7 + bytes(9) * 3) * (width // 16 + 1)
                    row = row[:1 + 3 * width]
                part = pack.compress(row)
                if part:
                    chunk(f, b"IDAT", part)
            chunk(f, b"IDAT", pack.flush())
        chunk(f, b"IEND", b"")


@unittest.skipUnless(WHIT, "the program is not built")
class LargePictures(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(dir="/var/tmp")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        png(self.path("small.png"), 20, 20)

    def path(self, name):
        return os.path.join(self.folder, name)

    def render(self, text, *flags, scratch="/var/tmp"):
        """The process, and its peak in MiB."""
        with open(self.path("s.pbrt"), "w", encoding="utf-8") as f:
            f.write(text)
        stats = self.path("stats.json")
        if os.path.exists(stats):
            os.remove(stats)
        done = subprocess.run([WHIT, "s.pbrt", "--quiet", "--display", "none", "--type", "float", "--stats", stats, *flags],
                              cwd=self.folder, capture_output=True, text=True, check=False, env={**os.environ, "TMPDIR": scratch})
        if done.returncode != 0:
            return done, 0
        with open(stats, encoding="utf-8") as f:
            return done, json.load(f)["memory_peak_bytes"] / MIB

    def pixels(self, name):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        return oiio.ImageBuf(self.path(name)).get_pixels(oiio.FLOAT)

    def test_levels_that_do_not_fit_go_to_a_file_and_the_picture_is_the_same(self):
        # 4000 x 5000 become 4096 x 8192: 6 bytes for each texel, and a third more, are 256 MiB.
        png(self.path("t.png"), 4000, 5000)
        for scale in (0.01, 40):  # level 0, and far from it
            text = SCENE % ("t.png", scale, scale)
            _, much = self.render(text, "-o", "much.exr")
            done, little = self.render(text, "--texture-memory", "16", "-o", "little.exr")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(int((self.pixels("much.exr").view("uint32") != self.pixels("little.exr").view("uint32")).sum()), 0)
            if not SANITIZED:
                self.assertLess(little, 160)
                self.assertGreater(much, 256 if scale < 1 else 0)
        # Without a place for the file all must be in memory, if there is as much.
        text = SCENE % ("t.png", 0.01, 0.01)
        self.render(text, "-o", "much.exr")
        done, _ = self.render(text, "--texture-memory", "16", "-o", "nowhere.exr", scratch="/nowhere/at/all")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(int((self.pixels("much.exr").view("uint32") != self.pixels("nowhere.exr").view("uint32")).sum()), 0)
        if SANITIZED:
            return
        done, _ = self.render(text, "--texture-memory", "16", "--max-memory", "250M", "-o", "no.exr", scratch="/nowhere/at/all")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertRegex(done.stderr, r"s.pbrt:8:\d+: error: cannot read image \".*t.png\": decoding its 4000 x 5000 pixels takes "
                                      r"\d+ MiB of memory; of 250 MiB at most \(--max-memory\) \d+ MiB are taken")
        self.assertFalse(os.path.exists(self.path("no.exr")))

    def test_nine_hundred_million_pixels(self):
        # Seen from afar, of all levels only the coarse ones are kept.
        png(self.path("t.png"), 30000, 30000)
        done, peak = self.render(SCENE % ("t.png", 20, 20), "--texture-memory", "64")
        self.assertEqual(done.returncode, 0, done.stderr)
        if not SANITIZED:
            self.assertLess(peak, 200)

    def test_what_has_to_be_whole_is_refused_with_the_figure(self):
        png(self.path("whole.png"), 20000, 20000, interlaced=True)
        done, _ = self.render(SCENE % ("whole.png", 20, 20), "--max-memory", "1G")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertRegex(done.stderr, r"s.pbrt:8:\d+: error: .* takes (about )?[\d.]+ [MG]iB of memory")
        for light in ("infinite", "skybox"):
            done, _ = self.render(LIGHT % (1, 1, light, "whole.png"), "--max-memory", "1G")
            self.assertEqual(done.returncode, 5, done.stderr)
            self.assertRegex(done.stderr, r"s.pbrt:11:1: error: .* takes about [\d.]+ [MG]iB of memory, more than 1024 MiB")

    def test_pictures_to_compare(self):
        png(self.path("a.png"), 60000, 50000, interlaced=True)  # 36 GB as floats, and 9 as they are
        done = subprocess.run([WHIT, "diff", "a.png", "a.png"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, r"cannot read image \"a.png\": reading all of its 60000 x 50000 pixels takes 41.9 GiB")


if __name__ == "__main__":
    unittest.main()
