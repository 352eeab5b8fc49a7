#!/usr/bin/env python3
"""Vim shows a scene file's parts by their groups, and its settings for such files work. Skipped without vim."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
VIM = shutil.which("vim")

SCENE = """\
LookAt 0 0 5  0 -1.5e-3 0  0 1 0  # eye "float fov"
Camera "perspective" "float fov" [40]
Film "nothing" "string filename" "a \\"b\\" c.exr"
ActiveTransform StartTime
WorldBegin
  Texture "stripes" "spectrum" "checkerboard" "bool remap" "true"
  AttributeBegin
    Shape "sphere" "rgb Kd" [.5 .5 .5]
  AttributeEnd
  NamedMaterial "gold"
Spheer "sphere"
WorldEnd
"""
# A word of the scene, its line, which one of that spelling, and the group that it is shown as.
PLACES = [("LookAt", 1, 1, "pbrtTransform"), ("5", 1, 1, "pbrtNumber"), ("-1.5e-3", 1, 1, "pbrtNumber"),
          ("e-3", 1, 1, "pbrtNumber"), ("fov", 1, 1, "pbrtComment"), ("Camera", 2, 1, "pbrtStatement"),
          ("perspective", 2, 1, "pbrtPlugin"), ("float", 2, 1, "pbrtType"), ("fov", 2, 1, "pbrtParameter"),
          ("40", 2, 1, "pbrtNumber"), ("nothing", 3, 1, "pbrtString"), ("exr", 3, 1, "pbrtString"),
          ("StartTime", 4, 1, "pbrtWord"), ("WorldBegin", 5, 1, "pbrtBlock"), ("stripes", 6, 1, "pbrtString"),
          ("checkerboard", 6, 1, "pbrtPlugin"), ("bool", 6, 1, "pbrtType"), ("true", 6, 1, "pbrtBoolean"),
          ("AttributeBegin", 7, 1, "pbrtBlock"), ("Shape", 8, 1, "pbrtStatement"), ("sphere", 8, 1, "pbrtPlugin"),
          ("rgb", 8, 1, "pbrtType"), ("Kd", 8, 1, "pbrtParameter"), (".5", 8, 1, "pbrtNumber"),
          ("AttributeEnd", 9, 1, "pbrtBlock"), ("NamedMaterial", 10, 1, "pbrtNamed"), ("gold", 10, 1, "pbrtString"),
          ("Spheer", 11, 1, "pbrtUnknown"), ("WorldEnd", 12, 1, "pbrtBlock")]


class Vim(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.scene = os.path.join(self.folder, "scene.pbrt")
        with open(self.scene, "w", encoding="utf-8") as f:
            f.write(SCENE)

    def evaluate(self, *expressions):
        """What Vim makes of expressions with the scene open, a line for each."""
        out = os.path.join(self.folder, "out.txt")
        script = os.path.join(self.folder, "script.vim")
        with open(script, "w", encoding="utf-8") as f:
            f.write("set nocompatible runtimepath^=%s/tools/editors/vim\nfiletype plugin on\nsyntax on\nedit %s\n"
                    % (ROOT, self.scene))
            for expression in expressions:
                f.write("call writefile([string(%s)], '%s', 'a')\n" % (expression, out))
            f.write("qa!\n")
        environment = {**os.environ, "PATH": self.folder + ":" + os.environ["PATH"], "HOME": self.folder}
        subprocess.run([VIM, "-N", "-u", "NONE", "-i", "NONE", "-es", "-S", script], env=environment, timeout=60,
                       stdin=subprocess.DEVNULL, check=False)
        with open(out, encoding="utf-8") as f:
            return [line.strip("'") for line in f.read().splitlines()]

    def test_groups(self):
        lines = SCENE.splitlines()
        expressions = []
        for word, number, nth, _ in PLACES:
            column = -1
            for _ in range(nth):
                column = lines[number - 1].index(word, column + 1)
            expressions.append("synIDattr(synID(%d, %d, 1), 'name')" % (number, column + 1))
        got = self.evaluate(*expressions)
        self.assertEqual(got, [group for _, _, _, group in PLACES])

    def test_settings(self):
        fake = os.path.join(self.folder, "whit")  # is enough for the settings that need the program
        with open(fake, "w", encoding="utf-8") as f:
            f.write("#!/bin/sh\n")
        os.chmod(fake, 0o755)
        self.assertEqual(self.evaluate("&filetype", "&commentstring", "&formatprg", "&makeprg", "foldlevel(8)"),
                         ["pbrt", "# %s", "whit fmt -", "whit check %:S", "2"])

    def test_errors_have_their_places(self):
        said = ["scene.pbrt:8:13: error: unknown shape \\\"spere\\\"", "    8 |  Shape", "      | ^", "  did you mean"]
        got = self.evaluate("execute('compiler whit')", "setqflist([], 'r', {'lines': [%s], 'efm': &efm})"
                            % ", ".join('"%s"' % s for s in said),
                            "map(getqflist(), {_, e -> [e.lnum, e.col, e.type, e.text]})")
        self.assertEqual(got[-1], "[[8, 13, 'e', 'unknown shape \"spere\"']]")


if __name__ == "__main__":
    if not VIM:
        print("there is no vim")
        sys.exit(77)
    unittest.main()
