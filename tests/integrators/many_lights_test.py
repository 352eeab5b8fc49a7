#!/usr/bin/env python3
"""Some of many lights at each point (`--lights tree`) in the place of all: the same picture but for noise, and the very same
where the lights are few.

Where a picture has noise, its mean is allowed five standard deviations, which its pixels tell: they are independent, for
the filter is a box of one pixel and the sampler is "random".
"""
import json
import math
import os
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
CHOSEN = 16  # for each point, as docs/speed.md says

SCENE = """\
Film "image" "integer xresolution" [%(size)d] "integer yresolution" [%(size)d]
Sampler "random" "integer pixelsamples" [%(spp)d]
PixelFilter "box"
Integrator %(integrator)s
LookAt 0 -4 3  0 0 0.3  0 0 1
Camera "perspective" "float fov" [40]
WorldBegin
%(lights)s
Material "plastic" "rgb Kd" [0.4 0.4 0.4] "rgb Ks" [0.4 0.4 0.4] "float roughness" [0.1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]
AttributeBegin
Translate -0.6 0.2 0.4
Shape "sphere" "float radius" [0.4]
AttributeEnd
AttributeBegin
Material "mirror"
Translate 0.7 0.5 0.3
Shape "sphere" "float radius" [0.3]
AttributeEnd
WorldEnd
"""
MATTE_BLACK = 'AttributeBegin Material "matte" "rgb Kd" [0 0 0]\n'


def ball(around, along):
    """A lamp of 2 x around x (along - 1) triangles, of which every point of the floor sees some."""
    points, triangles = [], []
    for ring in range(along + 1):
        for step in range(around):
            polar, azimuth = math.pi * ring / along, 2 * math.pi * step / around
            r = 0.3 * (1 + 0.2 * math.sin(5 * polar) * math.sin(4 * azimuth))
            points.append((r * math.sin(polar) * math.cos(azimuth), r * math.sin(polar) * math.sin(azimuth), r * math.cos(polar)))
    for ring in range(along):
        for step in range(around):
            a, b = ring * around + step, ring * around + (step + 1) % around
            c, d = a + around, b + around
            triangles += [(a, c, d)] if ring < along - 1 else []
            triangles += [(a, d, b)] if ring > 0 else []
    return MATTE_BLACK + 'Translate 0.2 0.3 1.4 AreaLightSource "diffuse" "rgb L" [6 5 4]\nShape "trianglemesh" ' \
        '"integer indices" [%s] "point P" [%s]\nAttributeEnd\n' % (
            " ".join("%d %d %d" % t for t in triangles), " ".join("%.6g %.6g %.6g" % p for p in points))


def bulbs(count):
    """Point lights in a row, some of them spots that leave most of the floor dark."""
    return "".join('LightSource "%s" "rgb I" [%g 0.3 0.3] "point from" [%g 0.5 1] %s\n' % (
        "spot" if k % 3 == 0 else "point", 0.2 + 0.1 * (k % 4), -1.5 + 3 * k / count,
        '"point to" [%g 0 0]' % (k % 5 - 2) if k % 3 == 0 else "") for k in range(count))


SUN_AND_SKY = 'LightSource "distant" "rgb L" [0.6 0.5 0.4] "point from" [1 -1 2] "point to" [0 0 0]\n' \
    'LightSource "infinite" "rgb L" [0.2 0.25 0.3]\n'


@unittest.skipUnless(WHIT, "the program is not built")
class ManyLights(unittest.TestCase):
    def render(self, integrator, lights, *flags, size=48, spp=16):
        """The picture, and what --stats tells."""
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([WHIT, "--quiet", "--type", "float", "--display", "none", "-o", folder + "/p.exr",
                                   "--stats", folder + "/s.json", *flags],
                                  input=SCENE % locals(), capture_output=True, text=True, check=False, cwd=folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            with open(folder + "/s.json", encoding="utf-8") as f:
                stats = json.load(f)
            return oiio.ImageBuf(folder + "/p.exr").get_pixels(oiio.FLOAT)[..., :3], stats

    def have_one_mean(self, a, b):
        """Of two pictures of the same view: all of it, and each of nine parts, so that no light may be shifted."""
        size = a.shape[0] // 3
        parts = [(slice(None), slice(None))] + [
            (slice(y * size, (y + 1) * size), slice(x * size, (x + 1) * size)) for y in range(3) for x in range(3)]
        for part in parts:
            difference = (a - b)[part].mean(axis=-1)
            off, noise = abs(float(difference.mean())), float(difference.std()) / math.sqrt(difference.size)
            self.assertLess(off, 5 * noise + 1e-5, part)

    def test_the_mean_is_that_of_all(self):
        scenes = {"mesh": ball(12, 9), "bulbs": bulbs(60), "mesh, sun and sky": ball(8, 6) + SUN_AND_SKY,
                  "all kinds": bulbs(20) + ball(8, 6) + SUN_AND_SKY}
        for integrator in ('"whitted"', '"directlighting"'):
            for name, lights in scenes.items():
                with self.subTest(integrator=integrator, lights=name):
                    every, told = self.render(integrator, lights, spp=8)
                    self.assertGreater(float(every.mean()), 0.01)
                    self.assertIsNone(told["settings"]["lights_chosen"])
                    some, told = self.render(integrator, lights, "--lights", "tree", "--seed", "7", spp=32)
                    self.assertEqual(told["settings"]["lights_chosen"], CHOSEN)
                    self.assertGreater(told["settings"]["lights"], CHOSEN)
                    self.have_one_mean(every, some)

    def test_one_light_has_that_mean_too(self):
        lights = bulbs(20) + ball(8, 6) + SUN_AND_SKY
        every, _ = self.render('"directlighting"', lights, spp=8)
        one, told = self.render('"directlighting" "string strategy" "one"', lights, "--seed", "7", spp=64)
        self.assertEqual(told["settings"]["lights_chosen"], 1)
        self.have_one_mean(every, one)

    def test_it_is_less_work(self):
        # 13 points see about half of 192 triangles each; 16 lights are 16 shadow rays at most.
        lights = ball(12, 9)
        _, every = self.render('"whitted"', lights, spp=1)
        _, some = self.render('"whitted"', lights, "--lights", "tree", spp=1)
        self.assertGreater(every["rays"]["shadow"], 3 * some["rays"]["shadow"])
        points = some["rays"]["camera"] + some["rays"]["reflection"]
        self.assertLessEqual(some["rays"]["shadow"], CHOSEN * points)

    def test_few_lights_are_all_sampled(self):
        # 14 bulbs, the sun and the sky.
        lights = bulbs(CHOSEN - 2) + SUN_AND_SKY
        for integrator in ('"whitted"', '"directlighting"'):
            with self.subTest(integrator=integrator):
                every, _ = self.render(integrator, lights, spp=4)
                some, told = self.render(integrator, lights, "--lights", "tree", spp=4)
                self.assertIsNone(told["settings"]["lights_chosen"])
                self.assertTrue((every == some).all())

    def test_the_scene_says_it_and_the_flag_has_the_last_word(self):
        lights = bulbs(20)
        for integrator in ('"whitted"', '"directlighting"'):
            asked, _ = self.render(integrator, lights, "--lights", "tree", spp=4)
            said, told = self.render(integrator + ' "string strategy" "tree"', lights, spp=4)
            self.assertEqual(told["settings"]["integrator_parameters"], {"strategy": "tree"})
            self.assertTrue((asked == said).all())
            every, _ = self.render(integrator, lights, spp=4)
            other, _ = self.render(integrator + ' "string strategy" "tree"', lights, "--lights", "all", spp=4)
            self.assertTrue((every == other).all())

    def test_what_is_much_of_the_light_is_never_left_out(self):
        # A bulb of nine tenths of all light, by itself at the camera's side. Its share of the choice is above a sixteenth
        # wherever the floor is seen, so that each point has a sample of it. What is left to chance is a tenth of the light,
        # of 60 bulbs that are all alike: a sample of these is off by its own size at most, and the 32 of a pixel's two
        # points by a sixth of that on average.
        far = 'LightSource "point" "rgb I" [%g %g %g] "point from" [0 -4 6]\n'
        small = "".join('LightSource "point" "rgb I" [0.05 0.05 0.05] "point from" [%g %g 4]\n' % (k % 8 - 3.5, k // 8 - 3.5)
                        for k in range(60))
        lights = far % (60, 60, 60) + small
        every, _ = self.render('"whitted"', lights, spp=2)
        some, _ = self.render('"whitted"', lights, "--lights", "tree", spp=2)
        relative = abs(some - every).mean() / every.mean()
        self.assertLess(float(relative), 0.1 / 6)

    def test_adding_samples_and_crops_change_no_bit(self):
        lights = ball(8, 6) + SUN_AND_SKY
        whole, _ = self.render('"whitted"', lights, "--lights", "tree", "--nthreads", "2", spp=4)
        # 48 x 48 pixels; the middle third.
        part, _ = self.render('"whitted"', lights, "--lights", "tree", "--nthreads", "1", "--cropwindow", "0.3333", "0.6666",
                              "0.3333", "0.6666", spp=4)
        self.assertTrue((part == whole[16:32, 16:32]).all())


@unittest.skipUnless(WHIT, "the program is not built")
class Flag(unittest.TestCase):
    def test_wrong_usage(self):
        for flags, message in ((("--lights", "three"), '--lights: there is no strategy "three"; did you mean "tree"?'),
                               (("--lights", "tree", "--integrator", "path"),
                                '--lights: integrator "path" has no parameter "strategy"; directlighting, whitted have')):
            done = subprocess.run([WHIT, *flags], input=SCENE % {"size": 8, "spp": 1, "integrator": '"whitted"', "lights": ""},
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(message, done.stderr)


if __name__ == "__main__":
    unittest.main()
