#!/usr/bin/env python3
"""README.md, CONTRIBUTING.md and docs/: links lead somewhere, commands print what is written, the map is complete."""
import glob
import os
import re
import shlex
import subprocess
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
PAGES = [ROOT + "/README.md", ROOT + "/CONTRIBUTING.md"] + sorted(
    glob.glob(ROOT + "/docs/**/*.md", recursive=True))
WHIT = os.environ.get("WHIT", ROOT + "/build/release/whit")


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def without_code(text):
    return re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)


class Pages(unittest.TestCase):
    def test_links_lead_somewhere(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", without_code(read(page))):
                if re.match(r"https?:", target):
                    continue
                path, _, anchor = target.partition("#")
                there = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
                self.assertTrue(os.path.exists(there), "%s: %s" % (page, target))
                if anchor:
                    anchors = {re.sub(r"[^\w\- ]", "", h).strip().lower().replace(" ", "-")
                               for h in re.findall(r"^#+ (.*)$", read(there), re.MULTILINE)}
                    self.assertIn(anchor, anchors, page)

    def test_lines_are_short(self):
        for page in PAGES:
            for number, line in enumerate(read(page).splitlines(), 1):
                if not line.startswith(("|", "$", "<!--")) and "console" not in line:
                    self.assertLessEqual(len(line), 120, "%s:%d" % (page, number))

    def test_files_named_in_code_spans_exist(self):
        # `core/base/vec.h` and the like: a name with a folder of ours in front.
        names = re.compile(r"`((?:core|parser|plugins|tools|scenes|docs|tests)/[\w./-]*\w)`")
        for page in PAGES:
            for name in names.findall(without_code(read(page))):
                there = glob.glob(os.path.join(ROOT, name) + "*")
                self.assertTrue(there or name in ("plugins/materials/paper.cpp", "plugins/integrators/dome.cpp"), "%s: %s" % (page, name))

    def test_the_map_has_every_header(self):
        text = read(ROOT + "/docs/map.md")
        for folder in ("core/*", "parser", "plugins/shared"):
            for path in sorted(glob.glob("%s/%s/*.h" % (ROOT, folder))):
                name = os.path.relpath(path, ROOT)
                self.assertTrue("| `%s` |" % name in text, "docs/map.md has no line for %s" % name)
        for name in re.findall(r"^\| `([\w./]+\.h)` \|", text, re.MULTILINE):
            self.assertTrue(os.path.exists(os.path.join(ROOT, name)), "docs/map.md has a line for %s" % name)

    def test_commands_print_what_is_written(self):
        self.assertTrue(os.path.exists(WHIT), "the program is not built")
        ran = 0
        with tempfile.TemporaryDirectory() as folder:
            os.makedirs(folder + "/build/release")
            os.symlink(WHIT, folder + "/build/release/whit")
            os.symlink(ROOT + "/scenes", folder + "/scenes")
            for page in PAGES:
                if page.endswith(("/add-a-material.md", "/add-an-integrator.md", "/diff-in-ci.md",
                                  "/install.md")):
                    continue  # have tests of their own
                blocks = re.findall(r"^<!-- (.*?) -->\n```\w*\n(.*?)^```$", read(page), re.DOTALL | re.MULTILINE)
                for mark, text in blocks:
                    if mark.startswith("file: "):
                        with open(os.path.join(folder, mark.removeprefix("file: ")), "w", encoding="utf-8") as f:
                            f.write(text)
                        continue
                    self.assertEqual(mark, "run", page)
                    for command, expected in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", text, re.MULTILINE):
                        done = subprocess.run(shlex.split(command), capture_output=True, text=True, check=False,
                                              cwd=folder, stdin=subprocess.DEVNULL, timeout=120)
                        said = re.sub(r" +$", "", done.stdout + done.stderr, flags=re.MULTILINE)
                        self.assertEqual(said, expected, "%s: %s" % (page, command))
                        ran += 1
        self.assertGreaterEqual(ran, 3)


if __name__ == "__main__":
    unittest.main()
