#!/usr/bin/env python3
"""Instances by the ten thousands and by the million: each is where it belongs, and costs hundreds of bytes, whatever the
object holds.
"""
import math
import os
import re
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
SANITIZED = os.environ.get("WHIT_SANITIZE")

# Seen from above, through a parallel window of one unit a pixel. Of each object only a square of one unit shows, which
# fills one pixel; a mesh of 10,000 triangles, a sphere and a cylinder are below it.
HEADER = """
Film "image" "integer xresolution" [%(columns)d] "integer yresolution" [%(rows)d] "string filename" ["x.exr"]
Sampler "stratified" "integer xsamples" [1] "integer ysamples" [1] "bool jitter" ["false"]
Scale -1 1 1
LookAt 0 0 10  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [0 %(columns)d 0 %(rows)d]
WorldBegin
LightSource "distant" "point from" [0 0 1] "point to" [0 0 0]
ObjectBegin "thing"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [0 0 0  1 0 0  1 1 0  0 1 0]
Translate 0.5 0.5 -2
Shape "sphere" "float radius" [0.3]
Material "plastic"
Shape "cylinder" "float radius" [0.2]
%(mesh)s
ObjectEnd
"""


def ball(n):
    """A sphere of 2 n (n - 1) triangles and a radius of 0.4."""
    points = ["%.4f %.4f %.4f" % (0.4 * math.sin(t) * math.cos(p), 0.4 * math.sin(t) * math.sin(p), 0.4 * math.cos(t))
              for t in (math.pi * j / n for j in range(n + 1)) for p in (2 * math.pi * i / n for i in range(n))]
    indices = []
    for j in range(n):
        for i in range(n):
            a, b = j * n + i, j * n + (i + 1) % n
            if j > 0:
                indices.append("%d %d %d" % (a, a + n, b))
            if j < n - 1:
                indices.append("%d %d %d" % (b, a + n, b + n))
    return 'Shape "trianglemesh" "integer indices" [%s] "point P" [%s]' % (" ".join(indices), " ".join(points))


@unittest.skipUnless(WHIT, "the program is not built")
class Instances(unittest.TestCase):
    def render(self, columns, rows, there):
        """Places the object in the columns and rows where there(column, row); the picture, and the peak memory in bytes."""
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        with tempfile.TemporaryDirectory() as folder:
            scene, picture = os.path.join(folder, "scene.pbrt"), os.path.join(folder, "x.exr")
            with open(scene, "w", encoding="utf-8") as f:
                f.write(HEADER % {"columns": columns, "rows": rows, "mesh": ball(71)})
                for y in range(rows):
                    f.write("".join('TransformBegin Translate %d %d 0 ObjectInstance "thing" TransformEnd\n' % (x, y)
                                    for x in range(columns) if there(x, y)))
                f.write("WorldEnd\n")
            done = subprocess.run([WHIT, scene, "--outfile", picture, "--display", "none", "--stats"], capture_output=True,
                                  text=True, check=False, cwd=folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            peak = int(re.search(r"peak memory (\d+) MiB", done.stderr)[1]) * 2 ** 20
            return oiio.ImageBuf(picture).get_pixels(oiio.FLOAT)[:, :, 0], peak

    def verify(self, columns, rows, most_bytes):
        _, peak_of_one = self.render(columns, rows, lambda x, y: x == y == 0)
        pixels, peak = self.render(columns, rows, lambda x, y: (x + 3 * y) % 7 != 0)
        self.assertEqual(pixels.shape, (rows, columns))
        lit = (pixels[::-1] > 0.1).tolist()  # the picture's first row is at the top
        wrong = [(x, y) for y in range(rows) for x in range(columns) if lit[y][x] != ((x + 3 * y) % 7 != 0)]
        self.assertEqual((len(wrong), wrong[:3]), (0, []))
        if not SANITIZED:
            self.assertLess((peak - peak_of_one) / (columns * rows * 6 / 7), most_bytes)

    # Of an instance's bytes Embree takes 350, two matrices 256, and the statement's place 24; the text of the scene, and
    # what building takes for a while, count as well. The object itself has 700,000.
    def test_fifty_thousand(self):
        self.verify(250, 233, 1000)

    def test_a_million(self):
        self.verify(1100, 1061, 800)


if __name__ == "__main__":
    unittest.main()
