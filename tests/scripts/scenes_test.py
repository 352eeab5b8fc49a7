#!/usr/bin/env python3
"""The scenes in scenes/: documented, complete, rendered without a word of complaint, and right where the answer is known.

The rendering tests need the program, in $WHIT.
"""
import glob
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SCENES = sorted(glob.glob(ROOT + "/scenes/*.pbrt") + glob.glob(ROOT + "/scenes/analytic/*.pbrt"))
WHIT = os.environ.get("WHIT")


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def render(scene, folder, *flags):
    """Renders into the folder; returns the path of the EXR and what the program said."""
    image = os.path.join(folder, os.path.basename(scene)[:-5] + ".exr")
    done = subprocess.run([WHIT, scene, "--outfile", image, *flags], capture_output=True, text=True, check=False,
                          cwd=folder, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise AssertionError("%s: exit %d\n%s" % (scene, done.returncode, done.stderr))
    return image, done.stderr


def pixels(image):
    """The R, G, B of a linear image, as an array [y, x, channel]."""
    import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
    buffer = oiio.ImageBuf(image)
    names = list(buffer.spec().channelnames)
    return buffer.get_pixels(oiio.FLOAT)[..., [names.index(c) for c in "RGB"]]


class Files(unittest.TestCase):
    def test_there_are_scenes(self):
        self.assertGreaterEqual(len(SCENES), 14)

    def test_each_says_what_to_look_at(self):
        for path in SCENES:
            comment = "".join(line for line in read(path).splitlines(True) if line.startswith("#"))
            self.assertTrue(read(path).startswith("#"), path)
            self.assertIn("# The answer: " if "/analytic/" in path else "# Look at: ", comment, path)

    def test_each_writes_an_image_of_its_own_name(self):
        for path in SCENES:
            self.assertIn('"string filename" ["%s.exr"]' % os.path.basename(path)[:-5], read(path))

    def test_the_files_they_name_are_there(self):
        # Relative paths start at the folder of the main file, also inside an included one.
        for path in SCENES:
            folder, texts = os.path.dirname(path), [read(path)]
            for include in re.findall(r'Include "([^"]+)"', texts[0]):
                texts.append(read(os.path.join(folder, include)))
            for name in re.findall(r'"string (?:filename|mapname)" \["([^"]+)"\]', "".join(texts)):
                if not (name.endswith(".exr") and name == os.path.basename(path)[:-5] + ".exr"):
                    self.assertTrue(os.path.exists(os.path.join(folder, name)), "%s names %s" % (path, name))

    def test_blocks_are_closed(self):
        for path in SCENES + glob.glob(ROOT + "/scenes/include/*.pbrt"):
            text = re.sub(r"#[^\n]*", "", read(path))
            for block in ("World", "Attribute", "Transform", "Object"):
                self.assertEqual(len(re.findall(r"\b%sBegin\b" % block, text)),
                                 len(re.findall(r"\b%sEnd\b" % block, text)), path)
            self.assertEqual(text.count("["), text.count("]"), path)

    def test_assets_are_small_and_made_by_the_script(self):
        self.assertLess(sum(os.path.getsize(f) for f in glob.glob(ROOT + "/scenes/assets/*")), 1_500_000)
        subprocess.run([sys.executable, ROOT + "/tools/make-scene-assets", "--check"], check=True)


@unittest.skipUnless(WHIT, "the program is not built")
class Rendered(unittest.TestCase):
    def test_every_scene_renders_without_a_warning(self):
        with tempfile.TemporaryDirectory() as folder:
            for path in SCENES:
                image, said = render(path, folder, "--quick", "--quiet")
                self.assertEqual(said.strip(), "", path)
                rgb = pixels(image)
                self.assertTrue(0.0 < float(rgb.mean()) < math.inf, path)

    def analytic(self, name):
        with tempfile.TemporaryDirectory() as folder:
            return pixels(render(ROOT + "/scenes/analytic/%s.pbrt" % name, folder, "--quiet")[0])

    def test_furnace_matte(self):
        rgb = self.analytic("furnace-matte")
        self.assertLess(abs(float(rgb.mean()) - 1), 0.001)
        # Seven standard deviations of independent samples.
        self.assertLess(float(abs(rgb - 1).max()), 7 * math.sqrt(5 / 3 / 256))

    def test_furnace_mirror(self):
        rgb = self.analytic("furnace-mirror")
        self.assertEqual((float(rgb.min()), float(rgb.max())), (1.0, 1.0))

    def test_furnace_glass(self):
        rgb = self.analytic("furnace-glass")
        self.assertGreaterEqual(float(rgb.mean()), 0.9999)
        self.assertLessEqual(float(rgb.max()), 1.0005)  # half a unit in the last place of a half, above 1
        self.assertGreater(float(rgb.min()), 1 - 0.036)

    def test_point_light_plane(self):
        rgb = self.analytic("point-light-plane")
        # A half has 11 bits: a relative error of up to 2^-11.
        for (x, y), answer in {(50, 50): 0.397887, (0, 0): 0.218734, (100, 0): 0.218734, (0, 100): 0.218734}.items():
            for channel in range(3):
                self.assertLess(abs(float(rgb[y, x, channel]) / answer - 1), 6e-4, (x, y))


if __name__ == "__main__":
    unittest.main()
