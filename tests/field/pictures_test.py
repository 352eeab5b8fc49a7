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

    def test_jpeg_textures_are_srgb(self):
        # 188 of 255 in sRGB is 0.50289, of which the light of pi makes radiance.
        picture, said = self.render("jpg-texture.pbrt")
        for half in (picture[:, 1:15], picture[:, 17:31]):
            numpy.testing.assert_allclose(half, 0.50289, atol=1e-4)
        self.assertEqual(said, "")

    def test_textures_are_decoded_by_what_their_file_says(self):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        srgb, raw = 0.50289, 188 / 255
        with open(os.path.join(FOLDER, "jpg-texture.pbrt"), encoding="utf-8") as f:
            text = f.read()
        cases = [("a.jpg", "uint8", {}, "", srgb), ("a.tif", "uint8", {}, "", srgb), ("a.bmp", "uint8", {}, "", srgb),
                 ("a.gif", "uint8", {}, "", srgb), ("a.ppm", "uint8", {}, "", srgb), ("16.tif", "uint16", {}, "", raw),
                 ("16s.tif", "uint16", {"oiio:ColorSpace": "sRGB"}, "", srgb), ("16.png", "uint16", {}, "", srgb),
                 ("f.tif", "float", {}, "", raw), ("a.hdr", "float", {}, "", raw), ("a.exr", "half", {}, "", raw),
                 ("a.tga", "uint8", {}, "", srgb), ("b.jpg", "uint8", {}, '"bool gamma" "false"', raw),
                 ("b.tif", "uint8", {}, '"bool gamma" "false"', raw), ("b.exr", "half", {}, '"bool gamma" "true"', srgb)]
        with tempfile.TemporaryDirectory() as folder:
            for name, kind, attributes, gamma, expected in cases:
                spec = oiio.ImageSpec(16, 16, 3, kind)
                for attribute, value in attributes.items():
                    spec.attribute(attribute, value)
                out = oiio.ImageOutput.create(os.path.join(folder, name))
                self.assertTrue(out.open(os.path.join(folder, name), spec), name)
                out.write_image(numpy.full((16, 16, 3), 188 / 255, numpy.float32))
                out.close()
                scene = os.path.join(folder, "s.pbrt")
                with open(scene, "w", encoding="utf-8") as f:
                    f.write(text.replace("half-grey.png", name).replace('"half-grey.jpg"', f'"{name}" {gamma}'))
                picture, said = self.render(scene)
                # Half a byte's step, and a mantissa of 8 bits; GIF and BMP are written by truncation.
                numpy.testing.assert_allclose(picture[:, 17:31], expected, atol=6e-3, err_msg=name)
                self.assertEqual(said, "", name)

    def test_the_top_row_of_a_map_does_not_light_the_lower_pole(self):
        picture, said = self.render("env-map-pole-leak.pbrt")
        self.assertEqual(picture.max(), 0)
        self.assertEqual(said, "")

    def test_empty_meshes_are_left_out(self):
        # The sphere under 20 W/sr at 4, Kd 0.5: 0.5 / pi * 20 / 16 = 0.199 in the middle.
        picture, said = self.render("empty-mesh.pbrt")
        self.assertAlmostEqual(picture[19:21, 19:21].mean(), 0.199, delta=2e-3)
        self.assertEqual(said.count("warning:"), 1, said)
        self.assertIn("warning: trianglemesh has no triangles", said)
        self.assertIn("left out", said)


if __name__ == "__main__":
    unittest.main()
