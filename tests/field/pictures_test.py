#!/usr/bin/env python3
"""Scenes as they are found in the world, each with the right value in its first lines: materials and pictures."""
import os
import subprocess
import tempfile
import unittest

import numpy

FOLDER = os.path.dirname(os.path.abspath(__file__))
WHIT = os.environ.get("WHIT", os.path.join(FOLDER, "..", "..", "build", "release", "whit"))


def read_pfm(path):
    """The picture's rows from the top, three numbers a pixel."""
    with open(path, "rb") as f:
        kind = f.readline().strip()
        width, height = map(int, f.readline().split())
        order = "<f4" if float(f.readline()) < 0 else ">f4"
        values = numpy.frombuffer(f.read(), order)
    return values.reshape(height, width, 3 if kind == b"PF" else 1)[::-1].astype(float)


class Pictures(unittest.TestCase):
    def render(self, name, *flags):
        """The picture of a scene of this folder, and what was said."""
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "out.pfm")
            run = subprocess.run([WHIT, "--quiet", os.path.join(FOLDER, name), "-o", out, "--display", "none", *flags],
                                 capture_output=True, text=True, check=False, timeout=120)
            self.assertEqual(run.returncode, 0, run.stderr)
            return read_pfm(out), run.stderr

    def test_fourier_with_two_zeros(self):
        # A diffuse reflectance of 0.5 under 25 W/sr at 4: 0.5 / pi * 25 / 16 = 0.2487 in the middle, and 0.24718 in the
        # mean of the 4 x 4 pixels around it, as of the same sphere in matte.
        picture, said = self.render("fourier-two-zeros.pbrt")
        self.assertAlmostEqual(picture[30:34, 30:34].mean(), 0.24718, delta=2e-4)
        self.assertEqual(said, "")


if __name__ == "__main__":
    unittest.main()
