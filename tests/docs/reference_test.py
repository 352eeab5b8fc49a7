#!/usr/bin/env python3
"""docs/reference is what tools/make-reference makes of the program, and its examples are statements that it takes."""
import glob
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
WHIT = os.environ.get("WHIT", ROOT + "/build/release/whit")
OPTIONS = ("Camera", "Film", "PixelFilter", "Sampler", "Integrator")
REMEDY = "docs/reference is not what the program says: run tools/make-reference and commit it"


def pages(folder):
    """{file name: text} of all files in a folder."""
    out = {}
    for path in glob.glob(folder + "/*"):
        with open(path, encoding="utf-8") as f:
            out[os.path.basename(path)] = f.read()
    return out


def offences(committed, made):
    """What is wrong with the committed pages, a line each."""
    return (["%s is missing" % name for name in sorted(made.keys() - committed.keys())] +
            ["%s is not made any more" % name for name in sorted(committed.keys() - made.keys())] +
            ["%s is stale" % name for name in sorted(made.keys() & committed.keys()) if made[name] != committed[name]])


class Reference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, ROOT + "/tools/make-reference", folder], check=True,
                           env={**os.environ, "WHIT": WHIT})
            cls.made = pages(folder)

    def test_the_committed_pages_are_those_made_now(self):
        found = offences(pages(ROOT + "/docs/reference"), self.made)
        if found:
            self.fail("\n".join([REMEDY] + found))

    def test_every_difference_is_seen(self):
        self.assertEqual(offences(self.made, self.made), [])
        altered = dict(self.made, **{"lights.md": self.made["lights.md"].replace("30", "31", 1), "extra.md": ""})
        del altered["films.md"]
        self.assertEqual(offences(altered, self.made),
                         ["films.md is missing", "extra.md is not made any more", "lights.md is stale"])

    def test_the_examples_are_statements_that_the_program_takes(self):
        blocks = [b for text in self.made.values() for b in re.findall(r"^```\n(.*?)^```$", text, re.S | re.M)]
        # Each on a line and in a world of its own.
        examples = [" ".join(e.split()) for block in blocks for e in re.split(r"\n(?=\w)", block.strip())]
        self.assertGreater(len(examples), 60)
        with tempfile.TemporaryDirectory() as folder:
            with open(folder + "/all.pbrt", "w", encoding="utf-8") as f:
                for e in examples:
                    # Whatever must be given is in the example as [...]: without that it is refused, or left out.
                    e = re.sub(r' "[^"]*" \[\.\.\.\]', "", e)
                    light = 'LightSource "point" '
                    f.write(e + " WorldBegin " + light + "WorldEnd\n" if e.startswith(OPTIONS) else
                            "WorldBegin " + light + e + " WorldEnd\n")
            # Nothing uses what the examples define, nothing is in view, and some parameters need others.
            allow = [word for name in ("unused-texture", "unused-material", "unused-object", "unused-medium",
                                       "unused-coordinate-system", "useless-light", "empty-view", "ineffective-parameter")
                     for word in ("--allow", name)]
            said = subprocess.run([WHIT, "check", "all.pbrt", *allow], cwd=folder, check=False, capture_output=True, text=True)
        problems = dict(re.findall(r"^all\.pbrt:(\d+):\d+: (error|warning)", said.stderr, re.M))
        for number, e in enumerate(examples, 1):
            self.assertEqual(str(number) in problems, "[...]" in e, e + "\n" + said.stderr)


if __name__ == "__main__":
    unittest.main()
