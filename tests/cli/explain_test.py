#!/usr/bin/env python3
"""`whit explain` says of every scene in scenes/ what is stored in tests/cli/explain; with --store, stores it.

What is stored is to be read: a change of it is a change of what is simulated.
"""
import glob
import json
import os
import subprocess
import sys
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
GOLDEN = os.path.join(ROOT, "tests", "cli", "explain")


def scenes():
    found = glob.glob(os.path.join(ROOT, "scenes", "**", "*.pbrt"), recursive=True)
    return sorted(os.path.relpath(s, ROOT) for s in found if os.path.basename(os.path.dirname(s)) != "include")


def golden_of(scene):
    return os.path.join(GOLDEN, scene[len("scenes/"):-len(".pbrt")].replace("/", "-") + ".txt")


def explain(*arguments):
    return subprocess.run([WHIT, "explain", *arguments], capture_output=True, text=True, check=False, cwd=ROOT)


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


@unittest.skipUnless(WHIT, "the program is not built")
class Explain(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
        return path

    def test_each_scene_is_as_stored(self):
        for scene in scenes():
            with self.subTest(scene):
                done = explain(scene)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertEqual(done.stdout, read(golden_of(scene)))
        self.assertEqual(sorted(map(golden_of, scenes())), sorted(glob.glob(GOLDEN + "/*.txt")))

    def test_json_says_the_same(self):
        for scene in scenes():
            effects = json.loads(explain(scene, "--json").stdout)["worlds"][0]["effects"]
            on = read(golden_of(scene)).split("off\n")[0]
            for e in effects:
                self.assertEqual(e["on"], "\n  %s " % e["effect"] in on, (scene, e["effect"]))
                self.assertEqual(e["on"], "stages" in e)
                self.assertNotEqual(e["on"], "why_off" in e)

    def test_what_is_left_out_is_named_with_its_files(self):
        for name, size in (("wood.exr", 5000), ("tree.ply", 2048), ("leaves.pbrt", 100)):
            self.write(name, "x" * size)
        scene = self.write("scene.pbrt", """
            WorldBegin
            Texture "wood" "spectrum" "imagemap" "string filename" "wood.exr"
            Texture "one" "spectrum" "constant"
            MakeNamedMaterial "spare" "string type" "matte" "texture Kd" "wood"
            ObjectBegin "tree"
              Include "leaves.pbrt"
              Shape "plymesh" "string filename" "tree.ply"
            ObjectEnd
            LightSource "point" "rgb I" [0 0 0]
            Material "matte" "texture Kd" "one"
            Shape "sphere"
            WorldEnd
            """)
        done = explain(scene, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        left_out = {(e["kind"], e["name"]): e for e in json.loads(done.stdout)["worlds"][0]["left_out"]}
        files = {key: [(f["name"].split("/")[-1], f["bytes"]) for f in e.get("files", [])] for key, e in left_out.items()}
        reasons = {key: e["reason"] for key, e in left_out.items()}
        self.assertEqual(reasons, {
            ("texture", "wood"): "no visible surface uses it",
            ("texture", "one"): "the same everywhere: its users hold the value",
            ("material", "spare"): "no visible shape wears it",
            ("light", "point"): "it gives no light",
            ("object", "tree"): "it is never placed"})
        self.assertEqual(files[("texture", "wood")], [("wood.exr", 5000)])
        self.assertIn(("leaves.pbrt", 100), files[("object", "tree")])
        self.assertEqual(left_out[("texture", "wood")]["where"].split("/")[-1], "scene.pbrt:3:13")

    def test_what_is_placed_after_all_is_read(self):
        # The included file is more than a part of its object: it ends it, and places another.
        self.write("ball.pbrt", 'Shape "sphere"')
        self.write("part.pbrt", """Shape "sphere" ObjectEnd ObjectBegin "two" Include "ball.pbrt" ObjectEnd
            ObjectInstance "two" ObjectBegin "three" Shape "disk" """)
        scene = self.write("scene.pbrt", """WorldBegin
            ObjectBegin "one" Include "part.pbrt" ObjectEnd
            ObjectInstance "one" ObjectInstance "three"
            WorldEnd""")
        done = explain(scene, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        world = json.loads(done.stdout)["worlds"][0]
        self.assertEqual(world["left_out"], [])
        placed = [e for e in world["effects"] if e["effect"] == "instancing"][0]
        self.assertEqual(placed["called_for_by"], 3)

    def test_mistakes_end_it(self):
        self.write("ball.pbrt", 'Shape "sphere"')
        scene = self.write("scene.pbrt", """WorldBegin
            ObjectBegin "a" Include "ball.pbrt" ObjectEnd
            Translate 1 foo WorldEnd
            ObjectInstance "a"
            WorldEnd""")
        done = explain(scene)
        self.assertEqual((done.returncode, done.stdout), (3, ""))
        self.assertRegex(done.stderr, r"scene.pbrt:3:\d+: error: ")

    def test_names_need_not_be_utf8(self):
        scene = os.path.join(self.folder, "latin.pbrt")
        with open(scene, "wb") as f:
            f.write(b'WorldBegin Texture "caf\xe9" "float" "windy" Shape "sphere" WorldEnd')
        self.assertEqual(json.loads(explain(scene, "--json").stdout)["worlds"][0]["left_out"][0]["kind"], "texture")

    def test_switched_off_effects_say_so(self):
        text = explain("scenes/mesh.pbrt", "--without", "shadows").stdout
        self.assertIn("off\n  shadows             switched off\n      for distant at scenes/mesh.pbrt:14:3\n", text)
        only = explain("scenes/mesh.pbrt", "--only", "diffuse,delta-lights", "--json").stdout
        self.assertEqual([e["effect"] for e in json.loads(only)["worlds"][0]["effects"] if e["on"]],
                         ["diffuse", "delta-lights"])
        wrong = explain("scenes/mesh.pbrt", "--without", "shadow")
        self.assertEqual((wrong.returncode, wrong.stdout), (2, ""))
        self.assertEqual(wrong.stderr, 'whit explain: --without: there is no effect "shadow"; did you mean "shadows"?\n')
        both = explain("scenes/mesh.pbrt", "--without", "bump", "--only", "bump")
        self.assertEqual(both.returncode, 2)

    def test_it_looks_at_no_mesh_and_no_picture(self):
        # Neither file is what its name says; whoever reads one will notice.
        for name in ("wood.png", "tree.ply"):
            self.write(name, "nothing of the kind")
        scene = self.write("scene.pbrt", """WorldBegin
            Texture "wood" "spectrum" "imagemap" "string filename" "wood.png"
            Material "matte" "texture Kd" "wood"
            Shape "plymesh" "string filename" "tree.ply"
            WorldEnd""")
        self.assertEqual(explain(scene).returncode, 0)


def store():
    os.makedirs(GOLDEN, exist_ok=True)
    for scene in scenes():
        with open(golden_of(scene), "w", encoding="utf-8") as f:
            f.write(explain(scene).stdout)


if __name__ == "__main__":
    if sys.argv[1:] == ["--store"]:
        store()
    else:
        unittest.main()
