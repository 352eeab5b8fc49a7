"""whit render --target-error and --time-limit: what they say, what machines get, and how they end."""
import json
import os
import subprocess
import tempfile
import time
import unittest

WHIT = os.environ.get("WHIT", "")

SCENE = """Film "image" "integer xresolution" [48] "integer yresolution" [32] "string filename" "picture.exr"
Camera "perspective" "float fov" [50]
Sampler "{sampler}"
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [20 20 20]
  Translate 0 4 4
  Rotate 90 1 0 0
  Shape "disk" "float radius" [1]
AttributeEnd
Translate 0 0 5
Material "matte"
Shape "sphere"
WorldEnd
"""


@unittest.skipUnless(WHIT, "the program is not built")
class Target(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.write(SCENE.format(sampler="sobol"))

    def write(self, text):
        with open(os.path.join(self.folder.name, "scene.pbrt"), "w", encoding="utf-8") as f:
            f.write(text)

    def run_whit(self, *flags):
        return subprocess.run([WHIT, "scene.pbrt", *flags], cwd=self.folder.name, capture_output=True, text=True,
                              timeout=300, check=False)

    def test_met(self):
        done = self.run_whit("--target-error", "1%", "--json", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("target met: error ", done.stderr)
        told = json.loads(done.stdout)
        self.assertLessEqual({"target", "achieved", "met", "samples_mean", "untrusted_pixels", "seconds"}, set(told))
        self.assertEqual(told["target"], 0.01)
        self.assertIs(told["met"], True)
        self.assertLessEqual(told["achieved"]["upper95"], 0.01)
        self.assertLess(told["achieved"]["value"], told["achieved"]["upper95"])
        self.assertGreaterEqual(told["samples_mean"], 4)
        self.assertTrue(os.path.exists(os.path.join(self.folder.name, "picture.png")))

    def test_shares_are_written_in_two_ways(self):
        a = json.loads(self.run_whit("--target-error", "0.02", "--quiet", "--json", "-").stdout)
        b = json.loads(self.run_whit("--target-error", "2 %", "--quiet", "--json=-").stdout)
        self.assertEqual(a["achieved"], b["achieved"])

    def test_not_met_is_exit_5_and_the_picture_is_there(self):
        done = self.run_whit("--target-error", "0.001%", "--max-samples", "64", "--json", "t.json")
        self.assertEqual(done.returncode, 5)
        self.assertIn("not met", done.stderr)
        with open(os.path.join(self.folder.name, "t.json"), encoding="utf-8") as f:
            told = json.load(f)
        self.assertIs(told["met"], False)
        self.assertEqual(told["samples_mean"], 64)
        self.assertGreater(told["achieved"]["lower95"], 1e-5)
        self.assertTrue(os.path.exists(os.path.join(self.folder.name, "picture.exr")))

    def test_time_limit(self):
        start = time.monotonic()
        done = self.run_whit("--time-limit", "1500ms", "--max-samples", "1000000", "--json", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("time limit: error ", done.stderr)
        # That time limits are kept is measured where nothing else runs; here only that there is one.
        self.assertLess(time.monotonic() - start, 20)
        self.assertGreater(json.loads(done.stdout)["samples_mean"], 64)

    def test_time_limit_before_the_target_is_exit_5(self):
        done = self.run_whit("--target-error", "0.0001%", "--time-limit", "1s", "--max-samples", "1000000000")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn("time limit, target not met: error ", done.stderr)

    def test_too_little_time_for_a_picture_says_so(self):
        # A microsecond has gone by when the scene is read: nothing is rendered, and what there is, is written.
        done = self.run_whit("--time-limit", "0.001ms", "--json", "-")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual(json.loads(done.stdout)["achieved"]["value"], None)
        self.assertTrue(os.path.exists(os.path.join(self.folder.name, "picture.exr")))

    def test_black_pictures_have_no_error(self):
        self.write("Film \"image\" \"integer xresolution\" [8] \"integer yresolution\" [8]\nWorldBegin\nWorldEnd\n")
        done = self.run_whit("--target-error", "1%", "--max-samples", "64")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn("error unknown", done.stderr)

    def test_what_machines_do_not_get_is_exit_4(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([WHIT, "scene.pbrt", "--target-error", "50%", "--quiet", "--json", "-"],
                                  cwd=self.folder.name, stdout=full, stderr=subprocess.PIPE, text=True, timeout=300,
                                  check=False)
        self.assertEqual(done.returncode, 4)
        self.assertIn("cannot write to standard output", done.stderr)

    def test_a_file_that_cannot_be_written_is_told_before_rendering(self):
        done = self.run_whit("--target-error", "50%", "--json", "no folder/t.json")
        self.assertEqual(done.returncode, 4)
        self.assertIn('cannot write "no folder/t.json"', done.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder.name, "picture.exr")))

    def test_wrong_usage(self):
        for flags, what in ((("--target-error", "none"), "--target-error"), (("--target-error", "-1%"), "--target-error"),
                            (("--time-limit", "5 parsecs"), "--time-limit"),
                            (("--target-error", "1%", "--confidence", "100%"), "--confidence"),
                            (("--target-error", "1%", "--spp", "4"), "--spp"), (("--json", "-"), "--json")):
            done = self.run_whit(*flags)
            self.assertEqual(done.returncode, 2, flags)
            self.assertIn(what, done.stderr)


if __name__ == "__main__":
    unittest.main()
