#!/usr/bin/env python3
"""What pictures hold beside their colours: values that can be worked out by hand, parts that add up to the picture,
names under their hashes, and the same bits however the picture is made.
"""
import json
import os
import re
import struct
import subprocess
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
WHIT = os.environ.get("WHIT")

HEAD = """
Film "image" "integer xresolution" [%(width)d] "integer yresolution" [%(height)d] %(film)s
PixelFilter "%(filter)s"
Sampler "%(sampler)s" "integer pixelsamples" [%(spp)d]
Integrator "%(integrator)s" %(depth)s
"""

# A square of matte, 2 units wide, 4 units before a camera that sees 2 * 4 * tan(45 degrees) = 8 units of its plane
# along the shorter side. Moved to (100, 20, 3), so that the world is not the camera's space.
SQUARE = HEAD + """
LookAt 100 20 -1  100 20 3  0 1 0
Camera "perspective" "float fov" [90]
WorldBegin
  LightSource "distant" "point from" [0 0 -1] "point to" [0 0 0] "rgb L" [3 3 3]
  Translate 100 20 3
  MakeNamedMaterial "hello" "string type" "matte" "rgb Kd" [0.2 0.4 0.8]
  NamedMaterial "hello"
  Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "float uv" [0 0  1 0  1 1  0 1]
    "point P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]
WorldEnd
"""

# All ways that light can go: a mirror, glass, a glossy and a matte surface, an emitter that is seen, a point, a sky.
ROOM = HEAD + """
LookAt 0 2 -7  0 1 0  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
  LightSource "infinite" "rgb L" [0.2 0.3 0.5] "string lightgroup" ["sky"]
  LightSource "skybox" "rgb L" [0.1 0.1 0.1] "string lightgroup" ["sky \\"2\\""]
  LightSource "point" "rgb I" [9 9 9] "point from" [-2 4 -3] %(point)s
  AttributeBegin
    AreaLightSource "diffuse" "rgb L" [8 6 4] "string lightgroup" ["lamp"]
    Translate 0 3 0
    Rotate 90 1 0 0
    Shape "disk" "float radius" [0.7]
  AttributeEnd
  Material "matte" "rgb Kd" [0.6 0.5 0.4]
  Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "point P" [-9 0 -9  -9 0 9  9 0 9  9 0 -9]
  AttributeBegin
    Translate -1.6 0.8 0
    Material "mirror"
    Shape "sphere" "float radius" [0.8]
  AttributeEnd
  AttributeBegin
    Translate 0 0.8 0
    Material "glass"
    Shape "sphere" "float radius" [0.8]
  AttributeEnd
  AttributeBegin
    Translate 1.6 0.8 0
    Material "plastic" "rgb Ks" [0.5 0.5 0.5] "float roughness" [0.1]
    Shape "sphere" "float radius" [0.8]
  AttributeEnd
WorldEnd
"""

PARTS = ["emission", "direct", "reflection", "refraction", "indirect"]


def murmur(text):
    """MurmurHash3_x86_32 with seed 0, from Appleby's description."""
    data, h, most = text.encode(), 0, 0xffffffff

    def rotate(x, r):
        return (x << r | x >> 32 - r) & most

    def mix(k):
        return rotate(k * 0xcc9e2d51 & most, 15) * 0x1b873593 & most

    whole = len(data) // 4 * 4
    for i in range(0, whole, 4):
        h = (rotate(h ^ mix(struct.unpack_from("<I", data, i)[0]), 13) * 5 + 0xe6546b64) & most
    h ^= mix(int.from_bytes(data[whole:], "little")) ^ len(data)
    h = (h ^ h >> 16) * 0x85ebca6b & most
    h = (h ^ h >> 13) * 0xc2b2ae35 & most
    return h ^ h >> 16


class Picture:
    """An OpenEXR file: its channels by name, and its header."""

    def __init__(self, path):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        image = oiio.ImageBuf(path)
        spec = image.spec()
        pixels = image.get_pixels(oiio.FLOAT)
        self.channels = {name: pixels[:, :, i] for i, name in enumerate(spec.channelnames)}
        self.header = {a.name: a.value for a in spec.extra_attribs}
        native = image.nativespec()
        self.formats = dict(zip(native.channelnames, native.channelformats or [native.format] * native.nchannels))
        self.origin = (spec.x, spec.y)

    def layer(self, name, channels="RGB"):
        import numpy  # pylint: disable=import-outside-toplevel
        return numpy.stack([self.channels["%s.%s" % (name, c)] for c in channels], axis=2).astype("float64")

    def rgb(self):
        import numpy  # pylint: disable=import-outside-toplevel
        return numpy.stack([self.channels[c] for c in "RGB"], axis=2).astype("float64")


class AovCase(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.count = 0

    @staticmethod
    def scene(text, **values):
        given = {"width": 40, "height": 32, "film": "", "filter": "box", "sampler": "halton", "spp": 4,
                 "integrator": "whitted", "point": '"string lightgroup" ["lamp"]'}
        given["depth"] = '"integer maxdepth" [5]' if values.get("integrator") != "ambientocclusion" else ""
        return text % {**given, **values}

    def run_whit(self, text, *flags, outfile=None):
        self.count += 1
        path = os.path.join(self.folder, outfile or "%d.exr" % self.count)
        with open(os.path.join(self.folder, "scene.pbrt"), "w", encoding="utf-8") as f:
            f.write(text)
        done = subprocess.run([WHIT, "scene.pbrt", "--outfile", path, "--quiet", "--display", "none", *flags],
                              capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, cwd=self.folder)
        return path, done

    def render(self, text, aovs, *flags):
        path, done = self.run_whit(text, *flags, "--type", "float", *(["--aov", aovs] if aovs else []))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return Picture(path)

    def assert_near(self, a, b, most, what=""):
        import numpy  # pylint: disable=import-outside-toplevel
        off = float(numpy.abs(numpy.asarray(a, "float64") - b).max())
        self.assertLessEqual(off, most, what)


@unittest.skipUnless(WHIT, "the program is not built")
class Values(AovCase):
    def square(self, aovs, **values):
        picture = self.render(self.scene(SQUARE, **{"integrator": "path", **values}), aovs)
        return picture

    # The square's edges are at 1/4 of half the height of 32 pixels: 4 pixels from the middle of 40 x 32. Pixels 17 to
    # 22 and 13 to 18 see nothing else.
    INSIDE = (slice(13, 19), slice(17, 23))

    def test_positions_and_depth(self):
        import numpy  # pylint: disable=import-outside-toplevel
        for integrator in ("path", "whitted", "directlighting", "ambientocclusion"):
            picture = self.square("P,Z,Ng,N", integrator=integrator)
            z = picture.channels["Z"]
            # Depth is along the axis: 4 everywhere on the plane, to the roundings of floats of size 4.
            self.assert_near(z[self.INSIDE], 4, 4e-6, integrator)
            self.assertTrue(numpy.isinf(z[0, 0]))
            p = picture.layer("P", "XYZ")
            self.assert_near(p[self.INSIDE][..., 2], 3, 4e-6)
            # A pixel is 8 / 32 = 0.25 units wide there, and its sample somewhere in it. x grows to the right, y up.
            columns, rows = numpy.arange(17, 23), numpy.arange(13, 19)
            self.assert_near(p[self.INSIDE][..., 0], 100 + (columns + 0.5 - 20)[None, :] * 0.25, 0.126)
            self.assert_near(p[self.INSIDE][..., 1], 20 - (rows + 0.5 - 16)[:, None] * 0.25, 0.126)
            self.assert_near(p[0, 0], 0, 0)
            for normal in ("N", "Ng"):
                # Of unit length, and along z; by pbrt's rule the side that (p1 - p0) x (p2 - p0) is on.
                self.assert_near(picture.layer(normal, "XYZ")[self.INSIDE], [0, 0, 1], 1e-6, normal)
                self.assert_near(picture.layer(normal, "XYZ")[0, 0], 0, 0)

    def test_surface_parameters(self):
        # From 0 to 1 across the two units of the square, at the point of the same sample.
        picture = self.square("uv,P")
        at = (picture.layer("P", "XYZ")[..., :2] - [99, 19]) / 2
        self.assert_near(picture.layer("uv", "UV")[self.INSIDE], at[self.INSIDE], 1e-5)
        self.assert_near(picture.layer("uv", "UV")[0, 0], 0, 0)

    def test_motion_is_that_of_shapes_and_of_the_camera(self):
        # Half a unit to the right while the shutter is open, of 0.25 units a pixel.
        moved = self.scene(SQUARE, integrator="path").replace(
            "Shape", "ActiveTransform EndTime Translate 0.5 0 0 ActiveTransform All Shape")
        self.assert_near(self.render(moved, "motion").layer("motion", "XY")[14:18, 19:22], [2, 0], 1e-4)
        # Where the shutter closes at half the time it is half of that.
        half = moved.replace('"float fov" [90]', '"float fov" [90] "float shutterclose" [0.5]')
        self.assert_near(self.render(half, "motion").layer("motion", "XY")[14:18, 19:22], [1, 0], 1e-4)
        # The world sinks by 0.25 units before the camera, which is a pixel down.
        lifted = self.scene(SQUARE).replace(
            "Camera", "ActiveTransform EndTime Translate 0 -0.25 0 ActiveTransform All Camera")
        self.assert_near(self.render(lifted, "motion").layer("motion", "XY")[14:18, 18:22], [0, 1], 1e-4)
        self.assert_near(self.square("motion").layer("motion", "XY"), 0, 0)

    def test_nearest_is_the_sample_nearest_to_the_middle(self):
        import numpy  # pylint: disable=import-outside-toplevel
        # With many samples one of them is near the middle: 256 have one within 1/16 of a pixel, or nearly, of 1/4 unit.
        p = self.square("P", spp=256).layer("P", "XYZ")
        columns = numpy.arange(17, 23)
        self.assert_near(p[self.INSIDE][..., 0], 100 + (columns + 0.5 - 20)[None, :] * 0.25, 0.25 / 12)

    def test_albedo_of_matte_is_its_reflectance(self):
        for filter_name in ("box", "gaussian", "mitchell"):
            albedo = self.square("albedo", filter=filter_name).layer("Albedo")
            self.assert_near(albedo[self.INSIDE], [0.2, 0.4, 0.8], 2e-6, filter_name)
            # Of those samples alone that meet the square: its edge is not darker.
            self.assert_near(albedo[16, 16], [0.2, 0.4, 0.8], 2e-6, filter_name)
            self.assert_near(albedo[0, 0], 0, 0)

    def test_albedo_of_mirrors_and_glass_is_all_of_the_light(self):
        # A mirror of reflectance 0.9, as by default, and glass without loss.
        picture = self.render(self.scene(ROOM, integrator="path", width=80, height=60), "albedo")
        albedo = picture.layer("Albedo")
        # The middles of the spheres are at x = -1.6 and 0, 7 units away and 0.2 below the line of sight's middle.
        self.assert_near(albedo[32, 40], 1, 1e-5)
        self.assert_near(albedo[32, 21], 0.9, 1e-5)

    def test_camera_of_the_header(self):
        import numpy  # pylint: disable=import-outside-toplevel
        picture = self.square("Z")
        to_camera = numpy.array(picture.header["worldToCamera"], "float64").reshape(4, 4)
        to_ndc = numpy.array(picture.header["worldToNDC"], "float64").reshape(4, 4)
        # OpenEXR multiplies row vectors. The square's corner (101, 21, 3) is at (1, 1, 4) of the camera's space.
        self.assert_near(numpy.array([101, 21, 3, 1]) @ to_camera, [1, 1, 4, 1], 1e-4)
        ndc = numpy.array([101, 21, 3, 1]) @ to_ndc
        # On the screen 1/4, of -1.25 to 1.25 across, and of 1 to -1 down.
        self.assert_near(ndc[:2] / ndc[3], [0.5 + 0.25 / 2.5, 0.5 - 0.25 / 2], 1e-5)

    def test_camera_with_parallel_rays(self):
        import numpy  # pylint: disable=import-outside-toplevel
        text = self.scene(SQUARE).replace('"perspective" "float fov" [90]',
                                           '"orthographic" "float screenwindow" [-2 3 -1 3]')
        to_ndc = numpy.array(self.render(text, "Z").header["worldToNDC"], "float64").reshape(4, 4)
        ndc = numpy.array([101, 21, 3, 1]) @ to_ndc
        self.assert_near(ndc[:2] / ndc[3], [3 / 5, 2 / 4], 1e-5)

    def test_types(self):
        path, done = self.run_whit(self.scene(SQUARE), "--aov", "albedo,N,Z,material,direct,variance")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        formats = {name: str(f) for name, f in Picture(path).formats.items()}
        for name in ("R", "Albedo.R", "direct.G"):
            self.assertEqual(formats[name], "half", name)
        for name in ("N.X", "Z", "material.id", "CryptoMaterial00.r", "variance.B"):
            self.assertEqual(formats[name], "float", name)


@unittest.skipUnless(WHIT, "the program is not built")
class Parts(AovCase):
    def test_parts_add_up_to_the_picture(self):
        for integrator in ("whitted", "directlighting", "path"):
            for filter_name in ("box", "gaussian"):
                picture = self.render(self.scene(ROOM, integrator=integrator, filter=filter_name), ",".join(PARTS))
                total = sum(picture.layer(part) for part in PARTS)
                # Floats of size 10 at most, added in another order.
                self.assert_near(total, picture.rgb(), 2e-5, integrator)
                for part in PARTS:
                    wanted = part != "indirect" or integrator == "path"
                    self.assertEqual(bool(picture.layer(part).any()), wanted, (integrator, part))

    def test_where_each_part_is(self):
        picture = self.render(self.scene(ROOM, integrator="path", width=80, height=60), ",".join(PARTS))
        # The mirror's middle, the glass's, and the sky above: see albedo.
        self.assert_near(picture.layer("reflection")[32, 21], picture.rgb()[32, 21], 1e-6)
        glass = picture.layer("refraction") + picture.layer("reflection")
        self.assert_near(glass[32, 40], picture.rgb()[32, 40], 1e-6)
        self.assert_near(picture.layer("emission")[0, 0], picture.rgb()[0, 0], 1e-6)
        # Glass lets through far more than it reflects: 4 % at each side of its middle.
        self.assertGreater(picture.layer("refraction")[32, 40].sum(), picture.layer("reflection")[32, 40].sum())

    def test_direct_light_is_the_same_by_all_integrators(self):
        # The mean over the floor, to which samples of lobes and of lights both contribute for path and directlighting.
        means = []
        for integrator in ("whitted", "directlighting", "path"):
            picture = self.render(self.scene(ROOM, integrator=integrator, spp=64), "direct")
            means.append(picture.layer("direct")[26:].mean())
        for mean in means[1:]:
            self.assertAlmostEqual(mean / means[0], 1, delta=0.02)

    def test_groups_add_up_to_the_picture(self):
        for integrator in ("whitted", "directlighting", "path"):
            picture = self.render(self.scene(ROOM, integrator=integrator), "lightgroups")
            groups = {re.match(r"lightgroup\.(.*)\.[RGB]$", c).group(1) for c in picture.channels if "." in c}
            self.assertEqual(groups, {"sky", 'sky "2"', "lamp"})
            total = sum(picture.layer("lightgroup." + g) for g in groups)
            self.assert_near(total, picture.rgb(), 2e-5, integrator)

    def test_what_is_in_no_group_is_in_no_layer(self):
        scene = self.scene(ROOM, integrator="whitted", point="", spp=1)
        grouped = self.render(scene, "lightgroups")
        alone = self.render(re.sub(r'LightSource "(infinite|skybox)".*|AreaLightSource.*', "", scene), None)
        total = sum(grouped.layer("lightgroup." + g) for g in ("sky", 'sky "2"', "lamp"))
        self.assert_near(total + alone.rgb(), grouped.rgb(), 2e-5)

    def test_film_scale_is_that_of_the_parts_too(self):
        picture = self.render(self.scene(ROOM, film='"float scale" [3]'), ",".join(PARTS))
        self.assert_near(sum(picture.layer(part) for part in PARTS), picture.rgb(), 6e-5)


@unittest.skipUnless(WHIT, "the program is not built")
class Statistics(AovCase):
    def test_variance_is_that_of_pictures_with_other_seeds(self):
        import numpy  # pylint: disable=import-outside-toplevel
        scene = self.scene(ROOM, integrator="path", sampler="random", spp=8, width=20, height=16)
        runs = [self.render(scene, "variance,samples", "--seed", str(seed)) for seed in range(60)]
        empirical = numpy.var([r.rgb() for r in runs], axis=0, ddof=1)
        claimed = numpy.mean([r.layer("variance") for r in runs], axis=0)
        # Both estimate the same; over 320 pixels the means agree to some per cent (60 runs: sqrt(2 / 59) of each
        # pixel's, and what is bright weighs most).
        self.assertAlmostEqual(float(numpy.median(claimed / empirical)), 1, delta=0.1)
        self.assertAlmostEqual(float(claimed.mean() / empirical.mean()), 1, delta=0.2)
        self.assert_near(runs[0].channels["samples"], 8, 0)

    def test_samples_that_are_no_numbers_are_in_nothing(self):
        # A sky of negative luminance: no sample that sees it is valid.
        scene = self.scene(SQUARE).replace("WorldBegin", 'WorldBegin LightSource "infinite" "rgb L" [-90 1 1]')
        path, done = self.run_whit(scene, "--type", "float", "--aov", "samples,emission,direct,albedo,P,material")
        self.assertIn("samples were not valid", done.stderr)
        picture = Picture(path)
        for name, channel in picture.channels.items():
            self.assert_near(channel[:8], -1 if name == "material.id" else 0, 0, name)

    def test_variance_of_one_sample_is_not_known(self):
        import numpy  # pylint: disable=import-outside-toplevel
        picture = self.render(self.scene(SQUARE, spp=1), "variance,samples")
        self.assertTrue(numpy.isinf(picture.layer("variance")).all())
        self.assert_near(picture.channels["samples"], 1, 0)


@unittest.skipUnless(WHIT, "the program is not built")
class Mattes(AovCase):
    def test_hashes(self):
        # Known values of MurmurHash3_x86_32 with seed 0.
        self.assertEqual(murmur("hello"), 0x248bfa47)
        self.assertEqual(murmur("hello, world"), 0x149bbb7f)
        self.assertEqual(murmur("The quick brown fox jumps over the lazy dog"), 0x2e4ff723)

    @staticmethod
    def manifest(picture, layer):
        key = "cryptomatte/%07x/" % (murmur(layer) >> 4)
        assert picture.header[key + "name"] == layer
        assert picture.header[key + "hash"] == "MurmurHash3_32"
        assert picture.header[key + "conversion"] == "uint32_to_float32"
        return json.loads(picture.header[key + "manifest"])

    @staticmethod
    def coverage(picture, layer, identifier):
        """The matte of one thing, as compositors make it, and the sum of all."""
        import numpy  # pylint: disable=import-outside-toplevel
        matte, total = 0, 0
        for rank in range(3):
            r, g, b, a = (numpy.ascontiguousarray(picture.channels["%s%02d.%s" % (layer, rank, c)]) for c in "rgba")
            for ids, weights in ((r, g), (b, a)):
                matte = matte + weights * (ids.view("uint32") == identifier)
                total = total + weights
        return matte, total

    def test_names_and_coverage(self):
        for filter_name in ("box", "gaussian"):
            scene = self.scene(SQUARE, filter=filter_name, spp=16)
            picture = self.render(scene, "material,shape,emission,direct")
            self.assertEqual(self.manifest(picture, "CryptoMaterial"), {"hello": "%08x" % 0x248bfa47})
            matte, total = self.coverage(picture, "CryptoMaterial", 0x248bfa47)
            self.assert_near(matte, total, 0)
            # A gaussian reaches 2 pixels.
            self.assert_near(matte[14:18, 18:22], 1, 1e-6)
            self.assert_near(matte[0, 0], 0, 0)
            # Where nothing shines but what the square reflects, that is its colour times its coverage: 3 * 0.2 / pi.
            self.assert_near(matte * (3 * 0.2 / 3.14159265), picture.channels["direct.R"], 1e-6)
            line = scene.split("\n").index([x for x in scene.split("\n") if "Shape" in x][0]) + 1
            shape = "scene.pbrt:%d" % line
            self.assertEqual(self.manifest(picture, "CryptoShape"), {shape: "%08x" % murmur(shape)})

    def test_names_do_not_depend_on_where_a_scene_is_rendered_from(self):
        here = self.render(self.scene(SQUARE), "material,shape")
        scene, picture = os.path.join(self.folder, "scene.pbrt"), os.path.join(self.folder, "elsewhere.exr")
        for path, folder in ((scene, "/"), (os.path.relpath(scene, os.path.dirname(self.folder)), os.path.dirname(self.folder))):
            subprocess.run([WHIT, path, "--outfile", picture, "--aov", "material,shape", "--display", "none", "--quiet",
                            "--type", "float"], cwd=folder, check=True)
            for matte in ("CryptoShape", "CryptoMaterial"):
                self.assertEqual(self.manifest(Picture(picture), matte), self.manifest(here, matte))

    def test_numbers_and_their_table(self):
        import numpy  # pylint: disable=import-outside-toplevel
        picture = self.render(self.scene(ROOM, width=80, height=60), "material,shape")
        materials = json.loads(picture.header["whit:materials"])
        shapes = json.loads(picture.header["whit:shapes"])
        ids = picture.channels["material.id"]
        self.assertEqual(ids[0, 0], -1)
        self.assertTrue(materials["%d" % ids[32, 21]]["name"].startswith("mirror@scene.pbrt:"))
        self.assertTrue(materials["%d" % ids[32, 40]]["name"].startswith("glass@scene.pbrt:"))
        self.assertRegex(shapes["%d" % picture.channels["shape.id"][32, 40]]["where"], r"^scene\.pbrt:\d+:\d+$")
        self.assertEqual(len(shapes), 5)
        # Every number of the picture is in its table.
        self.assertLessEqual({"%d" % i for i in numpy.unique(ids) if i >= 0}, set(materials))
        # All ranks together cover what is not sky.
        _, total = self.coverage(picture, "CryptoShape", 0)
        self.assert_near(total[30:, :], 1, 1e-5)

    def test_shapes_of_one_line_have_names_of_their_own(self):
        scene = self.scene(SQUARE).replace('"point P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]',
                                           '"point P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] '
                                           'Translate 3 0 0 Shape "disk" Translate -6 0 0 Shape "disk"')
        picture = self.render(scene, "shape")
        # The first of a line is called after it alone.
        names = [re.sub(r":\d+:\d+$", ":LINE:COLUMN", n) for n in sorted(self.manifest(picture, "CryptoShape"))]
        self.assertEqual(names, ["scene.pbrt:14", "scene.pbrt:15", "scene.pbrt:LINE:COLUMN"])


@unittest.skipUnless(WHIT, "the program is not built")
class Promises(AovCase):
    ALL = "albedo,N,Ng,P,Z,uv,motion,material,shape,lightgroups,variance,samples," + ",".join(PARTS)

    def assert_same(self, a, b, what):
        self.assertEqual(sorted(a.channels), sorted(b.channels))
        for name, channel in a.channels.items():
            same = (channel.copy().view("uint32") == b.channels[name].copy().view("uint32")).all()
            self.assertTrue(same, "%s: %s differs" % (what, name))

    def test_colours_have_the_same_bits_with_and_without(self):
        for integrator in ("whitted", "directlighting", "path", "ambientocclusion"):
            scene = self.scene(ROOM, integrator=integrator)
            plain, full = self.render(scene, None), self.render(scene, self.ALL)
            self.assertEqual(sorted(plain.channels), ["B", "G", "R"])
            full.channels = {c: full.channels[c] for c in "RGB"}
            self.assert_same(plain, full, integrator)

    def test_threads_and_crops(self):
        import numpy  # pylint: disable=import-outside-toplevel
        for filter_name in ("box", "gaussian"):
            scene = self.scene(ROOM, integrator="path", filter=filter_name, width=50, height=40)
            whole = self.render(scene, self.ALL)
            self.assert_same(self.render(scene, self.ALL, "--nthreads", "1"), whole, "one thread")
            crop = self.render(scene, self.ALL, "--cropwindow", "0.5", "0.9", "0.25", "0.65")
            x, y = crop.origin
            height, width = crop.channels["Z"].shape
            self.assertEqual((x, y, width, height), (25, 10, 20, 16))
            cut = Picture.__new__(Picture)
            cut.channels = {n: numpy.ascontiguousarray(c[y:y + height, x:x + width]) for n, c in whole.channels.items()}
            self.assert_same(crop, cut, "crop with " + filter_name)

    def test_a_room_that_no_light_leaves_has_no_invalid_values(self):
        import numpy  # pylint: disable=import-outside-toplevel
        picture = self.render(self.scene(ROOM, integrator="path"), self.ALL)
        for name, channel in picture.channels.items():
            if name != "Z" and not name.startswith("Crypto"):
                self.assertTrue(numpy.isfinite(channel).all(), name)


@unittest.skipUnless(WHIT, "the program is not built")
class Asking(AovCase):
    def test_the_film_can_ask(self):
        scene = self.scene(SQUARE, film='"string aovs" ["Z" "N"]')
        names = ["B", "G", "N.X", "N.Y", "N.Z", "R", "Z"]
        self.assertEqual(sorted(self.render(scene, None).channels), names)
        self.assertEqual(sorted(self.render(scene, "none").channels), ["B", "G", "R"])
        self.assertEqual(sorted(self.render(scene, "Z").channels), ["B", "G", "R", "Z"])

    def test_unknown_names(self):
        _, done = self.run_whit(self.scene(SQUARE), "--aov", "Z,albdo")
        self.assertEqual(done.returncode, 2)
        self.assertIn('there is no AOV "albdo"; did you mean "albedo"?', done.stderr)
        _, done = self.run_whit(self.scene(SQUARE, film='"string aovs" ["depth"]'))
        self.assertEqual(done.returncode, 3)
        self.assertIn("scene.pbrt:2:", done.stderr)
        self.assertIn('there is no AOV "depth"', done.stderr)

    def test_other_formats_cannot_hold_them(self):
        for name in ("x.png", "x.pfm"):
            path, done = self.run_whit(self.scene(SQUARE), "--aov", "Z", outfile=name)
            self.assertEqual(done.returncode, 2)
            self.assertIn("only .exr files can", done.stderr)
            self.assertFalse(os.path.exists(path))

    def test_help_lists_them(self):
        done = subprocess.run([WHIT, "help", "aovs"], capture_output=True, text=True, check=True)
        for name in Promises.ALL.split(","):
            self.assertRegex(done.stdout, r"(?m)^%s " % name)


if __name__ == "__main__":
    unittest.main()
