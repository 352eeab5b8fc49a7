#!/usr/bin/env python3
"""docs/hard-cases.md lists the cases of tests/hard as they are: all but the worst error seen, which differs from machine to
machine, is what tools/make-hard-cases would write now. ctest runs it after tests/hard, whose rows it reads."""
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.environ.get("WHIT_SOURCE_DIR") or os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
ROWS = os.path.join(os.environ.get("WHIT_BINARY_DIR", os.path.join(ROOT, "build", "release")), "hard-cases")
WORST = 4  # The column, counted from the empty text before the first "|".


def without_worst(text):
    return [[c for i, c in enumerate(line.split("|")) if i != WORST] for line in text.splitlines()]


class Page(unittest.TestCase):
    def test_is_current(self):
        with tempfile.TemporaryDirectory() as folder:
            made = os.path.join(folder, "page.md")
            subprocess.run([os.path.join(ROOT, "tools", "make-hard-cases"), made],
                           env={**os.environ, "WHIT_HARD_ROWS": ROWS}, check=True)
            with open(made, encoding="utf-8") as f:
                new = f.read()
        with open(os.path.join(ROOT, "docs", "hard-cases.md"), encoding="utf-8") as f:
            page = f.read()
        self.assertEqual(without_worst(page), without_worst(new), "run tools/make-hard-cases")


if __name__ == "__main__":
    if not os.path.isdir(ROWS):
        sys.exit(77)
    unittest.main()
