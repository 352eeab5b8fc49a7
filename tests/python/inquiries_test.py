#!/usr/bin/env python3
"""The Python package: check, explain, cost and diff say what the commands say."""
import json
import os
import subprocess
import unittest

import numpy

from package import SCENE, WHIT, whit
from render_test import Folder


class Check(Folder):
    def test_findings_are_those_of_the_command(self):
        odd = self.write("odd.pbrt", SCENE.replace("WorldBegin", 'WorldBegin\nTexture "t" "float" "constant"\n')
                         .replace('"float radius" [6]', '"float raduis" [6]'))
        done = subprocess.run([WHIT, "check", "--json", str(odd)], capture_output=True, text=True, timeout=60, check=False)
        expected = json.loads(done.stdout)["diagnostics"]
        self.assertEqual(len(expected), 2)
        found = whit.check(odd)
        for mine, other in zip(found, expected):
            self.assertEqual((mine.severity, mine.name, mine.file, mine.line, mine.column, mine.message, mine.remedy),
                             tuple(other[k] for k in ("severity", "name", "file", "line", "column", "message", "hint")))
            self.assertIn(mine.message, str(mine))
        self.assertEqual(len(found), len(expected))

    def test_what_is_allowed_is_left_out(self):
        odd = SCENE.replace("WorldBegin", 'WorldBegin\nTexture "t" "float" "constant"\n')
        self.assertEqual([d.name for d in whit.check(odd)], ["unused-texture"])
        self.assertEqual(whit.check(odd, allow=["unused-texture"]), [])
        self.assertEqual(whit.check(SCENE), [])

    def test_names_that_there_are_not(self):
        for arguments in ({"allow": ["unused-textur"]}, {"also": ["nothing"]}, {"allow": ["mistake"]}):
            with self.assertRaisesRegex(whit.UsageError, "allow|also"):
                whit.check(SCENE, **arguments)

    def test_a_file_that_is_not_there_is_a_finding(self):
        found, = whit.check(self.folder / "no.pbrt")
        self.assertEqual((found.severity, found.name), ("error", "file"))


class Explain(Folder):
    def test_the_plan_is_that_of_the_command(self):
        for flags, arguments in (([], {}), (["--without", "shadows"], {"without": "shadows"})):
            done = subprocess.run([WHIT, "explain", "--json", str(self.scene), *flags], capture_output=True, text=True,
                                  timeout=60, check=True)
            self.assertEqual(whit.explain(self.scene, **arguments), json.loads(done.stdout))

    def test_memory_is_estimated(self):
        memory = whit.explain(self.scene, memory=True)["worlds"][0]["memory"]
        self.assertEqual(set(memory), {"estimate_bytes", "limit_bytes", "step", "uses", "steps"})
        self.assertGreater(memory["estimate_bytes"], 0)


class Cost(Folder):
    def test_the_report_has_the_keys_of_the_command(self):
        shares = []
        page = self.folder / "cost.html"
        report = whit.cost(self.scene, seconds=2, quick=True, html=page, progress=shares.append)
        self.assertEqual(set(report), {"scene", "machine", "reference", "order", "time", "settings", "effects", "answers",
                                       "worst", "not_known", "complete"})
        self.assertEqual(report["scene"], str(self.scene))
        self.assertGreaterEqual(len(report["settings"]), 1)
        self.assertTrue(report["settings"][0]["command"].startswith("whit "))
        self.assertIn("<html", page.read_text(encoding="utf-8"))
        self.assertTrue(shares)

    def test_it_can_be_ended(self):
        self.assertFalse(whit.cost(SCENE, seconds=3600, quick=True, progress=lambda share: False)["complete"])

    def test_what_makes_no_sense(self):
        for arguments in ({"seconds": 0}, {"threads": -1}, {"seed": -1}):
            with self.assertRaises(whit.UsageError):
                whit.cost(SCENE, **arguments)
        with self.assertRaises(whit.FileError):
            whit.cost(SCENE, seconds=0.5, quick=True, html=self.folder / "no" / "cost.html")


class Diff(Folder):
    def test_the_report_is_that_of_the_command(self):
        a, b = self.folder / "a.exr", self.folder / "b.exr"
        whit.render(SCENE, seed=1, aovs=["N"]).save(a)
        whit.render(SCENE, seed=2, aovs=["N"]).save(b)
        done = subprocess.run([WHIT, "diff", "--json", "--measure", "ssim", "--fail-above", "mse=1e-9", str(a), str(b)],
                              capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 1)
        found = whit.diff(a, b, measures=["ssim"], fail_above={"mse": 1e-9})
        self.assertFalse(found.same)
        expected = json.loads(done.stdout)

        def null(value):  # as JSON has it
            if isinstance(value, dict):
                return {k: null(v) for k, v in value.items()}
            if isinstance(value, list):
                return [null(v) for v in value]
            return None if isinstance(value, float) and not numpy.isfinite(value) else value

        self.assertEqual(null(found.report), expected)
        self.assertEqual(found.measures["ssim"], expected["measures"]["ssim"])
        self.assertTrue(found.verdict.startswith("differs: "))
        self.assertIn("mse", found.failures[0] + found.failures[-1])
        self.assertIn("differs", repr(found))

    def test_files_pictures_and_arrays_are_compared(self):
        picture = whit.render(SCENE, aovs=["N"])
        path = self.folder / "a.exr"
        picture.save(path, full_float=True)
        for a, b in ((picture, path), (path, picture), (picture, picture)):
            same = whit.diff(a, b, exact=True)
            self.assertTrue(same.same, same.verdict)
        self.assertTrue(whit.diff(picture.pixels, path, exact=True, channels="R,G,B").same)
        self.assertFalse(whit.diff(picture.pixels * 1.5, picture, channels="R,G,B").same)
        with self.assertRaisesRegex(whit.FileError, "N.X"):
            whit.diff(picture.pixels, picture)

    def test_shapes_of_arrays(self):
        for shape in ((8, 9), (8, 9, 1), (8, 9, 2), (8, 9, 3), (8, 9, 4)):
            a = numpy.full(shape, 0.25)
            b = a.copy()
            b[3, 5] += 1
            found = whit.diff(a, b, hard_fail=0.5)
            self.assertFalse(found.same)
            self.assertEqual(found.report["windows"]["a"], [0, 9, 0, 8])
            failure = [f for f in found.report["failed"] if f["measure"] == "hard-fail"][0]
            self.assertEqual((failure["x"], failure["y"]), (5, 3))
        strided = numpy.arange(8 * 18 * 3, dtype=numpy.float64).reshape(8, 18, 3)[::-1, ::2]
        self.assertTrue(whit.diff(strided, strided.copy(), exact=True).same)

    def test_crops_are_where_they_are(self):
        whole = whit.render(SCENE)
        part = whit.render(SCENE, crop=(0.5, 1, 0, 1))
        found = whit.diff(part, whole)
        self.assertTrue(found.same, found.verdict)
        self.assertEqual(found.report["windows"]["compared"], [20, 40, 0, 30])
        self.assertEqual(whit.diff(whole, whole, crop=(1, 9, 2, 8)).report["windows"]["compared"], [1, 9, 2, 8])

    def test_noise(self):
        a, b = (whit.render(SCENE, seed=s, spp=64, aovs=["variance"]) for s in (1, 2))
        self.assertTrue(whit.diff(a, b, noise=True).noise["same"])
        brighter = whit.render(SCENE.replace("[8 8 8]", "[9 9 9]"), spp=64, aovs=["variance"])
        found = whit.diff(brighter, b, noise=True)
        self.assertFalse(found.noise["same"])
        self.assertIsNone(whit.diff(a, b).noise)

    def test_reports_are_written(self):
        a, b = whit.render(SCENE, seed=1), whit.render(SCENE, seed=2)
        found = whit.diff(a, b)
        found.save_heatmap(self.folder / "heat.png", signed=True, scale=0.5)
        self.assertEqual((self.folder / "heat.png").read_bytes()[:4], b"\x89PNG")
        found.save_html(self.folder / "page.html")
        self.assertIn("a against b", (self.folder / "page.html").read_text(encoding="utf-8"))
        self.assertEqual(found._repr_png_()[:4], b"\x89PNG")
        for save in (found.save_heatmap, found.save_html):
            with self.assertRaises(whit.FileError):
                save(self.folder / "no" / "a.png")

    def test_what_makes_no_sense(self):
        a = numpy.zeros((4, 4, 3))
        for arguments, words in (({"fail_above": {"nothing": 1}}, "fail_above: .*nothing"),
                                 ({"fail_above": {"relmse": "x"}}, "fail_above: needs numbers"),
                                 ({"fail_below": {"relmse": 1}}, "fail_below: "), ({"measures": ["x"]}, "measures: "),
                                 ({"alpha": 2, "noise": True}, "alpha"), ({"crop": (3, 3, 0, 1)}, "crop"),
                                 ({"fail_pixels": 2}, "fail_pixels"), ({"hard_fail": -1}, "hard_fail"),
                                 ({"pixel_error": -1}, "pixel_error")):
            with self.subTest(arguments), self.assertRaisesRegex(whit.UsageError, words):
                whit.diff(a, a, **arguments)
        for bad in (numpy.zeros((4, 4, 5)), numpy.zeros(4), numpy.zeros((0, 4, 3)), numpy.zeros((4, 4), "u1"), 3, None):
            with self.assertRaises(whit.UsageError):
                whit.diff(bad, a)
        with self.assertRaises(whit.FileError):
            whit.diff(self.folder / "no.exr", a)
        with self.assertRaises(whit.FileError):
            whit.diff(self.folder / "no.exr", self.folder / "no.exr")
        with self.assertRaisesRegex(whit.FileError, "folder"):
            whit.diff(self.folder, self.folder)
        with self.assertRaises(whit.FileError):
            whit.diff(a, numpy.zeros((5, 4, 3)))


class Names(unittest.TestCase):
    def test_lists_are_those_of_help(self):
        for names, topic in ((whit.aovs(), "aovs"), (whit.effects(), "effects")):
            text = subprocess.run([WHIT, "help", topic], capture_output=True, text=True, timeout=60, check=True).stdout
            for name in names:
                self.assertIn(name, text)
        self.assertIn("flip", whit.measures())

    def test_the_version_is_the_programs(self):
        done = subprocess.run([WHIT, "--version"], capture_output=True, text=True, timeout=60, check=True)
        self.assertIn(whit.__version__, done.stdout)

    def test_everything_public_is_documented_and_typed(self):
        import inspect

        self.assertTrue(os.path.exists(os.path.join(os.path.dirname(whit.__file__), "py.typed")))
        for name in whit.__all__:
            thing = getattr(whit, name)
            self.assertTrue(thing.__doc__, name)
            functions = [thing] if inspect.isfunction(thing) else [m for n, m in vars(thing).items() if n[0] != "_" and inspect.isfunction(m)]
            for function in functions:
                self.assertIn("return", function.__annotations__, function)
                self.assertTrue(function.__doc__, function)


if __name__ == "__main__":
    unittest.main()
