#!/usr/bin/env python3
"""White furnaces and what glass does to them: scenes whose every pixel is known. scenes/analytic has three more, which
tests/scripts/scenes_test.py renders.
"""
import math
import os
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")

SCENE = """\
Film "image" "integer xresolution" [%(size)d] "integer yresolution" [%(size)d]
Sampler "%(sampler)s" "integer pixelsamples" [%(spp)d]
PixelFilter "box"
Integrator "whitted" "integer maxdepth" [%(maxdepth)d]
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" [%(fov)g]
WorldBegin
  %(light)s
  %(world)s
WorldEnd
"""


@unittest.skipUnless(WHIT, "the program is not built")
class Furnace(unittest.TestCase):
    def render(self, world, size=32, spp=16, fov=20, maxdepth=12, sampler="halton",
               light='LightSource "infinite" "rgb L" [1 1 1]'):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([WHIT, "--quiet", "--type", "float", "--display", "none", "-o", folder + "/f.exr"],
                                  input=SCENE % locals(), capture_output=True, text=True, check=False, cwd=folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            pixels = oiio.ImageBuf(folder + "/f.exr").get_pixels(oiio.FLOAT)
        self.assertEqual(pixels.shape, (size, size, 3))
        return pixels

    def is_one_within_noise(self, pixels, spp):
        """The sky's directions are uniform over the sphere at worst: a sample 4 cos+(theta) has the variance 5/3. Six
        standard deviations for each of 1024 pixels, five for the mean of them."""
        self.assertLess(float(abs(pixels - 1).max()), 6 * math.sqrt(5 / 3 / spp))
        self.assertLess(abs(float(pixels.mean()) - 1), 5 * math.sqrt(5 / 3 / spp / 1024))
        self.assertGreater(float(pixels.std()), 0)  # it was sampled

    def test_matte_of_albedo_one_cannot_be_seen(self):
        # Fov 20: the picture spans 0.7 each way at z = 0; shapes of extent 1.2 or more fill it.
        for shape in ('Shape "sphere" "float radius" [1.2]', 'Scale 2 -1 1 Shape "sphere" "float radius" [1.2]',
                      'Shape "disk" "float radius" [3]', 'ReverseOrientation Rotate 30 1 0 0 Shape "disk" "float radius" [3]',
                      'Shape "trianglemesh" "integer indices" [0 1 2] "point P" [-9 -9 0  9 -9 0  0 9 0]'):
            for sampler in ("halton", "random"):
                with self.subTest(shape=shape, sampler=sampler):
                    pixels = self.render('Material "matte" "rgb Kd" [1 1 1] ' + shape, spp=256, sampler=sampler)
                    self.is_one_within_noise(pixels, 256)

    def test_oren_nayar_loses_a_known_share(self):
        # Seen along the normal, sin(theta_o) = 0: f = (1 - s^2 / (2 (s^2 + 0.33))) / pi with s = 20 degrees, so the plane
        # shows A = 1 - 0.121847 / (2 * 0.451847) = 0.865168. Fov 1: all of the picture is within half a degree of that.
        pixels = self.render('Material "matte" "rgb Kd" [1 1 1] "float sigma" [20] Shape "disk" "float radius" [3]', fov=1, spp=256)
        s2 = math.radians(20) ** 2
        self.assertLess(abs(float(pixels.mean()) - (1 - s2 / (2 * (s2 + 0.33)))), 5 * math.sqrt(5 / 3 / 256 / 1024) + 0.002)

    def test_a_mirror_cannot_be_seen(self):
        for shape in ('Shape "sphere"', 'Rotate 30 1 0 0 Shape "disk"'):
            pixels = self.render('Material "mirror" "rgb Kr" [1 1 1] ' + shape, fov=40)
            self.assertEqual((float(pixels.min()), float(pixels.max())), (1, 1))

    def test_perfect_glass_cannot_be_seen(self):
        # As scenes/analytic/furnace-glass.pbrt derives; here also scaled and mirrored.
        for placement in ("", "Scale -1 1 1", "Scale 0.9 1.1 2"):
            pixels = self.render(placement + ' Material "perfectglass" "float index" [1.5] Shape "sphere"', fov=32, size=64)
            self.assertGreaterEqual(float(pixels.mean()), 0.9999)
            self.assertLessEqual(float(pixels.max()), 1 + 1e-5)

    def test_smooth_white_models_cannot_be_seen(self):
        # By Schlick's approximation as by Fresnel's equations, what is not reflected goes through. At the edge of a ball most is
        # reflected, again and again.
        for parameters in ('"float metallic" 1', '"float metallic" 0 "float transmission" 1',
                           '"float metallic" 0 "float transmission" 1 "float ior" 1.2 "float clearcoat" 1',
                           '"float metallic" 0 "float transmission" 1 "bool thin" "false"', '"float opacity" 0'):
            with self.subTest(parameters=parameters):
                pixels = self.render('Material "metallicroughness" "float roughness" 0 %s Shape "sphere"' % parameters,
                                     fov=32, size=64, maxdepth=60)
                self.assertGreaterEqual(float(pixels.mean()), 0.9999)
                self.assertLessEqual(float(pixels.max()), 1 + 1e-5)

    def test_rough_white_models_cannot_be_seen(self):
        # All that facets leave is scattered by the body, within 0.002. Lights are sampled, then the lobes: the sky's directions
        # are uniform over the sphere at worst, and a lobe of alpha 0.49 and more is not far from even.
        for parameters in ('"float roughness" 0.7', '"float roughness" 1', '"float roughness" 1 "rgb sheencolor" [1 1 1] '
                           '"float sheenroughness" 0.6', '"float roughness" 1 "float clearcoat" 1 "float clearcoatroughness" 0.8'):
            with self.subTest(parameters=parameters):
                pixels = self.render('Material "metallicroughness" "float metallic" 0 %s Shape "disk" "float radius" 3'
                                     % parameters, spp=256)
                self.assertLess(abs(float(pixels.mean()) - 1), 5 * math.sqrt(5 / 3 / 256 / 1024) + 0.003)

    def test_a_black_lobe_removes_that_lobe_only(self):
        # Seen along its axis a ball of index 1.5 reflects R = (0.5 / 2.5)^2 = 0.04 at each boundary. Kr = 0: what is left
        # passes both boundaries, (1 - R)^2 = 0.9216, nothing between them. Kt = 0: the first reflection, R. Fov 0.01: the
        # angle of incidence stays below 0.002 degrees.
        glass = 'Material "perfectglass" "float index" [1.5] "rgb %s" [0 0 0] Shape "sphere"'
        for black, left in (("Kr", 0.96 ** 2), ("Kt", 0.04)):
            pixels = self.render(glass % black, fov=0.01)
            self.assertLess(float(abs(pixels / left - 1).max()), 1e-5, black)

    def test_one_boundary(self):
        """A plane of glass of index 1.5, met at 60 degrees; a wall of radiance 3 on one side, the sky of radiance 1 on the
        other. From outside sin(theta_t) = sin(60) / 1.5, R = (Rs + Rp) / 2 = 0.0891872, and radiance that comes out of the
        glass is 1 / 1.5^2 of what is in it. From inside 60 degrees are beyond the critical angle of 41.8: all is reflected.
        """
        cos_t = math.sqrt(1 - 0.75 / 2.25)
        r = (((0.5 - 1.5 * cos_t) / (0.5 + 1.5 * cos_t)) ** 2 + ((0.75 - cos_t) / (0.75 + cos_t)) ** 2) / 2
        scene = """Material "perfectglass" "float index" [1.5]
            AttributeBegin Rotate %d 0 1 0 Shape "disk" "float radius" [100] AttributeEnd
            Material "matte" "rgb Kd" [0 0 0] AreaLightSource "diffuse" "rgb L" [3 3 3] "bool twosided" ["true"]
            AttributeBegin Translate %d 0 0 Rotate 90 0 1 0 Shape "disk" "float radius" [500] AttributeEnd"""
        # The disk's normal is (sin, 0, cos) of the angle: at 60 degrees it faces the camera, at 240 it faces away. Seen along
        # -z, mirrored rays go to +x, refracted ones to -x. Fov 0.1: 0.05 degrees of angle change R by 1 %, the answers by 1e-3.
        for angle, wall, expected in ((60, -50, r * 1 + (1 - r) * 3 / 2.25), (60, 50, r * 3 + (1 - r) * 1 / 2.25),
                                      (240, -50, 1), (240, 50, 3)):
            with self.subTest(angle=angle, wall=wall):
                pixels = self.render(scene % (angle, wall), fov=0.1)
                self.assertLess(float(abs(pixels / expected - 1).max()), 1e-3)


if __name__ == "__main__":
    unittest.main()
