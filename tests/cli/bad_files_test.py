#!/usr/bin/env python3
"""The malformed files of tests/conformance/bad: each is refused, or rendered with a warning, as expect.json says, with a
message that names the file and the line; none crashes or hangs.
"""
import concurrent.futures
import json
import os
import re
import subprocess
import tempfile
import unittest

BAD = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "conformance", "bad"))
WHIT = os.environ.get("WHIT")

def outcome(expected, folder):
    """What is wrong with how the program takes a file; '' when nothing is."""
    name = expected["file"]
    picture = os.path.join(folder, name + ".exr")
    try:
        done = subprocess.run([WHIT, os.path.join(BAD, name), "--outfile", picture, "--quiet", "--display", "none"],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60, check=False)
    except subprocess.TimeoutExpired:
        return "does not end within 60 s"
    said = done.stderr.decode("utf-8", "replace")
    if done.stdout:
        return "writes to stdout"
    if expected["expect"] == "error":
        if done.returncode not in (3, 4):
            return "exit %d instead of 3 or 4: %s" % (done.returncode, said)
        if os.path.exists(picture):
            return "there is a picture"
    elif done.returncode != 0:
        return "exit %d instead of 0: %s" % (done.returncode, said)
    elif not os.path.exists(picture):
        return "there is no picture"
    kind = {"error": "error", "warn": "warning"}[expected["expect"]]
    if expected["line"] == 0:  # no line in particular
        lines = [r"(:\d+:\d+)?"]
    else:
        lines = [r":%d(:\d+)?" % line for line in [expected["line"]] + expected.get("also_lines", [])]
    if not any(re.search(r"^\S*%s%s: %s: \S" % (re.escape(name), line, kind), said, re.M) for line in lines):
        return "no %s names it at line %d: %s" % (kind, expected["line"], said)
    return ""


@unittest.skipUnless(WHIT, "the program is not built")
class BadFiles(unittest.TestCase):
    def test_outcomes(self):
        with open(os.path.join(BAD, "expect.json"), encoding="utf-8") as f:
            files = json.load(f)["files"]
        self.assertEqual({e["file"] for e in files}, {f for f in os.listdir(BAD) if f.endswith(".pbrt")})
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
            wrong = dict(zip((e["file"] for e in files), pool.map(lambda e: outcome(e, folder), files)))
        self.assertEqual({f: w for f, w in wrong.items() if w}, {}, "these are off")


if __name__ == "__main__":
    unittest.main()
