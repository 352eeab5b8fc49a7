#!/usr/bin/env python3
"""docs/diff-in-ci.md, followed literally: its policy is read, its commands end as it says, and find what they should."""
import json
import os
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
PAGE = ROOT + "/docs/diff-in-ci.md"
WHIT = os.environ.get("WHIT", ROOT + "/build/release/whit")

# A ball under a lamp that throws soft shadows, sampled at random.
SCENE = """\
Film "image" "integer xresolution" [96] "integer yresolution" [64]
Sampler "random" "integer pixelsamples" [64]
LookAt 0 2 6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [35]
WorldBegin
  AttributeBegin
    AreaLightSource "diffuse" "rgb L" [8 8 8]
    Translate 0 4 1
    Rotate 90 1 0 0
    Shape "disk" "float radius" [1]
  AttributeEnd
  Material "matte" "rgb Kd" [0.6 0.3 0.2]
  Shape "sphere" "float radius" [1]
  Material "matte" "rgb Kd" [0.5 0.5 0.5]
  Translate 0 -1 0
  Rotate -90 1 0 0
  Shape "disk" "float radius" [6]
WorldEnd
"""


def blocks():
    """What the page has marked, as {mark: text}."""
    with open(PAGE, encoding="utf-8") as f:
        return dict(re.findall(r"^<!-- (.*?) -->\n```\w*\n(.*?)^```$", f.read(), re.DOTALL | re.MULTILINE))


class DiffInCi(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.blocks = blocks()
        self.seed = 1
        os.makedirs(self.path("scenes"))
        self.write("scenes/box.pbrt", SCENE)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as f:
            f.write(text)

    def read(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def sh(self, mark, code=None):
        """Runs a block of the page, which must end with the code that its mark says, or with another; what it says."""
        found = [m for m in self.blocks if re.fullmatch(r"sh \d: " + mark, m)]
        self.assertEqual(len(found), 1, mark)
        path = os.path.dirname(os.path.abspath(WHIT)) + os.pathsep + os.environ["PATH"]
        done = subprocess.run(["sh", "-c", self.blocks[found[0]]], capture_output=True, text=True, check=False,
                              cwd=self.folder, stdin=subprocess.DEVNULL, timeout=300,
                              env={**os.environ, "PATH": path, "SEED": str(self.seed)})
        expected = int(found[0][3]) if code is None else code
        self.assertEqual(done.returncode, expected, "%s: %s%s" % (mark, done.stdout, done.stderr))
        return done.stdout + done.stderr

    def project(self):
        """Accepts a first run, then renders again with another seed."""
        self.sh("render")
        self.sh("accept")
        self.write("refs/policy.json", self.blocks["file: refs/policy.json"])
        self.seed = 2
        self.sh("render")

    def test_the_page_is_followed(self):
        self.project()
        said = self.sh("compare")
        self.assertIn("3 same, 0 differ, 0 cannot be compared, 0 missing, 0 extra", said)
        self.assertNotIn("warning", said)
        self.assertEqual(ElementTree.parse(self.path("report.xml")).getroot().find("testsuite").get("tests"), "3")
        self.assertTrue(self.read("report.html"))
        said = self.sh("mistake")
        with open(PAGE, encoding="utf-8") as page:
            quoted = re.search(r"says `(wrong\.json: .*?)`", page.read()).group(1)
        self.assertIn(quoted, said)
        self.sh("json")
        self.assertEqual([p["name"] for p in json.loads(self.read("report.json"))["pairs"]],
                         ["box.exr", "box.png", "soft/box.exr"])

    def test_a_change_is_found_and_accepted(self):
        self.project()
        self.write("scenes/box.pbrt", SCENE.replace("[0.6 0.3 0.2]", "[0.66 0.3 0.2]"))
        self.sh("render")
        said = self.sh("compare", code=1)
        for name in ("box.exr", "box.png", "soft/box.exr"):
            self.assertRegex(said, r"(?m)^differs  " + re.escape(name))
        said = self.sh("update")
        for name in ("box.exr", "box.png", "soft/box.exr"):
            self.assertIn("replaced  refs/" + name, said)
            self.assertEqual(self.read("out/" + name), self.read("refs/" + name))
        self.sh("compare")

    def test_the_table_has_every_key_of_a_rule(self):
        self.project()
        self.write("refs/policy.json", '{"rules": [{"match": "**", "qqqqqqqqqqqqqqqq": 1}]}')
        said = self.sh("compare", code=2)
        keys = re.search(r"it may have ([\w, ]+)", said).group(1).split(", ")
        with open(PAGE, encoding="utf-8") as page:
            rows = re.findall(r"^\| `(\w+)` \|", page.read(), re.MULTILINE)
        self.assertEqual(sorted(keys), sorted(rows))


if __name__ == "__main__":
    unittest.main()
