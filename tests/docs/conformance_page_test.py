#!/usr/bin/env python3
"""docs/conformance.md, as tools/make-conformance-page writes it: it has each conformance scene, as the manifest has it.

That the scenes still measure what the page says is not tested: it may be a little old, since each change of a picture
changes it. tests/conformance renders every scene; here an empty sky shows that the page is written right.
"""
import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
TOOL = ROOT + "/tools/make-conformance-page"
CONFORMANCE = ROOT + "/tests/conformance"
WHIT = os.environ.get("WHIT")
MEASURES = ("relmse", "ratio", "block")
ROW = re.compile(r"^\| \*\*(?P<name>[\w-]+)\*\*<br>(?P<features>.*)<br>(?P<spp>\d+) samples \| !\[.*\]\((?P<strip>.*)\)"
                 r" \| (?P<relmse>\S+)<br>(?P<relmse_limit>\S+)"
                 r" \| (?P<ratio>\S+)<br>1 ± (?P<ratio_limit>\S+) \| (?P<block>\S+)<br>(?P<block_limit>\S+) \|$")


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def rows(page):
    """The rows of the scenes on a page, in its order, each with the group it stands under."""
    group, found = None, []
    for line in read(page).splitlines():
        group = line[3:] if line.startswith("## ") else group
        if line.startswith("| **"):
            found.append({**ROW.match(line).groupdict(), "group": group})
    return found


def pixels(path):
    import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
    picture = oiio.ImageBuf(path)
    return picture.get_pixels(oiio.FLOAT)[..., :3]


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scenes = json.loads(read(CONFORMANCE + "/manifest.json"))["scenes"]
        cls.rows = rows(ROOT + "/docs/conformance.md")

    def test_it_has_the_scenes_of_the_manifest(self):
        self.assertEqual([(r["name"], r["group"], r["features"], int(r["spp"])) for r in self.rows],
                         [(s["name"], s["group"], ", ".join(s["features"]), s["spp"]) for s in self.scenes])
        for r, s in zip(self.rows, self.scenes):
            self.assertEqual({m: float(r[m + "_limit"]) for m in MEASURES}, s["limits"], s["name"])

    def test_all_are_within_their_limits(self):
        for r in self.rows:
            for m in MEASURES:
                self.assertLessEqual(abs(float(r[m]) - (m == "ratio")), float(r[m + "_limit"]), r["name"])

    def test_each_scene_has_its_strip_and_no_other(self):
        strips = ["conformance/%s.jpg" % s["name"] for s in self.scenes]
        self.assertEqual([r["strip"] for r in self.rows], strips)
        self.assertEqual(sorted("conformance/" + f for f in os.listdir(ROOT + "/docs/conformance")), sorted(strips))
        # Every clone has them for ever.
        self.assertLess(sum(map(os.path.getsize, glob.glob(ROOT + "/docs/conformance/*"))), 4e6)

    def test_the_strips_show_the_references(self):
        import numpy as np  # pylint: disable=import-outside-toplevel
        for r in self.rows:
            reference = np.clip(pixels("%s/ref/%s.exr" % (CONFORMANCE, r["name"])), 0, 1)
            shown = np.where(reference <= 0.0031308, 12.92 * reference, 1.055 * reference ** (1 / 2.4) - 0.055)
            strip = pixels("%s/docs/%s" % (ROOT, r["strip"]))
            height, width = shown.shape[:2]
            self.assertEqual(strip.shape[:2], (height, 3 * width + 2 * 8), r["name"])
            # JPEG loses up to 0.017, where saturated colours meet; most scenes differ by 0.05 and more.
            error = np.abs(strip[:, width + 8:2 * width + 8] - shown).mean()
            self.assertLess(error, 0.02, r["name"])


@unittest.skipUnless(WHIT, "the program is not built")
class Tool(unittest.TestCase):
    """A sky of radiance 0.5, against a reference of 0.53125 = 17/32: both are exact in half."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="whit page ")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        os.mkdir(self.folder + "/scenes")
        os.mkdir(self.folder + "/ref")
        self.write("scenes/lights-sky.pbrt", 'Sampler "sobol" "integer pixelsamples" 1\n'
                   'Film "image" "integer xresolution" 24 "integer yresolution" 16\n'
                   'Camera "perspective"\nWorldBegin\nLightSource "infinite" "rgb L" [0.5 0.5 0.5]\nWorldEnd\n')
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        reference = oiio.ImageBuf(oiio.ImageSpec(24, 16, 3, "half"))
        oiio.ImageBufAlgo.fill(reference, (0.53125, 0.53125, 0.53125))
        self.assertTrue(reference.write(self.folder + "/ref/lights-sky.exr"))

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as f:
            f.write(text)

    def run_tool(self, limit):
        scene = {"name": "lights-sky", "group": "lights", "features": ["a sky", "nothing else"], "spp": 1,
                 "pbrt_seconds": 1, "limits": {m: limit for m in MEASURES}}
        self.write("manifest.json", json.dumps({"scenes": [scene]}))
        done = subprocess.run([sys.executable, TOOL, self.folder, self.folder + "/page.md"], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=120, check=False)
        return done.returncode, done.stderr

    def test_a_scene_that_passes(self):
        self.assertEqual(self.run_tool(0.1), (0, ""))
        # The relative differences: (1/32)^2 / (17/32)^2 / (1 + 0.1^2) = 0.003426; 0.5 / 0.53125 = 0.9412;
        # 1/32 / (1.1 * 17/32) = 0.05348. The largest shares of 0.1 are 3 %, 59 % and 53 %.
        self.assertEqual([(r["relmse"], r["ratio"], r["block"]) for r in rows(self.folder + "/page.md")],
                         [("0.00343", "0.9412", "0.0535")])
        text = read(self.folder + "/page.md")
        self.assertIn("\n| [lights](#lights) | 1 | 3 % | 59 % | 53 % |\n", text)
        self.assertNotIn(self.folder, text)

        # sRGB: 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354 and, of 0.53125, 0.7556; 1/2 - 4 * 0.05348 = 0.2861. Panels are
        # whole blocks of JPEG, which keeps a constant to its last of 255 steps.
        strip = pixels(self.folder + "/page/lights-sky.jpg")
        self.assertEqual(strip.shape, (16, 24 + 8 + 24 + 8 + 24, 3))
        for first, last, value in ((0, 24, 0.7354), (24, 32, 1), (32, 56, 0.7556), (56, 64, 1), (64, 88, 0.2861)):
            self.assertAlmostEqual(float(strip[:, first:last].min()), value, delta=1.5 / 255)
            self.assertAlmostEqual(float(strip[:, first:last].max()), value, delta=1.5 / 255)

    def test_the_same_renderer_writes_the_same_files(self):
        written = []
        for _ in range(2):
            self.assertEqual(self.run_tool(0.1), (0, ""))
            with open(self.folder + "/page/lights-sky.jpg", "rb") as f:
                written.append((read(self.folder + "/page.md"), f.read()))
        self.assertEqual(written[0], written[1])

    def test_what_is_off_makes_no_page(self):
        code, said = self.run_tool(0.001)
        self.assertEqual(code, 1)
        self.assertRegex(said, r"lights-sky is off \(.*\brelmse\b.*\)")
        self.assertFalse(os.path.exists(self.folder + "/page.md") or os.path.exists(self.folder + "/page"))

    def test_what_has_no_picture_is_an_error(self):
        self.write("scenes/lights-sky.pbrt", "Nonsense\n")
        code, said = self.run_tool(0.1)
        self.assertEqual(code, 1)
        self.assertIn("lights-sky has no picture to compare: exit 3: ", said)
        os.remove(self.folder + "/manifest.json")
        done = subprocess.run([sys.executable, TOOL, self.folder, self.folder + "/page.md"], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("has no manifest.json", done.stderr)


if __name__ == "__main__":
    unittest.main()
