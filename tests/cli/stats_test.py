#!/usr/bin/env python3
"""`whit render --stats FILE.json`: the figures of a render for machines, and where they go."""
import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest

WHIT = os.environ.get("WHIT")

SCENE = """\
Film "image" "integer xresolution" [32] "integer yresolution" [24] "string filename" ["film-name.exr"]
Sampler "random" "integer pixelsamples" [2]
Integrator "whitted" "integer maxdepth" [3]
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
  LightSource "point" "rgb I" [10 10 10] "point from" [0 0 4]
  Shape "sphere"
WorldEnd
"""
SECOND = SCENE.replace("film-name", "second").replace("[2]", "[3]")
STEPS = ["parse", "plan", "build", "render", "write"]
KINDS = ["camera", "reflection", "refraction", "indirect", "passing", "shadow", "probe"]
LAST_SEED = 4294967295  # the largest of 32 bits


@unittest.skipUnless(WHIT, "the program is not built")
class Stats(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit stats ")
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("a.pbrt", SCENE)
        self.write("two.pbrt", SCENE + SECOND)

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as f:
            f.write(text)

    def read(self, name):
        with open(os.path.join(self.folder, name), "rb") as f:
            return f.read()

    def whit(self, *arguments, stdin=""):
        """Exit code, stdout, stderr."""
        done = subprocess.run([WHIT, *arguments], input=stdin, capture_output=True, text=True, cwd=self.folder, timeout=60,
                              check=False)
        return done.returncode, done.stdout, done.stderr

    def good(self, *arguments, stdin=""):
        """stdout and stderr of a command that must succeed."""
        code, out, err = self.whit(*arguments, stdin=stdin)
        self.assertEqual(code, 0, err)
        return out, err

    def fails(self, code, message, *arguments):
        before = sorted(os.listdir(self.folder))
        got, out, err = self.whit(*arguments)
        self.assertEqual((got, out), (code, ""), err)
        self.assertRegex(err, message)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_all_figures(self):
        start = time.monotonic()
        out, err = self.good("a.pbrt", "--quiet", "--nthreads", "2", "--spp", "200", "--stats", "s.json")
        elapsed = time.monotonic() - start
        self.assertEqual((out, err), ("", ""))
        figures = json.loads(self.read("s.json"))
        self.assertEqual(list(figures), ["seconds", "cpu_seconds", "start", "rays", "clear_shadow_rays", "textures", "samples",
                                         "memory_bytes", "memory_peak_bytes", "memory_estimate_bytes", "invalid_samples",
                                         "settings", "seed"])
        wall, cpu = figures["seconds"], figures["cpu_seconds"]
        self.assertEqual((list(wall), list(cpu)), (STEPS, STEPS))
        self.assertLessEqual(sum(wall.values()), elapsed)
        for step in STEPS:
            self.assertGreater(wall[step], 0, step)
            self.assertGreaterEqual(cpu[step], 0, step)
        # Two threads take two seconds a second at most; the clocks are read one after the other, and tick.
        self.assertLessEqual(cpu["render"], 2 * wall["render"] + 0.02)
        self.assertGreater(cpu["render"], 0)
        # Rounded to milliseconds, all five would be multiples of one.
        self.assertTrue(any(abs(s * 1000 - round(s * 1000)) > 1e-6 for s in wall.values()), wall)
        # A camera ray for each sample of 32 x 24 pixels, and what shades: every hit on the sphere has a shadow ray at
        # most, since the one light is a point.
        self.assertEqual(list(figures["rays"]), KINDS)
        self.assertEqual(figures["samples"], 32 * 24 * 200)
        self.assertEqual(figures["rays"]["camera"], 32 * 24 * 200)
        self.assertTrue(0 < figures["rays"]["shadow"] < 32 * 24 * 200)
        self.assertEqual(figures["rays"]["reflection"] + figures["rays"]["indirect"], 0)
        self.assertEqual((figures["invalid_samples"], figures["seed"]), (0, 0))
        self.assertGreater(figures["memory_bytes"], 1 << 20)
        settings = figures["settings"]
        expected = {"scene": "a.pbrt", "samples_per_pixel": 200, "footprint_samples": 2, "threads": 2, "integrator": "whitted",
                    "integrator_parameters": {"maxdepth": 3}, "sampler": "random", "resolution": [32, 24],
                    "window": [0, 0, 32, 24], "traversal": "robust", "aovs": [], "outfile": "film-name.exr",
                    "display": "film-name.png", "effects": ["diffuse", "delta-lights", "shadows"]}
        self.assertEqual({k: settings[k] for k in expected}, expected)

    def test_settings_are_those_in_force(self):
        self.good("a.pbrt", "--quiet", "--integrator", "path", "--traversal", "fast", "--cropwindow", "0.25,0.5,0.5,1",
                  "--stats=s.json")
        settings = json.loads(self.read("s.json"))["settings"]
        self.assertEqual((settings["integrator"], settings["traversal"]), ("path", "fast"))
        # x from 0.25 * 32 = 8 to 0.5 * 32 = 16, y from 0.5 * 24 = 12 to 24; ends excluded.
        self.assertEqual((settings["resolution"], settings["window"]), ([32, 24], [8, 12, 16, 24]))
        self.good("a.pbrt", "--quiet", "--footprint-spp", "5", "--stats=s.json")
        self.assertEqual(json.loads(self.read("s.json"))["settings"]["footprint_samples"], 5)
        # Without a statement the defaults are in force, and what nobody has is replaced.
        for statement, in_force in (("", "sobol"), ('Sampler "adaptive"', "halton")):
            self.write("b.pbrt", SCENE.replace('Sampler "random" "integer pixelsamples" [2]', statement))
            self.good("b.pbrt", "--quiet", "--spp", "1", "--stats=s.json")
            self.assertEqual(json.loads(self.read("s.json"))["settings"]["sampler"], in_force)

    def test_the_last_seed(self):
        self.good("a.pbrt", "--quiet", "--seed", str(LAST_SEED), "--stats", "s.json")
        self.assertEqual(json.loads(self.read("s.json"))["seed"], LAST_SEED)

    def test_invalid_samples_are_counted(self):
        self.write("b.pbrt", SCENE.replace("WorldBegin", 'WorldBegin LightSource "infinite" "rgb L" [-9 1 1]'))
        self.good("b.pbrt", "--quiet", "--pixel", "3,4", "--stats", "s.json")
        self.assertEqual(json.loads(self.read("s.json"))["invalid_samples"], 2)

    def test_standard_output(self):
        out, err = self.good("a.pbrt", "--quiet", "--stats", "-")
        self.assertEqual((json.loads(out)["samples"], err), (32 * 24 * 2, ""))
        out, _ = self.good("--stats=-", "--quiet", stdin=SCENE)
        self.assertEqual(json.loads(out)["settings"]["scene"], "-")

    def test_without_quiet_the_summary_stays(self):
        _, err = self.good("a.pbrt", "--stats", "s.json")
        self.assertRegex(err, "parse .*, plan .*, build .*, render .*, write ")
        self.assertNotIn("resident after parsing", err)
        # A bare --stats says more on stderr, as ever, and takes no scene for its file.
        os.remove(os.path.join(self.folder, "s.json"))
        _, err = self.good("--stats", "a.pbrt")
        self.assertIn("resident after parsing", err)
        _, err = self.good("a.pbrt", "--stats", "--stats", "s.json")
        self.assertIn("resident after parsing", err)
        self.assertEqual(json.loads(self.read("s.json"))["samples"], 32 * 24 * 2)

    def test_several_pictures(self):
        for arguments in (["two.pbrt"], ["a.pbrt", "second.pbrt"]):
            self.write("second.pbrt", SECOND)
            self.good(*arguments, "--quiet", "--stats", "s.json")
            first, second = json.loads(self.read("s.json"))
            self.assertEqual((first["samples"], second["samples"]), (32 * 24 * 2, 32 * 24 * 3))
            self.assertEqual(second["settings"]["outfile"], "second.exr")

    def test_what_was_made_before_a_failure_is_told(self):
        self.write("bad.pbrt", SCENE.replace('Shape "sphere"', 'Shape "sphere" "float radius" [-1]'))
        code, _, _ = self.whit("a.pbrt", "bad.pbrt", "--quiet", "--stats", "s.json")
        self.assertEqual(code, 3)
        self.assertEqual([p["settings"]["scene"] for p in json.loads(self.read("s.json"))], ["a.pbrt"])
        self.fails(3, "radius", "bad.pbrt", "--quiet", "--stats", "none.json")

    def test_files_that_cannot_be_written(self):
        # As many samples as would take hours: it is found before rendering.
        spp = ["--spp", "1000000"]
        self.fails(4, 'cannot write "/nonexistent/s.json": No such file', "a.pbrt", "--stats", "/nonexistent/s.json", *spp)
        os.mkdir(os.path.join(self.folder, "folder.json"))
        self.fails(4, 'cannot write "folder.json": it is a folder', "a.pbrt", "--stats=folder.json", *spp)
        if os.path.exists("/dev/full"):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([WHIT, "a.pbrt", "--quiet", "--stats", "-"], stdout=full, stderr=subprocess.PIPE,
                                      text=True, cwd=self.folder, timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr), (4, "whit: cannot write to standard output\n"))

    def test_wrong_usage(self):
        for name in ("a.pbrt", "figures.txt", ""):
            self.fails(2, '--stats: "%s" is neither' % name, "a.pbrt", "--stats=" + name)
        self.fails(2, "--stats FILE.json is of pictures", "a.pbrt", "--stats", "s.json", "--debug-pixel", "1,1")

    def test_an_old_file_is_replaced_whole_and_nothing_else_is_left(self):
        self.write("s.json", "x" * 100000)
        self.good("a.pbrt", "--quiet", "--stats", "s.json")
        json.loads(self.read("s.json"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.pbrt", "film-name.exr", "film-name.png", "s.json", "two.pbrt"])


if __name__ == "__main__":
    unittest.main()
