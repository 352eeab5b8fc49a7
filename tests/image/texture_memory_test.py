#!/usr/bin/env python3
"""Texture memory stays under its cap, at no change of the picture, and a texture that no ray meets is not decoded."""
import os
import re
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
SANITIZED = os.environ.get("WHIT_SANITIZE")
COLUMNS, ROWS, SIDE = 10, 6, 512
# A pyramid keeps its 8-bit level, and 1/4 + 1/16 + ... = 1/3 as many texels in halves: 3 x 512^2 x (1 + 2/3) = 1.25 MiB,
# so the 20 that are seen close take 25 MiB. A cap of 4 has room for two of them, and for what reading a third takes.
CAP = 4

HEADER = """
Film "image" "integer xresolution" [320] "integer yresolution" [192] "string filename" ["x.exr"]
Sampler "halton" "integer pixelsamples" [1]
LookAt 5 3 10  5 3 0  0 1 0
Camera "orthographic" "float screenwindow" [-5 5 -3 3]
WorldBegin
LightSource "distant" "point from" [0 0 1] "point to" [0 0 0]
"""
QUAD = """
Texture "%(name)s" "spectrum" "imagemap" "string filename" ["%(name)s.png"] "float uscale" [%(scale)g] "float vscale" [%(scale)g]
Material "matte" "texture Kd" "%(name)s"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "float uv" [0 0 1 0 1 1 0 1]
  "point P" [%(x)g %(y)g %(z)g  %(x1)g %(y)g %(z)g  %(x1)g %(y1)g %(z)g  %(x)g %(y1)g %(z)g]
"""


def quad(name, x, y, z, scale):
    return QUAD % {"name": name, "x": x, "y": y, "z": z, "x1": x + 1, "y1": y + 1, "scale": scale}


@unittest.skipUnless(WHIT, "the program is not built")
class TextureMemory(unittest.TestCase):
    def setUp(self):
        import numpy  # pylint: disable=import-outside-toplevel
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.pictures = 0
        self.quads = ""
        y, x = numpy.mgrid[0:SIDE, 0:SIDE]
        for i in range(COLUMNS * ROWS):
            pixels = numpy.stack([(x * (i + 1)) % 256, (y * (i + 2)) % 256, (x ^ y) % 256], 2).astype(numpy.uint8)
            self.write_png("t%d" % i, pixels)
            # 32 pixels see a fifth of every third texture, in its finest level, and 1.2 times the others, 19 texels a pixel.
            self.quads += quad("t%d" % i, i % COLUMNS, i // COLUMNS, 0, 0.05 if i % 3 == 0 else 1.2)
        self.scene = self.write("scene.pbrt", HEADER + self.quads + "WorldEnd\n")

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as f:
            f.write(text)
        return self.path(name)

    def write_png(self, name, pixels):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        out = oiio.ImageOutput.create("x.png")
        spec = oiio.ImageSpec(SIDE, SIDE, 3, oiio.UINT8)
        spec.attribute("png:compressionLevel", 1)
        self.assertTrue(out.open(self.path(name + ".png"), spec) and out.write_image(pixels) and out.close())

    def render(self, scene, *flags, folder="/var/tmp"):
        """Pixels, peak resident size in MiB, and the statistics of textures."""
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        self.pictures += 1  # of a name used before, ImageBuf may remember the old pixels
        picture = self.path("%d.exr" % self.pictures)
        done = subprocess.run([WHIT, scene, "--outfile", picture, "--display", "none", "--type", "float", "--stats", *flags],
                              capture_output=True, text=True, check=False, cwd=self.folder, env={**os.environ, "TMPDIR": folder})
        self.assertEqual(done.returncode, 0, done.stderr)
        resident = re.search(r"peak memory (\d+) MiB", done.stderr)
        m = re.search(r"textures: .* lookups, (\d+) decodes .*, (\d+) trims, (\d+) evictions, (\d+) returns, peak ([\d.]+) (K|M)iB",
                      done.stderr)
        return oiio.ImageBuf(picture).get_pixels(oiio.FLOAT), int(resident[1]), (
            *(int(n) for n in m.groups()[:4]), float(m[5]) / (1024 if m[6] == "K" else 1))

    def test_the_cap_holds_and_the_picture_is_the_same(self):
        whole, whole_rss, (decodes, trims, evictions, _, _) = self.render(self.scene)
        self.assertEqual((decodes, trims, evictions), (COLUMNS * ROWS, 0, 0))
        self.assertGreater(float(whole.std()), 0.05)
        _, one_rss, _ = self.render(self.scene, "--cropwindow", "0", "0.05", "0", "0.05")  # one texture
        if not SANITIZED:
            self.assertGreater(whole_rss, one_rss + 18)
        for threads in (1, 2):
            capped, rss, (decodes, trims, evictions, returns, peak) = self.render(
                self.scene, "--texture-memory", str(CAP), "--nthreads", str(threads))
            self.assertEqual(int((capped.view("uint32") != whole.view("uint32")).sum()), 0)
            self.assertEqual(decodes, COLUMNS * ROWS)  # what there is no room for comes back from a file
            self.assertGreater(returns, 0)
            self.assertGreater(trims, 0)
            self.assertGreater(evictions, 0)
            # One that another thread is in the middle of may be dropped, but not freed.
            self.assertLess(peak, CAP + 1.25 * (threads - 1) + 0.5)
            if not SANITIZED:
                self.assertLess(rss, one_rss + 12)

    def test_without_a_place_for_the_file_they_are_decoded_again(self):
        whole, _, _ = self.render(self.scene)
        capped, _, (decodes, _, _, returns, peak) = self.render(
            self.scene, "--texture-memory", str(CAP), "--nthreads", "1", folder="/nowhere/at/all")
        self.assertEqual(int((capped.view("uint32") != whole.view("uint32")).sum()), 0)
        self.assertGreater(decodes, COLUMNS * ROWS)
        self.assertEqual(returns, 0)
        self.assertLess(peak, CAP + 0.5)

    def test_seen_from_afar_they_all_fit(self):
        # 32 pixels see 1.1 textures of 512, so that the finest level is log2(1.1 x 16) = 4, of 32 x 32 texels: all 60
        # take 60 x 3 x 2 x 32^2 x 4/3 = 0.5 MiB.
        scene = self.write("far.pbrt", HEADER + re.sub(r'scale" \[[\d.]+\]', 'scale" [1.1]', self.quads) + "WorldEnd\n")
        _, _, (decodes, _, evictions, _, peak) = self.render(scene, "--texture-memory", str(CAP), "--nthreads", "1")
        self.assertEqual((decodes, evictions), (COLUMNS * ROWS, 0))
        self.assertLessEqual(peak, CAP)

    def test_what_no_ray_meets_is_not_decoded(self):
        # Whole at its beginning, but without its pixels: whoever decodes it will notice.
        with open(self.path("t0.png"), "rb") as whole, open(self.path("cut.png"), "wb") as cut:
            cut.write(whole.read(4096))
        behind = self.write("behind.pbrt", HEADER + self.quads + quad("cut", 0, 0, -1, 1) + "WorldEnd\n")
        _, _, (decodes, _, _, _, _) = self.render(behind)
        self.assertEqual(decodes, COLUMNS * ROWS)
        before = self.write("before.pbrt", HEADER + self.quads + quad("cut", 0, 0, 1, 1) + "WorldEnd\n")
        done = subprocess.run([WHIT, before, "--outfile", self.path("y.exr")], capture_output=True, text=True, check=False,
                              cwd=self.folder)
        self.assertEqual(done.returncode, 4, done.stderr)
        line = (HEADER + self.quads).count("\n") + 2  # a quad's text begins with the end of a line
        self.assertRegex(done.stderr, r'before.pbrt:%d:\d+: error: cannot read image ".*cut.png"' % line)
        self.assertFalse(os.path.exists(self.path("y.exr")))
        # An account of a sample that met it would be one of a picture that is not the scene's.
        done = subprocess.run([WHIT, before, "--debug-pixel", "304,176"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (4, ""))
        self.assertRegex(done.stderr, r'before.pbrt:%d:\d+: error: cannot read image ".*cut.png"' % line)


if __name__ == "__main__":
    unittest.main()
