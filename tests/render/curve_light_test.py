#!/usr/bin/env python3
"""Curves with an AreaLightSource: they glow on every side, light nothing, and the program says so."""
import os
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")

SCENE = """\
Film "image" "integer xresolution" [40] "integer yresolution" [40]
LookAt 0 0 -5  0 0 0  0 1 0
Camera "orthographic"
WorldBegin
  AreaLightSource "diffuse" "rgb L" [3 3 3]
  Shape "curve" "float width" [0.8] "point P" [-1 0 0  -.3 0 0  .3 0 0  1 0 0]
WorldEnd
"""


@unittest.skipUnless(WHIT, "the program is not built")
class CurveLight(unittest.TestCase):
    def test_a_curve_glows_and_says_that_it_lights_nothing(self):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([WHIT, "--quiet", "--display", "none", "-o", folder + "/c.exr"], input=SCENE,
                                  capture_output=True, text=True, check=False, cwd=folder)
            self.assertEqual(done.returncode, 0)
            self.assertIn("a curve cannot light other surfaces", done.stderr)
            pixels = oiio.ImageBuf(folder + "/c.exr").get_pixels(oiio.FLOAT)
        # The picture spans [-1, 1] both ways and the curve crosses it, 0.8 of 2 high: 40 % of radiance 3.
        self.assertEqual(float(pixels.max()), 3)
        self.assertAlmostEqual(float(pixels.mean()), 1.2, delta=0.01)


if __name__ == "__main__":
    unittest.main()
