#!/usr/bin/env python3
"""The flags that override what a scene says, through the program: `whit render` and `whit explain`."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")

# A mirror that fills the view of 8 x 8 pixels and reflects half of white light.
SCENE = """\
Film "image" "integer xresolution" [8] "integer yresolution" [8] "string filename" ["out.pfm"]
Sampler "halton" "integer pixelsamples" [12]
Camera "orthographic"
WorldBegin
  LightSource "infinite" "rgb L" [1 1 1]
  Material "mirror" "rgb Kr" [.5 .5 .5]
  Translate 0 0 5
  Shape "disk" "float radius" [2]
WorldEnd
"""


@unittest.skipUnless(WHIT, "the program is not built")
class Overrides(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit overrides ")
        self.addCleanup(shutil.rmtree, self.folder)
        with open(os.path.join(self.folder, "a.pbrt"), "w", encoding="utf-8") as f:
            f.write(SCENE)

    def whit(self, *arguments):
        """Exit code, stdout, stderr."""
        done = subprocess.run([WHIT, *arguments], input="", capture_output=True, text=True, cwd=self.folder, timeout=60,
                              check=False)
        return done.returncode, done.stdout, done.stderr

    def settings(self, *flags):
        """What was in force, as --stats tells, of a render that says nothing."""
        code, out, err = self.whit("a.pbrt", "--quiet", "--display", "none", "--stats", "-", *flags)
        self.assertEqual((code, err), (0, ""))
        return json.loads(out)["settings"]

    def fails(self, message, *arguments):
        for command in ("render", "explain"):
            code, out, err = self.whit(command, "a.pbrt", *arguments)
            self.assertEqual((code, out), (2, ""), err)
            self.assertIn(message, err)
            self.assertNotIn("out.pfm", os.listdir(self.folder))

    def test_flags_are_in_force(self):
        own = self.settings()
        self.assertEqual((own["sampler"], own["samples_per_pixel"], own["integrator"]), ("halton", 12, "whitted"))
        s = self.settings("--sampler", "random", "--integrator", "path", "--maxdepth", "7", "--rrthreshold", "0.25")
        self.assertEqual((s["sampler"], s["samples_per_pixel"]), ("random", 12))
        self.assertEqual((s["integrator"], s["integrator_parameters"]), ("path", {"maxdepth": 7, "rrthreshold": 0.25}))
        s = self.settings("--sampler=stratified", "--spp=6")
        self.assertEqual((s["sampler"], s["samples_per_pixel"]), ("stratified", 6))
        self.assertEqual(self.settings("--texture-filter", "point")["texture_filter"], "point")

    def test_a_mirror_without_reflections_is_black(self):
        self.settings("--maxdepth", "1")
        with open(os.path.join(self.folder, "out.pfm"), "rb") as f:
            self.assertEqual(f.read()[-8 * 8 * 12:], bytes(8 * 8 * 12))

    def test_explain_knows_them(self):
        code, out, _ = self.whit("explain", "a.pbrt", "--json", "--integrator", "ambientocclusion")
        self.assertEqual(code, 0)
        self.assertNotIn("reflection", [e["effect"] for e in json.loads(out)["worlds"][0]["effects"] if e["on"]])

    def test_wrong_usage(self):
        self.fails('--sampler: there is no sampler "sobel"; did you mean "sobol"?', "--sampler", "sobel")
        self.fails('--texture-filter: there is no filter "points"; did you mean "point"?', "--texture-filter", "points")
        self.fails('--rrthreshold: integrator "whitted" has no parameter "rrthreshold"; path has', "--rrthreshold", "0.5")
        self.fails('--maxdepth: integrator "ambientocclusion" has no parameter "maxdepth"', "--integrator",
                   "ambientocclusion", "--maxdepth", "3")
        self.fails("--maxdepth: maxdepth must be at most 1e+06, not 1000001", "--maxdepth", "1000001")
        for flag in ("--maxdepth", "--rrthreshold"):
            self.fails(flag, flag, "x")


if __name__ == "__main__":
    unittest.main()
