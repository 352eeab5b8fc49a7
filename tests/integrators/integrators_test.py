#!/usr/bin/env python3
"""Ambient occlusion, direct lighting and paths: pictures whose every pixel, or whose mean, is known, and what holds of every
integrator.

Where a picture has noise, its mean is allowed five standard deviations, which its pixels tell: they are independent, for
the filter is a box of one pixel.
"""
import json
import math
import os
import re
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")

SCENE = """\
Film "image" "integer xresolution" [%(size)d] "integer yresolution" [%(size)d]
Sampler "%(sampler)s" "integer pixelsamples" [%(spp)d]
PixelFilter "box"
Integrator %(integrator)s
LookAt %(eye)s
Camera "perspective" "float fov" [%(fov)g]
WorldBegin
%(world)s
WorldEnd
"""
PLANE = 'Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-50 -50 0  50 -50 0  50 50 0  -50 50 0]\n'
DOWN = "0 0 4  0 0 0  0 1 0"


def path(depth, more=""):
    return '"path" "integer maxdepth" [%d] %s' % (depth, more)


@unittest.skipUnless(WHIT, "the program is not built")
class Pictures(unittest.TestCase):
    def render(self, integrator, world, *flags, size=32, spp=64, fov=20, eye=DOWN, sampler="random"):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([WHIT, "--quiet", "--type", "float", "--display", "none", "-o", folder + "/p.exr", *flags],
                                  input=SCENE % locals(), capture_output=True, text=True, check=False, cwd=folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("invalid", done.stderr)
            return oiio.ImageBuf(folder + "/p.exr").get_pixels(oiio.FLOAT)

    @staticmethod
    def noise(pixels):
        """The standard deviation of the mean of a picture of one colour, from its pixels."""
        return float(pixels[..., 0].std()) / math.sqrt(pixels[..., 0].size)

    def has_mean(self, pixels, value, least=1e-5):
        off = abs(float(pixels[..., 0].mean()) - value)
        self.assertLess(off, 5 * self.noise(pixels) + least * max(value, 1), "mean %g, not %g" % (pixels[..., 0].mean(), value))

    def have_one_mean(self, a, b):
        """Of two pictures of the same view, whose pixels differ in expectation: pixel by pixel."""
        difference = (a - b)[..., 0]
        off, noise = abs(float(difference.mean())), float(difference.std()) / math.sqrt(difference.size)
        self.assertGreater(float(a.mean()), 0)
        self.assertLess(off, 5 * noise + 1e-6, "means %g and %g" % (a.mean(), b.mean()))


class Furnaces(Pictures):
    """Inside a closed surface that emits 1 everywhere and reflects the share a, every path that is as long as it may be
    brings 1 + a + a^2 + ...: a term for each bounce."""
    ROOMS = {
        "sphere": 'Shape "sphere" "float radius" [2]',
        "box": 'Shape "trianglemesh" "integer indices" [0 1 3 0 3 2  4 7 5 4 6 7  0 5 1 0 4 5  2 3 7 2 7 6  1 5 7 1 7 3  0 2 6 0 6 4]'
               ' "point P" [-2 -2 -2  2 -2 -2  -2 2 -2  2 2 -2  -2 -2 2  2 -2 2  -2 2 2  2 2 2]',
    }

    def room(self, shape, albedo, integrator, **options):
        world = ('Material "matte" "rgb Kd" [%(a)g %(a)g %(a)g] AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" "true" '
                 % {"a": albedo}) + self.ROOMS[shape]
        return self.render(integrator, world, eye="0.3 0.2 0  1 0.5 0.7  0 0 1", fov=90, **options)

    def test_each_bounce_adds_its_term(self):
        for shape in self.ROOMS:
            for depth in (0, 1, 2, 5):
                with self.subTest(shape=shape, depth=depth):
                    pixels = self.room(shape, 0.5, path(depth, '"float rrthreshold" [0]'))
                    self.has_mean(pixels, sum(0.5**k for k in range(depth + 1)))

    LAMP = 'AreaLightSource "diffuse" "rgb L" [1 1 1] %s %s Shape "sphere" "float radius" [1]'
    INSIDE = "0.1 0.1 0.05  1 0.3 0.4  0 0 1"

    def test_a_lamp_and_its_own_surface(self):
        # A sphere's points are inside or outside of it by rounding, and must see its far inner side either way. From inside
        # a reversed one shows 1 + 0.5. From outside a lamp of two fronts shows no more than it emits, and light that passes
        # its surface comes from its inner side, which is dark where it has one front; a reversed one is black.
        matte, sheet = 'Material "matte" "rgb Kd" [0.5 0.5 0.5]', 'Material "translucent" "rgb Kd" [1 1 1] "rgb Ks" [0 0 0] ' \
            '"rgb transmit" [0.5 0.5 0.5] "rgb reflect" [0 0 0]'
        places = ("", "Rotate 20 1 2 3", "Scale 1.001 1 1", "Translate 0 0 0.01 Rotate 33 1 0 2")
        for integrator in ('"whitted"', '"directlighting"', '"directlighting" "string strategy" "one"', path(1)):
            for place in places:
                for name, material, more, eye, value in (
                        ("inside", matte, "ReverseOrientation", self.INSIDE, 1.5),
                        ("two fronts", matte, "", "0 0 4  0 0 0  0 1 0", 1),
                        ("one front", sheet, "", "0 0 4  0 0 0  0 1 0", 1),
                        ("reversed", matte, "ReverseOrientation", "0 0 4  0 0 0  0 1 0", 0)):
                    with self.subTest(integrator=integrator, place=place, case=name):
                        lamp = self.LAMP % (more, place)
                        if name == "two fronts":
                            lamp = lamp.replace('[1 1 1]', '[1 1 1] "bool twosided" "true"', 1)
                        pixels = self.render(integrator, material + " " + lamp, eye=eye, spp=64, size=16,
                                             fov=60 if name == "inside" else 8)
                        self.has_mean(pixels, value, 1e-4)

    def test_endless_paths(self):
        # 1 / (1 - 0.8) = 5, less 0.8^101 = 1.6e-10. Roulette ends most of the paths early.
        for threshold in ("0", "1"):
            with self.subTest(threshold=threshold):
                self.has_mean(self.room("box", 0.8, path(100, '"float rrthreshold" [%s]' % threshold), spp=16), 5)

    def test_a_convex_white_body_cannot_be_seen_against_a_white_sky(self):
        sky = 'LightSource "infinite" "rgb L" [1 1 1]\n'
        for integrator in (path(5), '"directlighting"', '"directlighting" "string strategy" "one"'):
            for material in ('"matte" "rgb Kd" [1 1 1]', '"mirror" "rgb Kr" [1 1 1]', '"glass"', '"perfectglass"'):
                with self.subTest(integrator=integrator, material=material):
                    deep = integrator.replace("[5]", "[40]") if "path" in integrator else integrator + ' "integer maxdepth" [12]'
                    pixels = self.render(deep, sky + "Material " + material + ' Shape "sphere" "float radius" [1.2]',
                                         spp=16 if "path" in integrator else 4)
                    # direct lighting stops at 12: of glass at most 0.1 % of the light is inside then.
                    self.has_mean(pixels, 1, 1e-5 if "path" in integrator or "glass" not in material else 1e-3)


class OneMean(Pictures):
    """The same light found in different ways."""
    FLOOR = 'Material "plastic" "rgb Kd" [0.4 0.4 0.4] "rgb Ks" [0.4 0.4 0.4] "float roughness" [0.1]\n' + PLANE
    EYE = "0 -3 2.5  0 0 0  0 0 1"
    LAMP = 'Material "matte" "rgb Kd" [0 0 0] AreaLightSource "diffuse" "rgb L" [4 4 4]\n'

    SQUARE = 'Shape "trianglemesh" "integer indices" [0 2 1 0 3 2] "point P" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0]\n'

    def lamp(self, shape):
        return "AttributeBegin Translate 0 0.8 1.2\n" + self.LAMP + shape + "\nAttributeEnd\n"

    def test_direct_light_by_samples_of_lights_of_lobes_and_of_both(self):
        for shape in ('Shape "sphere" "float radius" [0.5]', 'Rotate 180 1 0 0 Shape "disk" "float radius" [0.6]',
                      'Shape "cylinder" "float radius" [0.3] "float zmin" [-0.4] "float zmax" [0.4]',
                      self.SQUARE):
            with self.subTest(shape=shape):
                world = self.lamp(shape) + self.FLOOR
                # An emitter in an object is seen, and not sampled: only sampled directions find it.
                unsampled = 'ObjectBegin "lamp"\n' + self.LAMP + shape + '\nObjectEnd\nAttributeBegin Translate 0 0.8 1.2 ' \
                            'ObjectInstance "lamp" AttributeEnd\n' + self.FLOOR
                by_light = self.render('"whitted"', world, eye=self.EYE, spp=256)
                for name, integrator, scene in (("both", '"directlighting"', world), ("path", path(1), world),
                                                ("one", '"directlighting" "string strategy" "one"', world),
                                                ("lobes", path(1), unsampled)):
                    with self.subTest(by=name):
                        self.have_one_mean(by_light, self.render(integrator, scene, eye=self.EYE, spp=256))

    def test_direct_light_of_a_sky(self):
        sky = 'LightSource "skybox" "rgb L" [1 1 1]\n'
        by_light = self.render('"whitted"', sky + self.FLOOR, eye=self.EYE, spp=256)
        for integrator in ('"directlighting"', path(1)):
            with self.subTest(integrator=integrator):
                self.have_one_mean(by_light, self.render(integrator, sky + self.FLOOR, eye=self.EYE, spp=256))

    def test_lights_some_of_which_lie_on_a_surface(self):
        # The spot is in the plane of a sheet, where rays end more exactly; that of the panel, which few or no rays to the spot
        # go along with, must neither end on the panel itself nor go through what is before it.
        panel = "AttributeBegin Translate 0 0.3 1.2 " + self.LAMP + self.SQUARE + "AttributeEnd\n"
        spot = 'LightSource "spot" "point from" [-0.7 0 0.8] "point to" [-0.7 0 0] "rgb I" [1 1 1]\n'
        sheet = "AttributeBegin Translate -0.8 0 0.8 Scale 0.8 0.6 1 " + self.SQUARE + "AttributeEnd\n"
        for name, world in (("panel first", panel + spot), ("spot first", spot + panel)):
            by_light = self.render('"whitted"', world + self.FLOOR + sheet, eye=self.EYE, fov=50, spp=64)
            for integrator in (path(1), '"directlighting" "string strategy" "one"'):
                with self.subTest(lights=name, integrator=integrator):
                    pixels = self.render(integrator, world + self.FLOOR + sheet, eye=self.EYE, fov=50, spp=64)
                    self.have_one_mean(by_light, pixels)

    def test_samples_of_a_light(self):
        lamp = self.lamp('Shape "sphere" "float radius" [0.5]')
        many = lamp.replace('"rgb L"', '"integer samples" [7] "rgb L"')
        self.have_one_mean(self.render('"directlighting"', lamp + self.FLOOR, eye=self.EYE),
                           self.render('"directlighting"', many + self.FLOOR, eye=self.EYE))

    LIGHTS = "".join('AttributeBegin Translate %g %g 1 AreaLightSource "diffuse" "rgb L" [%g 1 1] Shape "sphere" "float radius" [0.1] '
                     "AttributeEnd\n" % (x, y, 1 + 5 * (x > 0)) for x in (-1, 0, 1) for y in (-1, 0, 1)) + \
        'LightSource "infinite" "rgb L" [0.2 0.2 0.2]\nLightSource "point" "point from" [3 0 2] "rgb I" [2 2 2]\n'

    def test_however_a_light_is_chosen(self):
        world = self.LIGHTS + self.FLOOR
        pictures = [self.render(path(2, '"string lightsamplestrategy" "%s"' % s), world, eye=self.EYE, spp=128)
                    for s in ("uniform", "power", "spatial")]
        self.have_one_mean(pictures[0], pictures[1])
        self.have_one_mean(pictures[0], pictures[2])
        self.have_one_mean(self.render(path(1), world, eye=self.EYE, spp=128),
                           self.render('"directlighting"', world, eye=self.EYE, spp=32))

    def test_without_indirect_light_paths_are_direct(self):
        world = self.LIGHTS + 'Material "mirror" AttributeBegin Translate 0 0 0.5 Shape "sphere" "float radius" [0.4] AttributeEnd\n' + \
            self.FLOOR
        self.have_one_mean(self.render(path(5), world, "--without", "indirect", eye=self.EYE, spp=128),
                           self.render('"directlighting"', world, eye=self.EYE, spp=32))

    def test_roulette_and_none(self):
        world = self.lamp('Shape "sphere" "float radius" [0.5]') + self.FLOOR + \
            'AttributeBegin Translate 0 1.5 0 Rotate 90 1 0 0 ' + PLANE + 'AttributeEnd AttributeBegin Material "glass" ' \
            'Translate 0.5 -0.3 0.5 Shape "sphere" "float radius" [0.4] AttributeEnd\n'
        self.have_one_mean(self.render(path(12, '"float rrthreshold" [0]'), world, eye=self.EYE, spp=128),
                           self.render(path(12), world, eye=self.EYE, spp=128))


class AmbientOcclusion(Pictures):
    WALL = 'Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [1 -900 0  1 900 0  1 900 2  1 -900 2]\n'

    def test_share_of_the_hemisphere_beside_a_wall(self):
        # Seen from x = 0, an endless wall at x = 1 of the height 2 takes (1 - 1 / sqrt(1 + 4)) / 2 = 0.276393 of the
        # cosine-weighted hemisphere (form factor of perpendicular strips). Fov 0.1: all of the picture is at x = 0 +- 0.0035.
        free = math.pi * (1 - 0.276393)
        for sampling in ("true", "false"):
            with self.subTest(cossample=sampling):
                pixels = self.render('"ambientocclusion" "bool cossample" "%s"' % sampling, PLANE + self.WALL, fov=0.1, spp=16)
                self.has_mean(pixels, free, 3e-3)

    def test_without_anything_over_it_and_with_nothing(self):
        self.assertLess(abs(self.render('"ambientocclusion"', PLANE, spp=1) - math.pi).max(), 1e-5)
        self.assertEqual(self.render('"ambientocclusion"', "", spp=1).max(), 0)
        # Materials and lights are nothing to it; nor is the side that is seen.
        dressed = 'LightSource "infinite" Material "mirror" AreaLightSource "diffuse" ReverseOrientation ' + PLANE
        self.assertLess(abs(self.render('"ambientocclusion"', dressed, spp=1) - math.pi).max(), 1e-5)


@unittest.skipUnless(WHIT, "the program is not built")
class Memory(unittest.TestCase):
    """What is asked for a million times is asked for in the same memory."""

    def peak(self, integrator, world, spp):
        """MiB, of one pixel."""
        scene = SCENE % {"size": 1, "sampler": "random", "spp": spp, "integrator": integrator, "eye": "0.3 0.2 0  1 0.5 0.7  0 0 1",
                         "fov": 90, "world": world}
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([WHIT, "--nthreads", "1", "--display", "none", "-o", folder + "/p.exr"], input=scene,
                                  capture_output=True, text=True, check=False, cwd=folder)
        said = done.stdout + done.stderr
        self.assertEqual(done.returncode, 0, said)
        self.assertIn("invalid samples 0.", said)
        return int(re.search(r"peak memory (\d+) MiB", said).group(1))

    def test_depths(self):
        # A queue of rays takes 4 KiB or more: one for each depth would take 400 MiB.
        room = 'LightSource "infinite" Material %s Shape "sphere" "float radius" [2]'
        for integrator, material in (("path", "matte"), ("path", "mirror"), ("directlighting", "mirror"), ("whitted", "mirror")):
            with self.subTest(integrator=integrator, material=material):
                deep = '"%s" "integer maxdepth" [100000] %s' % (integrator, '"float rrthreshold" [0]' if integrator == "path" else "")
                albedo = '"%s" "rgb %s" [1 1 1]' % (material, "Kd" if material == "matte" else "Kr")
                self.assertLess(self.peak(deep, room % albedo, 8), 100)

    def test_samples_of_a_light(self):
        # The arrays of one sample for 64 points take about 8 KiB.
        lamp = 'AttributeBegin AreaLightSource "diffuse" "integer samples" [100000] Translate 0 0 1 Shape "sphere" ' \
            '"float radius" [0.1] AttributeEnd\nShape "sphere" "float radius" [2]'
        self.assertLess(self.peak('"directlighting"', lamp, 64), 100)

    def test_directions_of_ambient_occlusion(self):
        room = 'Shape "sphere" "float radius" [2]'
        self.assertLess(self.peak('"ambientocclusion" "integer nsamples" [100000]', room, 64), 100)


class Every(Pictures):
    """What holds of every integrator there is."""
    WORLD = 'LightSource "infinite" "rgb L" [0.3 0.4 0.5]\nLightSource "point" "point from" [-2 -1 3] "rgb I" [9 9 9]\n' + OneMean.LIGHTS + \
        'AttributeBegin Material "glass" Translate -0.6 0 0.4 Shape "sphere" "float radius" [0.4] AttributeEnd\n' \
        'AttributeBegin Material "none" Translate 0 0 0.4 Shape "sphere" "float radius" [0.45] AttributeEnd\n' \
        'AttributeBegin Material "metal" Translate 0.7 0 0.4 Shape "sphere" "float radius" [0.4] AttributeEnd\n' + OneMean.FLOOR

    def names(self):
        known = json.loads(subprocess.run([WHIT, "help", "--json"], capture_output=True, text=True, check=True).stdout)
        names = [p["name"] for p in known["plugins"] if p["category"] == "integrator"]
        self.assertLessEqual({"whitted", "path", "directlighting", "ambientocclusion"}, set(names))
        return names

    def test_same_bits_for_any_threads_and_crop(self):
        options = {"eye": OneMean.EYE, "fov": 60, "size": 80, "spp": 8, "sampler": "halton"}
        for name in self.names():
            with self.subTest(integrator=name):
                one = self.render('"%s"' % name, self.WORLD, "--nthreads", "1", **options)
                self.assertGreater(float(one.std()), 0.01)
                two = self.render('"%s"' % name, self.WORLD, "--nthreads", "2", **options)
                self.assertEqual(one.tobytes(), two.tobytes())
                part = self.render('"%s"' % name, self.WORLD, "--cropwindow", "0.3", "0.81", "0.21", "0.7", **options)
                self.assertEqual(one[17:56, 24:65].tobytes(), part.tobytes())

    def test_named_on_the_command_line(self):
        options = {"eye": OneMean.EYE, "spp": 4, "sampler": "halton"}
        for name in self.names():
            with self.subTest(integrator=name):
                self.assertEqual(self.render('"%s"' % name, self.WORLD, **options).tobytes(),
                                 self.render('"whitted"', self.WORLD, "--integrator", name, **options).tobytes())


if __name__ == "__main__":
    unittest.main()
