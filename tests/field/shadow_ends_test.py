#!/usr/bin/env python3
"""The far end of shadow rays, in scenes as they are found in the world: a light in the plane of a floor, a lamp in a shell."""
import array
import math
import os
import subprocess
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
WHIT = os.environ.get("WHIT", os.path.join(FOLDER, "..", "..", "build", "release", "whit"))


def red_rows(name):
    """The red of a scene's picture, row by row from the top."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.pfm")
        subprocess.run([WHIT, "--quiet", os.path.join(FOLDER, name), "-o", out, "--display", "none"], check=True, timeout=120)
        with open(out, "rb") as f:
            f.readline()
            width, height = map(int, f.readline().split())
            f.readline()
            values = array.array("f", f.read())
    return [values[3 * y * width:3 * (y + 1) * width:3] for y in reversed(range(height))]


class ShadowEnds(unittest.TestCase):
    def test_light_in_the_plane_of_a_floor(self):
        # The crop begins at pixel (116, 218) of 256 x 256. The camera stands at (0, 1, 6.8), so the wall z = -0.1 is 6.9
        # away: a pixel's place there, and the formula of the scene's first lines, in the mean of 8 x 8 places.
        rows, half = red_rows("light-in-plane.pbrt"), math.tan(math.radians(19.5 / 2)) * 6.9
        checked = 0
        for row, values in enumerate(rows):
            for column, found in enumerate(values):
                right = 0
                for k in range(64):
                    x = ((116 + column + (k % 8 + .5) / 8) / 128 - 1) * half
                    y = (1 - (218 + row + (k // 8 + .5) / 8) / 128) * half + 1
                    right += .5 / math.pi * .1 / (.01 + x * x + y * y) ** 1.5 / 64
                if (1 - (218 + row + 1) / 128) * half + 1 < 0:
                    continue  # the floor's edge is in it
                checked += 1
                self.assertAlmostEqual(found / right, 1, delta=.01, msg=f"row {row} column {column}")
        self.assertGreater(checked, 400)

    def test_lamp_in_a_shell(self):
        self.assertEqual(max(max(row) for row in red_rows("concentric-leak.pbrt")), 0)


if __name__ == "__main__":
    unittest.main()
