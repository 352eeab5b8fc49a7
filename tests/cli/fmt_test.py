#!/usr/bin/env python3
"""`whit fmt` of several files, --check, --in-place and what .editorconfig says."""
import os
import shutil
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
UGLY = 'WorldBegin\nAttributeBegin\nShape   "sphere"\nAttributeEnd\nWorldEnd\n'
NICE = 'WorldBegin\nAttributeBegin\n  Shape "sphere"\nAttributeEnd\nWorldEnd\n'


class Fmt(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.write(".editorconfig", "root = true\n")

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8", newline="") as f:
            f.write(text)

    def read(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8", newline="") as f:
            return f.read()

    def whit(self, *args, stdin=None):
        done = subprocess.run([WHIT, "fmt", *args], cwd=self.folder, input=stdin or "", check=False, capture_output=True,
                              text=True, timeout=60)
        return done.returncode, done.stdout, done.stderr

    def test_check(self):
        self.write("a.pbrt", UGLY)
        self.write("b.pbrt", NICE)
        self.assertEqual(self.whit("--check", "a.pbrt", "b.pbrt"), (1, "a.pbrt is not in normal form\n", ""))
        self.assertEqual(self.whit("--check", "b.pbrt"), (0, "", ""))
        self.assertEqual(self.whit("--check", stdin=NICE), (0, "", ""))
        self.assertEqual(self.whit("--check", stdin=UGLY), (1, "<stdin> is not in normal form\n", ""))
        self.assertEqual(self.read("a.pbrt"), UGLY)
        self.assertEqual(self.whit("--check", "-i", "b.pbrt")[0], 2)

    def test_several_in_place(self):
        self.write("a.pbrt", UGLY)
        self.write("b.pbrt", "Shap\n")
        self.write("c.pbrt", UGLY)
        code, out, err = self.whit("-i", "a.pbrt", "b.pbrt", "c.pbrt")
        self.assertEqual((code, out), (3, ""))
        self.assertIn("b.pbrt:1:1: error", err)
        self.assertEqual([self.read(n) for n in ("a.pbrt", "b.pbrt", "c.pbrt")], [NICE, "Shap\n", NICE])
        self.assertEqual(self.whit("a.pbrt", "c.pbrt")[0], 2)
        self.assertEqual(self.whit("a.pbrt"), (0, NICE, ""))

    def test_editorconfig(self):
        def indented(by):
            return NICE.replace("  Shape", by + "Shape")
        cases = {
            "[*]\nindent_style = tab\n": "\t",
            "[*.pbrt]\nindent_size = 4\n": "    ",
            "[*.py]\nindent_size = 4\n": "  ",
            "[*.{py,pbrt}]\nIndent_Size = 3\n": "   ",
            "[*.pbrt]\nindent_style = space\nindent_size = tab\ntab_width = 8\n": " " * 8,
            "[*.pbrt]\nindent_size = 4\n[s.pbrt]\nindent_size = 1\n": " ",
            "[*.pbrt]\nindent_size = 4\n[other/*.pbrt]\nindent_size = 1\n": "    ",
            "[sub/**.pbrt]\nindent_size = 4\n": "    ",
            "[**/s.pbrt]\nindent_size = 4\n": "    ",
            "[?.pbrt]\nindent_size = 4\n": "    ",
            "[[!a-r].pbrt]\nindent_size = 4\n": "    ",
            "[[a-r].pbrt]\nindent_size = 4\n": "  ",
            "[*.pbrt]\nindent_size = many\n": "  ",
            "# comment\n; comment\n[*.pbrt]\nindent_size=0\n": "",
            "[*.pbrt]\nindent_size = unset\n": "  ",
        }
        for text, by in cases.items():
            with self.subTest(text):
                self.write(".editorconfig", "root = true\n" + text)
                self.write("sub/s.pbrt", UGLY)
                self.assertEqual(self.whit("sub/s.pbrt"), (0, indented(by), ""))
                self.write("sub/s.pbrt", indented(by))
                self.assertEqual(self.whit("--check", "sub/s.pbrt"), (0, "", ""))

    def test_nearer_files_and_roots(self):
        self.write(".editorconfig", "root = true\n[*.pbrt]\nindent_size = 4\nend_of_line = crlf\n")
        self.write("sub/.editorconfig", "[*.pbrt]\nindent_size = 1\n")
        self.write("sub/s.pbrt", UGLY)
        self.assertEqual(self.whit("-i", "sub/s.pbrt"), (0, "", ""))
        self.assertEqual(self.read("sub/s.pbrt"), NICE.replace("  Shape", " Shape").replace("\n", "\r\n"))
        self.assertEqual(self.whit("--check", "sub/s.pbrt"), (0, "", ""))
        self.write("sub/.editorconfig", "root = TRUE\n[*.pbrt]\nindent_size = 1\n")
        self.write("sub/s.pbrt", UGLY)
        self.assertEqual(self.whit("-i", "sub/s.pbrt"), (0, "", ""))
        self.assertEqual(self.read("sub/s.pbrt"), NICE.replace("  Shape", " Shape"))


if __name__ == "__main__":
    unittest.main()
