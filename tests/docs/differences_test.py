#!/usr/bin/env python3
"""docs/differences-from-pbrt.md: each difference it lists has a test here, which shows that whit does as the page says.

What pbrt-v3 does is not tested; the page says where it was seen.
"""
import os
import re
import subprocess
import tempfile
import unittest

import numpy

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
PAGE = ROOT + "/docs/differences-from-pbrt.md"
WHIT = os.environ.get("WHIT", ROOT + "/build/release/whit")

# The camera stands at the origin, looks along +z and sees x and y from -1 to 1.
TINY = '''Film "image" "integer xresolution" [%d] "integer yresolution" [%d]
Sampler "halton" "integer pixelsamples" [%d]
%s
WorldBegin
%s
WorldEnd
'''
ORTHO = 'Camera "orthographic"'
BEHIND = 'LookAt 0 0 0  0 0 -1  0 1 0\nCamera "orthographic"'
# Sees what lies around the middle, from 4 to 6 off it.
CORNERS = 'Camera "orthographic" "float screenwindow" [4 6 4 6]'


def scene(world, camera=ORTHO, size=8, samples=16):
    return TINY % (size, size, samples, camera, world)


class Differences(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.rendered = 0

    def run_whit(self, *arguments):
        return subprocess.run([WHIT, *arguments], capture_output=True, text=True, check=False, cwd=self.folder,
                              stdin=subprocess.DEVNULL, timeout=120)

    def save(self, text):
        with open(os.path.join(self.folder, "s.pbrt"), "w", encoding="utf-8") as f:
            f.write(text)

    def render(self, text, *flags, said=""):
        """The picture as an array [y, x, channel]; the program must say what is expected and nothing else."""
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        self.save(text)
        # A new name each time: OpenImageIO keeps files it has read in a cache.
        self.rendered += 1
        name = "%d.exr" % self.rendered
        done = self.run_whit("s.pbrt", "--quiet", "--type", "float", "--outfile", name, "--display", "none", *flags)
        self.assertEqual(done.returncode, 0, done.stderr)
        if said:
            self.assertIn(said, done.stderr)
        else:
            self.assertEqual(done.stderr, "")
        image = oiio.ImageBuf(os.path.join(self.folder, name))
        names = list(image.spec().channelnames)
        return image.get_pixels(oiio.FLOAT)[..., [names.index(c) for c in "RGB"]]

    def refused(self, text, code, message):
        self.save(text)
        done = self.run_whit("s.pbrt", "--quiet", "--outfile", "s.exr")
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "s.exr")))

    # ---- Light ----

    def test_sphere_lights_far_away(self):
        # A sphere of radius 1 and radiance D^2 at distance D: irradiance pi D^2 / D^2, times 0.5 / pi.
        for distance in (1e3, 2e3, 4e3, 6e3, 1e5, 1e6):
            rgb = self.render(scene('''
              AttributeBegin
                AreaLightSource "diffuse" "rgb L" [%r %r %r]
                Translate 0 0 %r
                Shape "sphere"
              AttributeEnd
              Material "matte" "rgb Kd" [0.5 0.5 0.5]
              Translate 0 0 1
              Shape "disk" "float radius" [10]''' % (distance**2, distance**2, distance**2, 1 - distance)))
            # The nearest point of a pixel's cone is nearer than the centre: relative 1 / D^2; and float.
            numpy.testing.assert_allclose(rgb, 0.5, rtol=1e-5)

    def glows_and_lights(self, emitter):
        """The radiance seen at an emitter ahead of the camera, and that of a wall behind the camera."""
        world = '''
          AttributeBegin
            Material "matte" "rgb Kd" [0 0 0]
            AreaLightSource "diffuse" "rgb L" [3 3 3]
            Translate 0 0 5
            %s
          AttributeEnd
          Translate 0 0 -5
          Shape "disk" "float radius" [10]''' % emitter
        return self.render(scene(world))[4, 4, 0], self.render(scene(world, BEHIND))[4, 4, 0]

    def check_the_side_that_glows_lights(self, shape):
        for ahead in ("", "ReverseOrientation"):
            for mirror in ("", "Scale -1 1 1", "Scale 1 1 -1", "Scale -1 -1 -1"):
                seen, lit = self.glows_and_lights("%s\n%s\n%s" % (ahead, mirror, shape))
                self.assertIn(seen, (0.0, 3.0))
                self.assertEqual(seen > 0, lit > 0.001, (shape, ahead, mirror, seen, lit))

    def test_quadric_lights_under_mirroring(self):
        for shape in ('Shape "disk"', 'Shape "sphere"', 'Rotate 90 1 0 0\nShape "sphere" "float zmax" [0.9]',
                      'Rotate 90 1 0 0\nShape "cylinder"'):
            self.check_the_side_that_glows_lights(shape)

    def test_mesh_lights_with_normals(self):
        quad = 'Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]'
        self.check_the_side_that_glows_lights(quad)
        self.check_the_side_that_glows_lights(quad + ' "normal N" [0 0 1 0 0 1 0 0 1 0 0 1]')
        self.check_the_side_that_glows_lights(quad + ' "normal N" [0 0 -1 0 0 -1 0 0 -1 0 0 -1]')
        self.check_the_side_that_glows_lights(quad + ' "vector S" [1 0 0 1 0 0 1 0 0 1 0 0]')

    def test_lights_of_scaled_shapes(self):
        # A light twice as large is one of twice the radius, however that is written.
        wall = '\nAttributeEnd\nMaterial "matte" "rgb Kd" [0.5 0.5 0.5]\nTranslate 0 0 7\nShape "disk" "float radius" [99]'
        for shape, size in (("disk", '"float radius" [2]'), ("sphere", '"float radius" [2]'),
                            ("cylinder", '"float radius" [2] "float zmin" [-2] "float zmax" [2]')):
            light = 'AttributeBegin\nAreaLightSource "diffuse" "rgb L" [9 9 9]\nTranslate 0 0 3\n'
            direct = self.render(scene(light + 'Shape "%s" %s' % (shape, size) + wall, CORNERS))
            scaled = self.render(scene(light + 'Scale 2 2 2\nShape "%s"' % shape + wall, CORNERS))
            self.assertGreater(float(direct.min()), 0.01)
            numpy.testing.assert_allclose(scaled, direct, rtol=1e-4)

    def test_lights_of_partial_shapes(self):
        # Two halves of a sphere shine as much as the whole.
        part = '''
          AttributeBegin
            AreaLightSource "diffuse" "rgb L" [9 9 9]
            Translate 0 0 3
            Shape "sphere" "float radius" [0.1] %s
          AttributeEnd
          Material "matte" "rgb Kd" [0.5 0.5 0.5]
          Translate 0 0 4
          Shape "disk" "float radius" [99]'''
        whole, front, back = (float(self.render(scene(part % p, samples=256))[0].mean())
                              for p in ("", '"float zmax" [0]', '"float zmin" [0]'))
        self.assertGreater(back, 2 * front)
        self.assertAlmostEqual((front + back) / whole, 1, delta=0.02)
        # A ring of radii 2 and 3 at distance 1 from its axis: pi (9 / (9 + 1) - 4 / (4 + 1)) = 0.1 pi, times 0.5 / pi.
        ring = self.render(scene('''
          AttributeBegin
            AreaLightSource "diffuse" "rgb L" [1 1 1]
            Translate 0 0 1
            Shape "disk" "float radius" [3] "float innerradius" [2]
          AttributeEnd
          Material "matte" "rgb Kd" [0.5 0.5 0.5]
          Translate 0 0 2
          Shape "disk" "float radius" [99]''', 'Camera "orthographic" "float screenwindow" [-.01 .01 -.01 .01]', samples=1024))
        self.assertAlmostEqual(float(ring.mean()), 0.05, delta=0.001)

    def test_lights_of_scaled_spaces(self):
        # Light from everywhere has no size: pi on a wall, times 0.5 / pi. Nor has the opening of a projector.
        wall = 'Material "matte" "rgb Kd" [0.5 0.5 0.5]\nTranslate 0 0 2\nShape "disk" "float radius" [99]'
        sky = 'AttributeBegin\nScale %s\nLightSource "infinite"\nAttributeEnd\n' + wall
        for size in ("1 1 1", "2 2 2", ".1 .1 .1"):
            self.assertAlmostEqual(float(self.render(scene(sky % size, samples=256)).mean()), 0.5, delta=0.01)
        slide = 'AttributeBegin\nScale %s\nLightSource "projection" "float fov" [90]\nAttributeEnd\n' + wall
        beam = self.render(scene(slide % "1 1 1"))
        self.assertGreater(float(beam.min()), 0.01)
        numpy.testing.assert_allclose(self.render(scene(slide % "2000 2000 2000")), beam, rtol=1e-4)

    def test_tips_of_cones(self):
        # Seen and lit along +y, on the line of the cone that faces the camera, up to 0.001 below its tip. The normal
        # is (0, -2, 1) / sqrt(5), so 0.5 / pi * pi * 2 / sqrt(5). The picture is 2e-5 / 5e-4 radians wide at the tip.
        rgb = self.render(scene('''
          LightSource "distant" "point from" [0 -1 0] "point to" [0 0 0] "rgb L" [3.14159265 3.14159265 3.14159265]
          Shape "cone" "float radius" [1] "float height" [2]''', '''LookAt 0 -5 0  0 0 0  0 0 1
          Camera "orthographic" "float screenwindow" [-1e-5 1e-5 1.8 1.999]'''))
        numpy.testing.assert_allclose(rgb, 0.5 * 2 / 5**0.5, rtol=1e-3)

    def test_cones_and_paraboloids_can_be_lights(self):
        for shape in ("cone", "paraboloid", "hyperboloid"):
            seen, lit = self.glows_and_lights('ReverseOrientation\nRotate 90 1 0 0\nShape "%s"' % shape)
            self.assertEqual(seen > 0, lit > 0.001, shape)

    # ---- The same bits ----

    def test_same_bits_for_any_threads_and_crop(self):
        text = scene('''
          LightSource "point" "point from" [2 3 -4] "rgb I" [40 40 40]
          AttributeBegin
            AreaLightSource "diffuse" "rgb L" [5 5 5]
            Translate -2 2 -1
            Shape "sphere" "float radius" [0.5]
          AttributeEnd
          Translate 0 0 3
          Material "perfectglass"
          Shape "sphere" "float radius" [0.6]
          Material "plastic"
          Translate 0 0 1
          Shape "disk" "float radius" [10]''', 'PixelFilter "gaussian" "float xwidth" [2] "float ywidth" [2]\n' + ORTHO,
                     size=48, samples=4)
        whole = self.render(text, "--nthreads", "1")
        numpy.testing.assert_array_equal(self.render(text, "--nthreads", "2"), whole)
        left = self.render(text, "--cropwindow", "0", "0.5", "0", "1")
        right = self.render(text, "--cropwindow", "0.5", "1", "0", "1")
        numpy.testing.assert_array_equal(numpy.concatenate([left, right], axis=1), whole)

    # ---- Numbers ----

    def test_far_from_the_origin(self):
        def at(x, y, z):
            return scene('''
              Translate %r %r %r
              LightSource "point" "point from" [2 3 -4] "rgb I" [40 40 40]
              Translate 0 0 3
              Material "perfectglass"
              Shape "sphere" "float radius" [0.6]
              Material "plastic"
              Translate 0 0 1
              Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]
              ''' % (x, y, z), "LookAt %r %r %r  %r %r %r  0 1 0\n%s" % (x, y, z, x, y, z + 1, ORTHO),
                         size=48, samples=4)
        here = self.render(at(0.0, 0.0, 0.0))
        there = self.render(at(1e6, -2e6, 3e6))
        relmse = numpy.mean((there - here)**2 / (here**2 + (0.1 * here.mean())**2))
        self.assertLess(relmse, 1e-9)

    def test_index_1_is_invisible(self):
        sky = 'LightSource "skybox"\n'
        empty = self.render(scene(sky, size=64))
        ball = self.render(scene(sky + 'Translate 0 0 3\nMaterial "perfectglass" "float index" [1]\nShape "sphere"',
                                 size=64))
        numpy.testing.assert_allclose(ball, empty, rtol=0, atol=1e-6)

    def test_no_limit_of_sample_dimensions(self):
        # Between two mirrors at 45 degrees: one bounce every 2 units of z, 600 of them, to a wall with a lamp.
        rgb = self.render('''Integrator "whitted" "integer maxdepth" [2000]
          ''' + scene('''
          AttributeBegin
            Material "mirror" "rgb Kr" [1 1 1]
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3  4 5 6 4 6 7]
              "point P" [-9 -1 -9  9 -1 -9  9 -1 1300  -9 -1 1300   -9 1 -9  9 1 -9  9 1 1300  -9 1 1300]
          AttributeEnd
          AttributeBegin
            AreaLightSource "diffuse" "rgb L" [30 30 30]
            Translate 0 0 1195
            Shape "sphere" "float radius" [0.2]
          AttributeEnd
          Translate 0 0 1200
          Shape "disk" "float radius" [20]''',
                      'LookAt 0 0 0  0 1 1  1 0 0\nCamera "orthographic" "float screenwindow" [-.1 .1 -.1 .1]',
                      samples=4))
        self.assertGreater(float(rgb.min()), 0.01)

    def test_ribbons_with_equal_normals(self):
        rgb = self.render(scene('''
          LightSource "distant" "point from" [0 0 -1] "point to" [0 0 1]
          Translate 0 0 5
          Shape "curve" "string type" ["ribbon"] "float width" [0.8] "normal N" [0 0 -1 0 0 -1]
            "point P" [-1 0 0  -.3 0 0  .3 0 0  1 0 0]'''))
        self.assertTrue(numpy.isfinite(rgb).all())
        self.assertGreater(float(rgb[4, 4, 0]), 0.1)

    def test_hyperboloids_through_the_axis(self):
        rgb = self.render(scene('''
          LightSource "distant" "point from" [0 0 -1] "point to" [0 0 1]
          Translate 0 0 5
          Shape "hyperboloid" "point p1" [1 0 1] "point p2" [-1 0 -1]'''))
        self.assertGreater(float(rgb.max()), 0.01)

    def test_ribbons_that_turn_far(self):
        # Normals 150 degrees apart, both leaning away from the camera by 75: in the middle the ribbon faces it, 0.8 wide.
        rgb = self.render(scene('''
          AreaLightSource "diffuse" "rgb L" [1 1 1]
          Translate 0 0 5
          Shape "curve" "string type" ["ribbon"] "float width" [0.8]
            "normal N" [-.9659258 0 -.258819  .9659258 0 -.258819] "point P" [-1 0 0  -.3 0 0  .3 0 0  1 0 0]''',
                                'Camera "orthographic" "float screenwindow" [-.01 .01 -1 1]'),
                          said="a curve cannot light other surfaces")
        self.assertAlmostEqual(float(rgb[..., 0].mean()), 0.4, delta=0.02)

    def test_mirrored_motion(self):
        # A camera that hardly moves sees what one that stands still sees.
        world = '''
          LightSource "point" "point from" [-2 1 -3] "rgb I" [9 9 9]
          Translate .4 0 5
          Shape "sphere" "float radius" [0.5]'''
        still = self.render(scene(world, "Scale -1 1 1\n" + ORTHO, size=32))
        moving = self.render(scene(world, "Scale -1 1 1\nActiveTransform EndTime\nTranslate 1e-5 0 0\n"
                                          "ActiveTransform All\n" + ORTHO, size=32))
        self.assertGreater(float(still[:, :16].mean()), 10 * float(still[:, 16:].mean()))
        self.assertLess(float(abs(moving - still).mean()), 0.02 * float(still.mean()))

    def reflected_checks(self, ball, uv, scale):
        """A checkerboard behind the camera, seen in a mirror ball; filtered, with four samples a pixel."""
        return self.render(scene('''
          LightSource "distant" "point from" [0 0 1] "point to" [0 0 0]
          Texture "checks" "spectrum" "checkerboard" "float uscale" [%r] "float vscale" [%r]
          AttributeBegin
            Material "matte" "texture Kd" "checks"
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-50 -50 -3  50 -50 -3  50 50 -3  -50 50 -3]
              "float uv" [0 0  %r 0  %r %r  0 %r]
          AttributeEnd
          Material "mirror"
          Translate 0 0 5
          %s''' % (scale, scale, uv, uv, uv, uv, ball), size=32, samples=4))

    def test_footprints_of_scaled_mirrors(self):
        direct = self.reflected_checks('Shape "sphere" "float radius" [2]', 1, 100)
        self.assertGreater(float(direct.std()), 0.01)
        scaled = self.reflected_checks('Scale 4 4 4\nShape "sphere" "float radius" [0.5]', 1, 100)
        numpy.testing.assert_allclose(scaled, direct, atol=1e-3)

    def test_tiny_texture_coordinates(self):
        direct = self.reflected_checks('Shape "sphere" "float radius" [2]', 1, 100)
        tiny = self.reflected_checks('Shape "sphere" "float radius" [2]', 2**-17, 100 * 2.0**17)
        numpy.testing.assert_allclose(tiny, direct, atol=1e-3)

    def test_invalid_samples_are_counted(self):
        # A lamp whose channels add up to more than a float holds, in the middle of the picture.
        rgb = self.render(scene('''
          AreaLightSource "diffuse" "rgb L" [3e38 3e38 3e38]
          Translate 0 0 5
          ReverseOrientation
          Shape "disk" "float radius" [0.5]''', samples=1),
                          said="samples were not valid")
        self.assertTrue(numpy.isfinite(rgb).all())

    # ---- Files and commands ----

    def test_mistakes_on_the_command_line(self):
        self.save(scene('LightSource "point"'))
        done = self.run_whit("--nthread", "1", "s.pbrt")
        self.assertEqual(done.returncode, 2)
        self.assertIn("did you mean --nthreads?", done.stderr)
        done = self.run_whit("nowhere.pbrt")
        self.assertEqual(done.returncode, 4)
        self.assertIn("nowhere.pbrt", done.stderr)
        done = self.run_whit("s.pbrt", "--outfile", "nowhere/s.exr")
        self.assertEqual(done.returncode, 4)
        self.assertIn("nowhere", done.stderr)

    def test_malformed_numbers_are_errors(self):
        self.refused(scene('LightSource "point" "rgb I" [1.5x 1 1]'), 3, "s.pbrt:5:30: error")

    def test_every_mistake_is_reported(self):
        self.save(scene('Material "matte" "rgb kd" [1 1 1]\nShape "sphere" "float radius" [-1]\nShape "spere"'))
        said = self.run_whit("check", "s.pbrt").stderr
        for expected in ('s.pbrt:5:18: warning: matte has no parameter "kd"', 'did you mean "Kd"?',
                         "s.pbrt:6:32: error", 's.pbrt:7:7: warning: unknown shape "spere"', 'did you mean "sphere"?'):
            self.assertIn(expected, said)

    def test_parameters_of_the_wrong_type(self):
        self.save(scene('LightSource "point"', 'Camera "perspective" "integer fov" [20]'))
        done = self.run_whit("s.pbrt", "--quiet", "--outfile", "s.exr")
        self.assertEqual(done.returncode, 0)
        self.assertIn('parameter "fov" of perspective is of type float, not integer', done.stderr)

    def test_missing_files(self):
        ball = ' LightSource "point" Translate 0 0 5 Shape "sphere"'
        picture = 'Texture "t" "spectrum" "imagemap" "string filename" "nowhere.png"'
        self.refused(scene(picture + ' Material "matte" "texture Kd" "t"' + ball), 4, "cannot open nowhere.png")
        self.refused(scene('LightSource "infinite" "string mapname" "nowhere.exr"'), 4, "cannot open nowhere.exr")
        self.refused(scene('Material "metal" "spectrum eta" "nowhere.spd"' + ball), 4, "cannot open nowhere.spd")
        self.render(scene(picture + ball), said="nothing that is seen depends on it")

    def test_degenerate_triangles(self):
        self.render(scene('''
          LightSource "point"
          Translate 0 0 5
          Shape "trianglemesh" "integer indices" [0 1 2 0 1 1] "point P" [-1 -1 0  1 -1 0  1 1 0]'''),
                    said="1 degenerate triangle (no area, or repeated)")

    def test_other_integrators(self):
        self.render('Integrator "bdpt"\n' + scene('LightSource "point"'), said="the picture is made with path")
        self.render('Integrator "nosuch"\n' + scene('LightSource "point"'), said="the picture is made with whitted")
        self.render(scene('LightSource "point"'))

    def test_subsurface(self):
        body = 'LightSource "point" Material "subsurface" Translate 0 0 5 Shape "sphere"'
        self.render('Integrator "path"\n' + scene(body), said="scattering below surfaces is not simulated")
        self.render(scene(body))

    def test_footprints_are_the_scenes(self):
        # A checkerboard of a square per pixel, of radiance 1 and 0, seen by samples that average it over [x - w, x + w],
        # w = 1/sqrt(samples) of a pixel. A sample nearer to an edge than w loses (w - x) / 2w: a bright pixel's mean is
        # 1 - 2 w/4. The scene asks for 16 samples, so w = 1/4. Losses have a variance of at most 2/12 (w = 1): over 2048
        # pixels five deviations are less than 0.046 for one sample, and fewer for more.
        text = scene('''
          LightSource "distant" "rgb L" [3.14159265 3.14159265 3.14159265]
          Texture "stripes" "spectrum" "checkerboard" "rgb tex1" [1 1 1] "rgb tex2" [0 0 0]
            "float uscale" [128] "float vscale" [0.5]
          Material "matte" "texture Kd" "stripes"
          Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-2 -2 1  2 -2 1  2 2 1  -2 2 1]
            "float uv" [0 0  1 0  1 1  0 1]''', size=64)
        for flags, w in (((), 1 / 4), (("--spp", "1"), 1 / 4), (("--spp", "4"), 1 / 4), (("--spp", "64"), 1 / 4),
                         (("--footprint-spp", "1"), 1), (("--footprint-spp", "64"), 1 / 8),
                         (("--spp", "4", "--footprint-spp", "64"), 1 / 8)):
            with self.subTest(flags=flags):
                columns = self.render(text, *flags)[..., 0].mean(axis=0)
                bright = max(columns[0::2].mean(), columns[1::2].mean())
                dark = min(columns[0::2].mean(), columns[1::2].mean())
                self.assertAlmostEqual(float(bright), 1 - w / 2, delta=0.046)
                self.assertAlmostEqual(float(dark), w / 2, delta=0.046)

    def test_any_number_of_samples(self):
        for sampler, flags, said in (
                ("sobol", (), "100 samples per pixel, "), ("02sequence", (), "100 samples per pixel, "),
                ("sobol", ("--spp", "7"), "7 samples per pixel, "),
                ("maxmindist", (), "128 samples per pixel (maxmindist takes powers of two; 100 were asked for), "),
                ("maxmindist", ("--spp", "7"), "8 samples per pixel (maxmindist takes powers of two; 7 were asked for), "),
                ("maxmindist", ("--spp", "8"), "8 samples per pixel, "),
                ("stratified", ("--spp", "7"), "8 samples per pixel (stratified takes a grid of 2 x 4; 7 were asked for), ")):
            with self.subTest(sampler=sampler, flags=flags):
                text = scene('LightSource "point"', samples=100).replace("halton", sampler)
                if sampler == "stratified":
                    text = text.replace('"integer pixelsamples" [100]', "")
                self.save(text)
                done = self.run_whit("s.pbrt", "--outfile", "x.exr", "--display", "none", *flags)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(said, done.stderr)

    def test_other_samplers(self):
        self.render(scene('LightSource "point"').replace("halton", "nosuchsampler"), said="halton is used instead")

    def test_two_crop_windows(self):
        text = scene('LightSource "point"').replace('Film "image"', 'Film "image" "float cropwindow" [0 0.5 0 1]')
        self.assertEqual(self.render(text).shape, (8, 4, 3))
        self.assertEqual(self.render(text, "--cropwindow", "0", "1", "0", "0.25").shape, (2, 8, 3))

    def test_files_of_objects_never_placed(self):
        with open(os.path.join(self.folder, "tree.pbrt"), "w", encoding="utf-8") as f:
            f.write('LightSource "distant" "rgb L" [2 2 2]\nNonsense\n')
        text = scene('''
          ObjectBegin "tree"
            Include "tree.pbrt"
          ObjectEnd
          LightSource "distant" "rgb L" [1 1 1]
          Translate 0 0 5
          Shape "disk" "float radius" [9]''')
        # Matte of Kd 0.5 facing a light of irradiance 1: 0.5 / pi. The file's light would make it three times that.
        numpy.testing.assert_allclose(self.render(text), 0.5 / numpy.pi, rtol=1e-5)
        loud = self.run_whit("s.pbrt", "--outfile", "loud.exr", "--display", "none")
        self.assertEqual(loud.returncode, 0, loud.stderr)
        self.assertIn("1 file of objects that are never placed was not read (whit explain lists it).", loud.stderr)
        checked = self.run_whit("check", "s.pbrt")
        self.assertEqual(checked.returncode, 1)
        self.assertIn('tree.pbrt:2:1: error: unknown directive "Nonsense"', checked.stderr)

    def test_bump_maps_on_hair(self):
        hair = '''
          LightSource "point" "point from" [-2 1 -3] "rgb I" [9 9 9]
          Texture "bumps" "float" "wrinkled"
          Material "hair" %s
          Translate 0 0 5
          Shape "curve" "float width" [0.8] "point P" [-1 0 0  -.3 0 0  .3 0 0  1 0 0]'''
        smooth, bumpy = self.render(scene(hair % "")), self.render(scene(hair % '"texture bumpmap" "bumps"'))
        self.assertGreater(float(abs(bumpy - smooth).max()), 0.01 * float(smooth.max()))

    def test_the_name_of_the_picture(self):
        self.save(scene('LightSource "point"'))
        self.assertEqual(self.run_whit("s.pbrt", "--quiet").returncode, 0)
        self.assertEqual(sorted(os.listdir(self.folder)), ["s.exr", "s.pbrt", "s.png"])

    def test_ptex_is_refused(self):
        text = ('WorldBegin\nTexture "t" "spectrum" "ptex" "string filename" ["s.pbrt"]\n'
                'Material "matte" "texture Kd" "t" Shape "sphere"\nWorldEnd\n')
        with open(os.path.join(self.folder, "s.pbrt"), "w", encoding="utf-8") as f:
            f.write(text)
        done = self.run_whit("s.pbrt", "--quiet")
        self.assertEqual(done.returncode, 3)
        self.assertIn('s.pbrt:2:24: error: unknown spectrum texture "ptex"', done.stderr)
        self.assertIn("Ptex library", done.stderr)

    def test_pictures_of_other_formats(self):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        for name in ("map.jpg", "map.tif", "map.hdr"):
            image = oiio.ImageBuf(oiio.ImageSpec(8, 8, 3, oiio.FLOAT))
            oiio.ImageBufAlgo.fill(image, (0.5, 0.5, 0.5))
            self.assertTrue(image.write(os.path.join(self.folder, name)), name)
            rgb = self.render(scene('''
              LightSource "distant" "point from" [0 0 -1] "point to" [0 0 0] "rgb L" [3.14159265 3.14159265 3.14159265]
              Texture "map" "spectrum" "imagemap" "string filename" ["%s"]
              Material "matte" "texture Kd" ["map"]
              Translate 0 0 5
              Shape "disk" "float radius" [10]''' % name))
            # A jpg is sRGB by what its header says, a tif of floats and an hdr are linear: 0.5 decodes to 0.21404. 8 bits
            # hold 0.5 as 128 / 255, where sRGB has a slope of 1, and a .hdr mantissa has 8 bits too.
            expected = 0.21404 if name == "map.jpg" else 0.5
            numpy.testing.assert_allclose(rgb, expected, atol=0.5 / 255 + 1e-3)

    def test_what_is_not_there_yet(self):
        for statement, answer in (('Material "nosuch"', "matte is used instead"),
                                  ('LightSource "nosuch"', "the light is left out"),
                                  ('Shape "nosuch"', "the shape is left out"),
                                  ('MakeNamedMedium "m" "string type" ["homogeneous"] MediumInterface "m" ""',
                                   "the picture is made without")):
            self.render(scene(statement), said=answer)
        self.refused(scene('Texture "t" "float" "nosuch" Material "matte" "texture sigma" "t" Shape "sphere"'), 3,
                     'error: unknown float texture "nosuch"')
        self.refused(scene("", 'Camera "nosuch"'), 3, 'error: unknown camera "nosuch"')

    # ---- The page ----

    def test_every_row_names_a_test_or_scene_that_exists(self):
        with open(PAGE, encoding="utf-8") as f:
            rows = [line for line in f if line.startswith("| ")]
        named = set()
        for row in rows:
            shown = row.strip().strip("|").split("|")[-1]
            if shown.strip() == "shown by" or set(shown.strip()) == {"-"}:
                continue
            names = re.findall(r"`([\w./-]+)`", shown)
            self.assertTrue(names, row)
            for name in names:
                if name.startswith("test_"):
                    self.assertTrue(hasattr(self, name), row)
                    named.add(name)
                else:
                    self.assertTrue(os.path.exists(os.path.join(ROOT, name)), row)
        own = {n for n in dir(self) if n.startswith("test_")} - {"test_every_row_names_a_test_or_scene_that_exists"}
        self.assertEqual(named, own, "every test stands for a row, and every row is tested")


if __name__ == "__main__":
    unittest.main()
