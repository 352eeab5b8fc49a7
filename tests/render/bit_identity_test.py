#!/usr/bin/env python3
"""The same bits: a picture does not depend on the run, the number of threads, or how it is cut into crops, also where a
wide filter makes pixels share samples.
"""
import os
import re
import subprocess
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
WHIT = os.environ.get("WHIT")
GAUSSIAN = 'PixelFilter "gaussian" "float xwidth" [2] "float ywidth" [2]\n'

# A mesh with a filtered checkerboard, a bump map and an image, seen with depth of field: ray differentials, the lens's
# dimensions, and the texture cache.
TEXTURES = """
Film "image" "integer xresolution" [150] "integer yresolution" [110] "string filename" ["x.exr"]
Sampler "halton" "integer pixelsamples" [4]
Integrator "whitted" "integer maxdepth" [5]
LookAt 0 2 6  0 1 0  0 1 0
Camera "perspective" "float fov" [40] "float lensradius" [0.05] "float focaldistance" [6]
WorldBegin
  LightSource "infinite" "string mapname" ["%(assets)s/%(sky)s"]
  LightSource "point" "rgb I" [20 20 20] "point from" [2 4 3]
  Texture "tiles" "spectrum" "checkerboard" "float uscale" [40] "float vscale" [40]
    "rgb tex1" [0.7 0.7 0.7] "rgb tex2" [0.1 0.1 0.2]
  Texture "waves" "float" "checkerboard" "float uscale" [9] "float vscale" [9] "float tex1" [0] "float tex2" [0.05]
  Texture "sky" "spectrum" "imagemap" "string filename" ["%(assets)s/%(sky)s"] "float uscale" [3]
  Material "plastic" "texture Kd" "tiles" "rgb Ks" [0.2 0.2 0.2]
  Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "float uv" [0 0  0 1  1 1  1 0]
    "point P" [-9 0 -30  -9 0 5  9 0 5  9 0 -30]
  Material "matte" "texture Kd" "sky" "texture bumpmap" "waves"
  Translate -1 1 0
  Shape "sphere"
  Translate 2.2 0 0
  Material "mirror"
  Shape "sphere"
WorldEnd
"""


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def with_gaussian(text):
    """A scene with a gaussian filter of radius 2 instead of its own."""
    text = re.sub(r"(?m)^PixelFilter .*\n", "", text)
    return re.sub(r"(?m)^Film ", lambda m: GAUSSIAN + m.group(), text, count=1)


@unittest.skipUnless(WHIT, "the program is not built")
class SameBits(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.count = 0

    def render(self, scene, *flags):
        """The pixels as bytes, their data window (x, y, width, height), and the display window's size."""
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        self.count += 1
        path = os.path.join(self.folder, "%d.exr" % self.count)
        done = subprocess.run([WHIT, scene, "--outfile", path, "--type", "float", "--quiet", "--display", "none", *flags],
                              capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        image = oiio.ImageBuf(path)
        spec = image.spec()
        self.assertEqual((spec.format, spec.nchannels), (oiio.FLOAT, 3))
        pixels = image.get_pixels(oiio.FLOAT)
        self.assertEqual(pixels.dtype.name, "float32")
        return pixels, (spec.x, spec.y, spec.width, spec.height), (spec.full_width, spec.full_height)

    def assert_same_bits(self, a, b, what):
        # Bits, not values: 0 == -0, and NaN is equal to nothing.
        different = (a.view("uint32") != b.view("uint32")).any(axis=2)
        self.assertEqual(int(different.sum()), 0, "%s: pixels differ, first at %s" % (what, tuple(zip(*different.nonzero()))[:1]))

    def verify(self, scene, *flags):
        """All of it for one scene. Returns the picture."""
        import numpy  # pylint: disable=import-outside-toplevel
        whole, window, full = self.render(scene, *flags)
        width, height = full
        self.assertEqual(window, (0, 0, width, height))
        self.assertGreater(float(whole.std()), 0.01)
        self.assert_same_bits(self.render(scene, *flags)[0], whole, "a second run")
        self.assert_same_bits(self.render(scene, *flags, "--nthreads", "1")[0], whole, "one thread")
        self.assert_same_bits(self.render(scene, *flags, "--nthreads", "2")[0], whole, "two threads")
        # Cut where no tile of 16 pixels ends: at 0.37 of the width, and at 0.61 of the height.
        for crops in (("0 0.37 0 1", "0.37 1 0 1"), ("0 1 0 0.61", "0 1 0.61 1")):
            stitched = numpy.full_like(whole, numpy.nan)
            covered = 0
            for crop in crops:
                part, (x, y, w, h), size = self.render(scene, *flags, "--cropwindow", *crop.split())
                self.assertEqual(size, full)
                self.assertLess(w * h, width * height)
                stitched[y:y + h, x:x + w] = part
                covered += w * h
            self.assertEqual(covered, width * height)
            self.assert_same_bits(stitched, whole, "crops " + " and ".join(crops))
        return whole

    def variants(self, text, *flags):
        """With the filter it has, and with a wide one."""
        scene = os.path.join(self.folder, "scene.pbrt")
        with open(scene, "w", encoding="utf-8") as f:
            f.write(text)
        own = self.verify(scene, *flags)
        with open(scene, "w", encoding="utf-8") as f:
            f.write(with_gaussian(text))
        wide = self.verify(scene, *flags)
        self.assertFalse((own == wide).all())  # the filter was replaced

    @staticmethod
    def smaller(name, width, height):
        """The text of a scene of ours, to be rendered from elsewhere, at another resolution."""
        text = read("%s/scenes/%s.pbrt" % (ROOT, name)).replace('Include "', 'Include "%s/scenes/' % ROOT)
        text, n = re.subn(r'"integer xresolution" \[\d+\] "integer yresolution" \[\d+\]',
                          '"integer xresolution" [%d] "integer yresolution" [%d]' % (width, height), text)
        assert n == 1
        return text

    def test_cornell_box(self):
        self.verify(ROOT + "/scenes/cornell-box.pbrt", "--spp", "2")
        self.variants(self.smaller("cornell-box", 230, 190), "--spp", "4")

    def test_glass(self):
        self.variants(self.smaller("sky-gradient-glass", 230, 150), "--spp", "4")

    def test_textures_and_lens(self):
        assets = ROOT + "/scenes/assets"
        sky = sorted(f for f in os.listdir(assets) if f.endswith((".exr", ".hdr", ".pfm")))[0]
        self.variants(TEXTURES % {"assets": assets, "sky": sky})


if __name__ == "__main__":
    unittest.main()
