#!/usr/bin/env python3
"""The conformance scenes against pbrt-v3's pictures, by both comparers: `whit diff`, as tools/conformance calls it, and
compare.py.
"""
import concurrent.futures
import importlib.machinery
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
TOOL = os.path.normpath(os.path.join(HERE, "..", "..", "tools", "conformance"))
WHIT = os.environ.get("WHIT")


def load(name, path):
    """A Python program as a module."""
    loader = importlib.machinery.SourceFileLoader(name, path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def scene_file(name, folder=HERE):
    return os.path.join(folder, "scenes", name + ".pbrt")


def check(folder, names):
    """What `whit check` has to say against each scene, but for a texture that one does not use; nothing for those of which it knows everything."""
    files = {n: scene_file(n, folder) for n in names}
    done = subprocess.run([WHIT, "check", "--allow", "unused-texture", *files.values()], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=60, check=False)
    if done.returncode not in (0, 1):
        raise AssertionError("whit check: exit %d\n%s" % (done.returncode, done.stderr))
    said = {n: [line for line in done.stderr.splitlines() if line.startswith(files[n] + ":")] for n in names}
    if sum(map(len, said.values())) != len([line for line in done.stderr.splitlines() if re.search("(error|warning): ", line)]):
        raise AssertionError("whit check names no file:\n" + done.stderr)
    return {n: "check: " + lines[0][len(files[n]) + 1:] for n, lines in said.items() if lines}


@unittest.skipUnless(WHIT, "the program is not built")
class Conformance(unittest.TestCase):
    def test_whitted(self):
        self.pass_in(HERE, 133)

    def test_other_integrators(self):
        self.pass_in(HERE + "-paths", 37)

    def pass_in(self, folder, count):
        try:
            compare = load("compare", os.path.join(HERE, "compare.py"))
        except ImportError as e:
            self.fail("python3-numpy and python3-openimageio are needed (tools/install-deps test): %s" % e)
        tool = load("conformance_tool", TOOL)
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as f:
            limits = {s["name"]: s["limits"] for s in json.load(f)["scenes"]}
        self.assertEqual(len(limits), count)
        unknown = check(folder, limits)

        with tempfile.TemporaryDirectory() as out:
            def judge(name):
                """Why a scene does not pass; nothing when it does."""
                if name in unknown:
                    return [unknown[name]]
                picture, reference = os.path.join(out, name + ".exr"), os.path.join(folder, "ref", name + ".exr")
                ours = tool.check_scene(WHIT, scene_file(name, folder), reference, picture, limits[name])
                theirs = compare.compare_file(reference, picture, limits[name])
                return ["%s: %s" % (who, ", ".join(r["why"]))
                        for who, r in (("whit diff", ours), ("compare.py", theirs)) if r["status"] != "ok"]

            # Two at a time: much of a small picture's time is starting the program, which uses one core.
            with concurrent.futures.ThreadPoolExecutor(2) as pool:
                whys = dict(zip(limits, pool.map(judge, limits)))

        self.assertEqual({n: w for n, w in whys.items() if w}, {}, "these are off")


@unittest.skipUnless(WHIT, "the program is not built")
class Tool(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit conformance ")  # a path with spaces
        self.addCleanup(shutil.rmtree, self.folder)
        os.mkdir(self.folder + "/ref")
        os.mkdir(self.folder + "/scenes")

    def add(self, name, reference):
        shutil.copy(scene_file(name), self.folder + "/scenes")
        shutil.copy(os.path.join(HERE, "ref", reference + ".exr"), os.path.join(self.folder, "ref", name + ".exr"))

    def run_tool(self, *arguments):
        done = subprocess.run([sys.executable, TOOL, self.folder, "--out", self.folder + "/out", *arguments],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=False)
        return done.returncode, done.stdout.splitlines(), done.stderr

    def test_without_a_manifest(self):
        self.add("shapes-sphere", "shapes-sphere")
        code, said, _ = self.run_tool()
        self.assertEqual((code, said[-1]), (0, "1 passed, 0 failed"))
        self.assertFalse(os.path.exists(self.folder + "/out"))

    def test_invalid_samples_fail(self):
        # A sky of negative luminance behind the sphere: every sample that leaves is left out, and the picture is what it was.
        self.add("shapes-sphere", "shapes-sphere")
        path = self.folder + "/scenes/shapes-sphere.pbrt"
        with open(path, encoding="utf-8") as f:
            text = f.read()
        with open(path, "w", encoding="utf-8") as f:
            f.write(text.replace("WorldBegin", 'WorldBegin LightSource "infinite" "rgb L" [-9e-3 1e-3 1e-3]'))
        code, said, _ = self.run_tool()
        self.assertEqual((code, said[-1]), (1, "0 passed, 1 failed"))
        self.assertIn("samples were not valid", "\n".join(said))

    def test_failing_pictures_are_left(self):
        self.add("shapes-sphere", "shapes-sphere")
        self.add("shapes-disk", "shapes-sphere")
        code, said, _ = self.run_tool("--json", self.folder + "/result.json")
        self.assertEqual((code, said[-1]), (1, "1 passed, 1 failed"))
        self.assertRegex(said[1], r"^shapes-disk +off .* relmse")
        self.assertRegex(said[-2], r"^\d+\.\d CPU seconds, ")
        self.assertEqual(sorted(os.listdir(self.folder + "/out")),
                         ["shapes-disk.difference.png", "shapes-disk.exr", "shapes-disk.ref.exr"])
        with open(self.folder + "/result.json", encoding="utf-8") as f:
            self.assertEqual({n: r["status"] for n, r in json.load(f).items()}, {"shapes-disk": "off", "shapes-sphere": "ok"})
        self.assertEqual(self.run_tool("--only", "sphere")[0], 0)

    def test_the_manifest_gives_the_limits(self):
        self.add("shapes-sphere", "shapes-sphere")
        limits = {"relmse": 1e-9, "ratio": 0.01, "block": 0.08}
        with open(self.folder + "/manifest.json", "w", encoding="utf-8") as f:
            json.dump({"scenes": [{"name": "shapes-sphere", "limits": limits, "pbrt_seconds": 1.5}]}, f)
        code, said, _ = self.run_tool()
        self.assertEqual((code, said[-1]), (1, "0 passed, 1 failed"))
        self.assertRegex(said[1], " relmse, relmse_robust$")
        self.assertIn("pbrt-v3 1.5", said[-2])

    def test_what_cannot_be_rendered_fails(self):
        self.add("shapes-sphere", "shapes-sphere")
        with open(self.folder + "/scenes/shapes-sphere.pbrt", "a", encoding="utf-8") as f:
            f.write("Nonsense\n")
        code, said, _ = self.run_tool()
        self.assertEqual((code, said[-1]), (1, "0 passed, 1 failed"))
        self.assertIn("exit 3: ", said[1])

    def test_nothing_to_do_is_a_failure(self):
        self.assertEqual(self.run_tool()[0], 1)
        shutil.rmtree(self.folder + "/ref")
        self.assertEqual(self.run_tool()[0], 2)


if __name__ == "__main__":
    unittest.main()
