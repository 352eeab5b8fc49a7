#!/usr/bin/env python3
"""Each finding of `whit check` has a scene that shows it, NAME.pbrt, and one that nearly does and must not, NAME-not.pbrt.
What is found in all scenes of the project is stored in expected.txt and has been looked at: --store stores it again.
"""
import glob
import json
import os
import subprocess
import sys
import unittest

WHIT = os.environ.get("WHIT")
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
EXPECTED = os.path.join(HERE, "expected.txt")


def run(*args, folder=HERE):
    return subprocess.run([WHIT, "check", *args], cwd=folder, check=False, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=600)


def check(*args, folder=HERE):
    done = run("--json", *args, folder=folder)
    return done.returncode, json.loads(done.stdout)["diagnostics"]


def table():
    """Of each row of the list: name, severity, whether it is looked for by default."""
    rows = []
    for line in run("--list").stdout.splitlines():
        name, severity = line[:28].strip(), line[29:47].strip()
        rows.append((name, severity.split(",")[0], "--also" not in severity))
    return rows


def findings():
    general = {"unknown-parameter", "wrong-type", "no-lights", "other-version", "warning"}
    return [row for row in table() if row[0] not in general]


class Pairs(unittest.TestCase):
    def test_each_finding_has_two_scenes(self):
        names = {name for name, _, _ in findings()}
        self.assertGreater(len(names), 20)
        scenes = {os.path.basename(p)[:-5] for p in glob.glob(os.path.join(HERE, "*.pbrt"))}
        self.assertEqual(scenes, names | {name + "-not" for name in names})

    def test_scene_and_near_miss(self):
        for name, severity, by_default in findings():
            with self.subTest(name):
                also = [] if by_default else ["--also", name]
                code, found = check(name + ".pbrt", *also)
                self.assertIn((name, severity), {(d["name"], d["severity"]) for d in found})
                self.assertEqual({d["name"] for d in found}, {name}, found)
                self.assertEqual(code, 0 if severity == "note" else 1)
                _, found = check(name + "-not.pbrt", *also)
                self.assertNotIn(name, [d["name"] for d in found], found)
                self.assertEqual([d for d in found if d["severity"] == "error"], [])
                if not by_default:
                    self.assertEqual(check(name + ".pbrt"), (0, []))

    def test_each_can_be_silenced(self):
        for name, _, by_default in findings():
            with self.subTest(name):
                also = [] if by_default else ["--also", name]
                self.assertEqual(check(name + ".pbrt", *also, "--allow", name), (0, []))
                with open(os.path.join(HERE, name + ".pbrt"), encoding="utf-8") as file:
                    text = f"# whit: allow {name}\n" + file.read()
                done = subprocess.run([WHIT, "check", *also], cwd=HERE, input=text, check=False, capture_output=True,
                                      text=True, timeout=600)
                self.assertEqual((done.returncode, done.stderr), (0, ""))


def all_scenes():
    paths = []
    for pattern in ("scenes/**/*.pbrt", "tests/conformance/scenes/**/*.pbrt", "tests/conformance-paths/**/*.pbrt"):
        paths += glob.glob(os.path.join(ROOT, pattern), recursive=True)
    # What is included is no scene.
    paths = [os.path.relpath(p, ROOT) for p in paths]
    return sorted(p for p in paths if "/include/" not in p and "/assets/" not in p)


def found_everywhere():
    lines = []
    for path in all_scenes():
        done = run("--json", path, folder=ROOT)
        for d in json.loads(done.stdout)["diagnostics"]:
            lines.append(f'{d["file"]}:{d["line"]}: {d["severity"]}: {d["message"]} [{d["name"]}]')
    return "".join(line + "\n" for line in lines)


class AllScenes(unittest.TestCase):
    def test_what_is_found_is_known(self):
        with open(EXPECTED, encoding="utf-8") as file:
            self.assertEqual(found_everywhere(), file.read())


if __name__ == "__main__":
    if "--store" in sys.argv:
        with open(EXPECTED, "w", encoding="utf-8") as out:
            out.write(found_everywhere())
    else:
        unittest.main()
