#!/usr/bin/env python3
"""Models through all three doors: rendered as they are, imported and rendered, and placed by a scene.

The models are those of make_models.py. Pictures are compared with those in tests/gltf/golden, which were looked at when they
were stored (`models_test.py --store`, with $WHIT and a release build); values that have a closed form are derived below.
"""
import math
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import make_models  # noqa: E402
from pictures import pixels  # noqa: E402

WHIT = os.environ.get("WHIT")
HERE = os.path.dirname(os.path.abspath(__file__))
GOLDEN = os.path.join(HERE, "golden")
SIDE = 320  # --quick makes a quarter of the 1280 pixels that a model's picture has
FLAGS = {"animation": ["--time", "0.5"], "variants": ["--variant", "sea"], "two_scenes": ["--scene", "square"]}


def whit(*args, cwd=None):
    return subprocess.run([WHIT, *args], capture_output=True, text=True, cwd=cwd, timeout=120)


def reduced(picture):
    """The mean of each 4 x 4 pixels, as on a display: 8-bit sRGB."""
    h, w = picture.shape[0] // 4 * 4, picture.shape[1] // 4 * 4
    mean = picture[:h, :w].reshape(h // 4, 4, w // 4, 4, 3).mean((1, 3))
    mean = np.clip(mean, 0, 1)
    return np.round(np.where(mean <= 0.0031308, mean * 12.92, 1.055 * mean ** (1 / 2.4) - 0.055) * 255)


class Folder(unittest.TestCase):
    """All models in a folder of their own."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = cls.temporary.name
        cls.paths = {os.path.splitext(os.path.basename(p))[0]: p for p in make_models.write(cls.folder)}

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def render(self, path, *flags):
        """A quarter of the size each way, one sample a pixel."""
        out = os.path.join(self.folder, "picture.exr")
        done = whit(path, "--quick", "--type", "float", "--quiet", "--display", "none", "-o", out, *flags)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("warning", done.stderr)
        return pixels(out)

    def write(self, name, model):
        """A model into the folder, as .glb or as .gltf with all of it in the text; its path."""
        path = os.path.join(self.folder, name)
        with open(path, "wb") as f:
            f.write(model.glb() if name.endswith(".glb") else model.gltf(model.data_uri()).encode())
        return path

    def model(self, name):
        return self.render(self.paths[name], *FLAGS.get(name, []))

    def scene(self, text):
        path = os.path.join(self.folder, "scene.pbrt")
        with open(path, "w") as f:
            f.write(text)
        return self.render(path)


class EveryModelTest(Folder):
    def test_import_gives_the_same_bits(self):
        for name, path in self.paths.items():
            with self.subTest(model=name):
                direct = self.model(name)
                scene = os.path.join(self.folder, "imported", name + ".pbrt")
                os.makedirs(os.path.dirname(scene), exist_ok=True)
                done = whit("import", path, "-o", scene, *FLAGS.get(name, []))
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(np.array_equal(direct, self.render(scene)))

    def test_golden_pictures(self):
        """The same program gives the same bits; other compilers and processors may round another way, and a pixel of
        16 samples is then off by a few steps. A wrong wrap, sign or colour is off by tens over a part of the picture."""
        for name in self.paths:
            with self.subTest(model=name):
                seen = reduced(self.model(name))
                golden = oiio.ImageBuf(os.path.join(GOLDEN, name + ".png")).get_pixels(oiio.FLOAT)[..., :3] * 255
                self.assertEqual(seen.shape, golden.shape)
                off = np.abs(seen - golden)
                self.assertLess(off.mean(), 0.3)
                self.assertLess((off.max(-1) > 8).mean(), 0.005)


class GeometryTest(Folder):
    # The camera of the test models is at (0, 0, 4), its angle 0.7: at z = 0 the picture is 8 tan(0.35) wide.
    WIDTH = 8 * math.tan(0.35)

    def covered(self, picture):
        """Where there is something: middle, width and height in units of the scene."""
        rows, columns = np.nonzero(picture.sum(-1) > 0)
        scale = self.WIDTH / SIDE
        return ((columns.mean() + 0.5 - SIDE / 2) * scale, (SIDE / 2 - rows.mean() - 0.5) * scale,
                (columns.max() - columns.min() + 1) * scale, (rows.max() - rows.min() + 1) * scale)

    def assertCovers(self, picture, x, y, width, height):
        pixel = self.WIDTH / SIDE
        for seen, expected in zip(self.covered(picture), (x, y, width, height)):
            self.assertAlmostEqual(seen, expected, delta=2 * pixel)

    def test_indices_of_any_size_are_the_same(self):
        expected = self.model("triangles_u8")
        self.assertCovers(expected, 0, 0, 2, 2)
        for name in ("triangles_u16", "triangles_u32", "triangles_plain"):
            self.assertTrue(np.array_equal(expected, self.model(name)), name)

    def test_strips_and_fans(self):
        self.assertCovers(self.model("strip"), 0, 0, 2, 2)
        self.assertCovers(self.model("fan"), 0, 0, 2, math.sqrt(3))

    def test_quantized_positions_are_scaled_by_their_node(self):
        self.assertCovers(self.model("quantized"), 0, 0, 2, 2)

    def test_parents_move_children(self):
        # A square of 1 x 0.5, turned by 45 degrees: 1.5 / sqrt(2) wide and high; moved by 0.5.
        self.assertCovers(self.model("hierarchy"), 0.5, 0, 1.5 / math.sqrt(2), 1.5 / math.sqrt(2))

    def test_skinned_meshes_are_where_their_joints_are(self):
        # Up to y = -0.25 nothing moves; from 0.25 on all is turned by 60 degrees to the right about the origin. The
        # corner at (-0.2, 1) is at (-0.2 cos 60 + sin 60, 0.2 sin 60 + cos 60), that at (0.2, 1) at (0.966, 0.327).
        c, s = 0.5, math.sin(math.pi / 3)
        seen = self.covered(self.model("skin"))
        self.assertAlmostEqual(seen[2], (0.2 * c + s) + 0.2, delta=0.02)
        self.assertAlmostEqual(seen[3], (0.2 * s + c) + 1, delta=0.02)

    def test_morph_targets_are_added_by_weight(self):
        # The corner (1, 1) moves by half of (0.5, 0.5), the corner (-1, -1) by all of (-0.2, 0.5): from -1.2 to 1.25, and
        # from the lower right corner's -1 to 1.25.
        seen = self.covered(self.model("morph"))
        self.assertAlmostEqual(seen[2], 2.45, delta=0.02)
        self.assertAlmostEqual(seen[3], 2.25, delta=0.02)

    def test_animations_are_sampled(self):
        picture = self.model("animation")
        third = SIDE // 3
        scale = self.WIDTH / SIDE
        rows, _ = np.nonzero(picture[:, :third].sum(-1))
        self.assertAlmostEqual((SIDE / 2 - rows.mean() - 0.5) * scale, 0.5, delta=0.02)  # half way to 1
        rows, columns = np.nonzero(picture[:, third:2 * third].sum(-1))
        self.assertAlmostEqual((columns.max() - columns.min() + 1) * scale, 0.6 * math.sqrt(2), delta=0.02)  # 45 degrees
        rows, columns = np.nonzero(picture[:, 2 * third:].sum(-1))
        self.assertAlmostEqual((columns.max() - columns.min() + 1) * scale, 0.3, delta=0.02)  # half of 0.6

    def test_orthographic_cameras_see_twice_their_magnification(self):
        picture = self.model("orthographic")
        self.assertAlmostEqual((picture.sum(-1) > 0).mean(), 0.25, delta=0.01)  # 2 x 2 of 4 x 4

    def test_scenes_are_chosen_by_name_and_number(self):
        by_name = self.render(self.paths["two_scenes"], "--scene", "square")
        self.assertTrue(np.array_equal(by_name, self.render(self.paths["two_scenes"], "--scene", "1")))
        self.assertCovers(by_name, 0, 0, 2, 2)


class ColorTest(Folder):
    def test_unlit_shows_the_picture_decoded(self):
        picture = self.model("unlit")
        width = 8 * math.tan(0.35)
        at = lambda x, y: picture[int(SIDE / 2 - y * SIDE / width), int(SIDE / 2 + x * SIDE / width)]
        decode = lambda v: ((v / 255 + 0.055) / 1.055) ** 2.4
        # In the middle of quarters of one colour, filters see nothing else.
        for (x, y), expected in [((-0.5, 0.5), (decode(230), 0, 0)), ((0.5, 0.5), (0, decode(200), 0)), ((-0.5, -0.5), (0, 0, decode(240)))]:
            np.testing.assert_allclose(at(x, y), expected, rtol=1e-5, atol=1e-6)

    def test_textured_square_has_the_bits_of_the_same_pbrt_scene(self):
        with open(os.path.join(self.folder, "quad.png"), "wb") as f:
            f.write(make_models.png(make_models.picture()))
        half = math.degrees(0.7)
        expected = self.scene(f"""
Film "image" "integer xresolution" 1280 "integer yresolution" 1280
Sampler "sobol" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 8
Transform [ 1 0 0 0  0 1 0 0  0 0 -1 0  0 0 4 1 ]
Camera "perspective" "float fov" {half!r} "float screenwindow" [ -1 1 -1 1 ]
WorldBegin
AttributeBegin
  ConcatTransform [ {' '.join(repr(v) for v in rotation(-0.35, -0.2, 0, 0.9))} ]
  LightSource "distant" "rgb L" [ 2.5 2.5 2.5 ] "point to" [ 0 0 -1 ]
AttributeEnd
Texture "picture" "spectrum" "imagemap" "string filename" "quad.png"
Material "metallicroughness" "texture basecolor" "picture" "float metallic" 0
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ]
  "normal N" [ 0 0 1 0 0 1 0 0 1 0 0 1 ] "float uv" [ 0 0  1 0  1 1  0 1 ]
WorldEnd
""")
        for name in ("base_color_texture", "external_buffer", "data_uri"):
            self.assertTrue(np.array_equal(expected, self.model(name)), name)

    def test_blending_fades_what_is_emitted_too(self):
        # Alpha 0.3 over a white surface that emits 1: 0.3 c + 0.7, of an unlit colour c as of an emission c.
        for extras in ({"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 0.3]}, "extensions": {"KHR_materials_unlit": {}}},
                       {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 0.3], "metallicFactor": 0},
                        "emissiveFactor": [1, 0.5, 0.25], "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}):
            model = make_models.Model()
            model.light("point", intensity=0.0)
            model.add(material=model.material(alphaMode="BLEND", **extras))
            model.add(make_models.QUAD * 4, at=[0, 0, -1], material=model.material(
                pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}, emissiveFactor=[1, 1, 1],
                extensions={"KHR_materials_specular": {"specularFactor": 0}}))
            path = self.write("faded.glb", model)
            middle = self.render(path)[SIDE // 4:SIDE * 3 // 4, SIDE // 4:SIDE * 3 // 4].mean((0, 1))
            np.testing.assert_allclose(middle, (1, 0.85, 0.775), atol=0.02)  # a coin for each of 25,000 pixels: 0.003

    def test_light_behind_the_mapped_normal_is_not_seen(self):
        # A map whose normal is (0.8, 0, 0.6) everywhere, and light from 60 degrees on the other side: its cosine is negative.
        model = make_models.Model()
        tilt = np.tile(np.round((np.array([0.8, 0, 0.6]) * 0.5 + 0.5) * 255), (4, 4, 1))
        texture = model.image(make_models.png(tilt))
        model.light("directional", rotation=[0, -math.sin(math.pi / 6), 0, math.cos(math.pi / 6)])
        model.add(normals=[[0, 0, 1]] * 4, uv=make_models.QUAD_UV, material=model.material(
            **make_models.pbr((1, 1, 1)), normalTexture={"index": texture}))
        path = self.write("behind.glb", model)
        self.assertEqual(self.render(path).max(), 0)

    def test_variants_change_materials(self):
        plain, sea = self.render(self.paths["variants"]), self.model("variants")
        self.assertGreater(plain.mean((0, 1))[0], 5 * plain.mean((0, 1))[2])
        self.assertGreater(sea.mean((0, 1))[2], 5 * sea.mean((0, 1))[0])

    def test_a_mask_cuts_exactly(self):
        # Alpha falls from 1 to 0 over 32 texels, of which the first 20 (255 - 255 k / 31 >= 102) have 0.4 at least; between
        # texels it is linear, so that it falls below at texel 18.6 (1 - k / 31 = 0.4), whose middle is at (18.6 + 0.5) / 32.
        picture = self.model("alpha_mask")
        _, columns = np.nonzero(picture.sum(-1))
        width = 8 * math.tan(0.35)
        self.assertAlmostEqual((columns.max() + 1 - SIDE / 2) * width / SIDE, -1 + 2 * 19.1 / 32, delta=0.03)

    def test_an_emissive_surface_lights(self):
        picture = self.model("emissive")
        glow = picture[SIDE * 33 // 100, SIDE // 2]
        np.testing.assert_allclose(glow, (4, 2, 1), rtol=1e-5)
        floor = picture[SIDE * 3 // 5:]
        floor = floor[floor.sum(-1) > 0].mean(0)
        # The square of 1 x 1 is seen from points below it, 0.6 to 1.4 away, under cosines of 0.3 to 0.7 on both sides: an
        # irradiance of some tenths of 4, times 0.8 / pi.
        self.assertGreater(floor[0], 0.05)
        self.assertLess(floor[0], 0.8)
        # White light tinted 4 : 2 : 1; a fourth of what arrives has met the square's own grey before, at most.
        self.assertAlmostEqual(floor[0] / floor[2], 4, delta=1)


def rotation(x, y, z, w):
    """The matrix of a quaternion, as ConcatTransform has it, in the order of the program's own arithmetic."""
    two = 2 / (x * x + y * y + z * z + w * w)
    return [1 - two * (y * y + z * z), two * (x * y + z * w), two * (x * z - y * w), 0,
            two * (x * y - z * w), 1 - two * (x * x + z * z), two * (y * z + x * w), 0,
            two * (x * z + y * w), two * (y * z - x * w), 1 - two * (x * x + y * y), 0, 0, 0, 0, 1]


HEAD = """
Film "image" "integer xresolution" 1280 "integer yresolution" 1280
Sampler "sobol" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 8
Transform [ 1 0 0 0  0 1 0 0  0 0 -1 0  0 0 4 1 ]
Camera "perspective" "float fov" 40.10704565915762 "float screenwindow" [ -1 1 -1 1 ]
WorldBegin
"""


class InScenesTest(Folder):
    """Shape "gltf"."""

    def test_a_scene_places_a_model_with_its_materials_and_lights(self):
        for name in ("base_color_texture", "instances", "lights", "vertex_colors"):
            imported = os.path.join(self.folder, "head.pbrt")
            self.assertEqual(whit("import", self.paths[name], "-o", imported, "--force").returncode, 0)
            with open(imported) as f:
                head = f.read().split("WorldBegin")[0]
            scene = self.scene(head + f'WorldBegin\nShape "gltf" "string filename" "{name}.glb" "bool uselights" "true"\nWorldEnd\n')
            self.assertTrue(np.array_equal(scene, self.model(name)), name)

    def test_without_materials_it_wears_the_current_one(self):
        light = 'LightSource "distant" "point from" [ 0 0 1 ] "point to" [ 0 0 0 ]\n'
        picture = self.scene(HEAD + light + 'Material "matte" "rgb Kd" [ 0 0.5 0 ]\n'
                             'Shape "gltf" "string filename" "base_color_texture.glb" "bool usematerials" "false"\nWorldEnd\n')
        # Lambert: albedo / pi times an irradiance of 1.
        np.testing.assert_allclose(picture[SIDE // 2, SIDE // 2], (0, 0.5 / math.pi, 0), rtol=1e-5)

    def test_it_is_transformed_and_instanced(self):
        light = 'LightSource "distant" "point from" [ 0 0 1 ] "point to" [ 0 0 0 ]\n'
        once = self.scene(HEAD + light + 'Translate 0.5 0 0\nScale 0.5 0.5 0.5\nShape "gltf" "string filename" "triangles_u16.glb"\nWorldEnd\n')
        placed = self.scene(HEAD + light + 'ObjectBegin "a"\nShape "gltf" "string filename" "triangles_u16.glb"\nObjectEnd\n'
                            'Translate 0.5 0 0\nScale 0.5 0.5 0.5\nObjectInstance "a"\nWorldEnd\n')
        np.testing.assert_allclose(once, placed, atol=1e-5)
        self.assertGreater((once.sum(-1) > 0).mean(), 0.1)

    def test_meshes_that_are_repeated_are_moved_once(self):
        # The same by the scene's transform and by a node above all others.
        light = 'LightSource "distant" "point from" [ 0 0 1 ] "point to" [ 0 0 0 ]\n'
        model = make_models.instances()
        roots = model.doc["scenes"][0]["nodes"]
        model.doc["scenes"][0]["nodes"] = [model.node(root=False, children=list(roots), translation=[0.25, 0.5, 0])]
        self.write("moved.glb", model)
        moved = self.scene(HEAD + light + 'Shape "gltf" "string filename" "moved.glb"\nWorldEnd\n')
        placed = self.scene(HEAD + light + 'Translate 0.25 0.5 0\nShape "gltf" "string filename" "instances.glb"\nWorldEnd\n')
        self.assertLess((np.abs(moved - placed).max(-1) > 1e-4).mean(), 0.001)

    def test_a_model_moves_whole_whatever_transform_is_active(self):
        light = 'LightSource "distant" "point from" [ 0 0 1 ] "point to" [ 0 0 0 ]\n'
        text = HEAD + light + 'ActiveTransform EndTime\nTranslate 0.5 0 0\n%sShape "gltf" "string filename" "hierarchy.glb"\nWorldEnd\n'
        self.assertTrue(np.array_equal(self.scene(text % ""), self.scene(text % "ActiveTransform All\n")))

    def test_a_warning_is_said_once_for_a_file(self):
        model = make_models.triangles_u16()
        model.use("ACME_hologram")
        self.write("warns.gltf", model)
        done = whit("check", self.write_scene('LightSource "infinite"\n' + 3 * 'Shape "gltf" "string filename" "warns.gltf"\nTranslate 0 3 0\n'))
        self.assertEqual(done.stderr.count("ACME_hologram"), 1, done.stderr)

    def test_only_text_of_models_has_attachments(self):
        done = whit("check", self.write_scene('LightSource "infinite"\nShape "gltf" "string filename" "skin.glb"\nShape "sphere" "string attached" "0"\n'))
        self.assertIn('sphere has no parameter "attached"', done.stderr)

    def test_one_node_alone(self):
        # hierarchy.glb: node 0 is the camera, 1 the light, 2 the square, 3 its parent, 4 its grandparent.
        light = 'LightSource "distant" "point from" [ 0 0 1 ] "point to" [ 0 0 0 ]\n'
        whole = self.scene(HEAD + light + 'Shape "gltf" "string filename" "hierarchy.glb"\nWorldEnd\n')
        part = self.scene(HEAD + light + 'Shape "gltf" "string filename" "hierarchy.glb" "string node" "2"\nWorldEnd\n')
        self.assertTrue(np.array_equal(whole, part))

    def test_what_is_never_placed_is_not_read(self):
        with open(os.path.join(self.folder, "broken.glb"), "wb") as f:
            f.write(b"glTF, but no more than that")
        text = 'ObjectBegin "never"\nShape "gltf" "string filename" "broken.glb"\nObjectEnd\nLightSource "infinite"\nShape "sphere"\nWorldEnd\n'
        self.scene(HEAD + text)
        path = os.path.join(self.folder, "scene.pbrt")
        self.assertEqual(whit("check", path).returncode, 1)  # which reads all there is

    def test_mistakes_have_their_place(self):
        for text, place, message in [
                ('Shape "gltf" "string filename" "none.glb"\n', "8:32", "none.glb"),
                ('Shape "gltf"\n', "8:1", "filename"),
                ('Shape "gltf" "string filename" "variants.glb" "integer variant" 7\n', "8:1", "no variant \"7\""),
                ('Shape "gltf" "string filename" "variants.glb" "string node" "roof"\n', "8:1", "no node \"roof\"")]:
            path = os.path.join(self.folder, "wrong.pbrt")
            with open(path, "w") as f:
                f.write(HEAD + text + "WorldEnd\n")
            done = whit(path, "--quick", "-o", os.path.join(self.folder, "wrong.exr"))
            self.assertIn(done.returncode, (3, 4), done.stderr)
            self.assertIn(f"wrong.pbrt:{place}: error:", done.stderr)
            self.assertIn(message, done.stderr)
        done = whit("check", self.write_scene('Shape "gltf" "string filename" "variants.glb" "bool usematerial" "true"\n'))
        self.assertIn("did you mean \"usematerials\"", done.stderr)

    def write_scene(self, text):
        path = os.path.join(self.folder, "text.pbrt")
        with open(path, "w") as f:
            f.write(HEAD + text + "WorldEnd\n")
        return path


class DoorsTest(Folder):
    def test_without_a_camera_all_of_it_is_in_the_picture(self):
        out = os.path.join(self.folder, "framed.exr")
        done = whit(self.paths["no_camera"], "--quick", "--aov", "Z", "-o", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no_camera.glb: there is no camera in the file: this one looks from", done.stderr)
        self.assertIn("no lights in the file", done.stderr)
        pictures = oiio.ImageBuf(out)
        names = list(pictures.spec().channelnames)
        depth = pictures.get_pixels(oiio.FLOAT)[..., names.index(next(n for n in names if n.split(".")[-1] == "Z"))]
        seen = np.isfinite(depth) & (depth > 0)
        border = np.concatenate([seen[0], seen[-1], seen[:, 0], seen[:, -1]])
        self.assertFalse(border.any())
        self.assertGreater(seen.any(0).mean(), 0.3)

    def test_wrong_names_say_what_there_is(self):
        for flag, message in [("--camera", "has no camera"), ("--scene", "has no scene"), ("--variant", "has no variant")]:
            done = whit(self.paths["variants"], flag, "moon", "--quick", "-o", os.path.join(self.folder, "x.exr"))
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(message, done.stderr)
        self.assertIn('"fire", "sea"', done.stderr)

    def test_flags_of_models_are_wrong_for_scenes(self):
        path = os.path.join(self.folder, "plain.pbrt")
        with open(path, "w") as f:
            f.write("WorldBegin\nWorldEnd\n")
        done = whit(path, "--time", "1")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--time is of glTF models", done.stderr)

    def test_pictures_do_not_replace_files_of_the_model(self):
        folder = os.path.join(self.folder, "duck")
        os.makedirs(folder)
        files = make_models.external_buffer()
        texture = files["the picture.png"]
        text = files["external_buffer.gltf"].replace(b"the%20picture.png", b"duck.png")
        for name, data in (("duck.gltf", text), ("duck.png", texture), ("the buffer.bin", files["the buffer.bin"])):
            with open(os.path.join(folder, name), "wb") as f:
                f.write(data)
        done = whit("duck.gltf", "--quick", cwd=folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("duck-whit.png", done.stderr + done.stdout)
        for flag in ("-o", "--display"):
            done = whit("duck.gltf", "--quick", flag, "duck.png", cwd=folder)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertIn("is a file that the scene reads", done.stderr)
        # Nor does an import, whose folder would be the model's own.
        inner = os.path.join(folder, "x")
        os.makedirs(inner)
        with open(os.path.join(inner, "a.png"), "wb") as f:
            f.write(texture)
        with open(os.path.join(inner, "the buffer.bin"), "wb") as f:
            f.write(files["the buffer.bin"])
        doc = make_models.json.loads(text)
        doc["images"] = [{"uri": "a.png", "name": "b"}, {"uri": "b.png", "name": "a"}]
        doc["textures"] = [{"source": 0}, {"source": 1}]
        doc["materials"][0]["emissiveTexture"] = {"index": 1}
        doc["materials"][0]["emissiveFactor"] = [1, 1, 1]
        with open(os.path.join(inner, "b.png"), "wb") as f:
            f.write(make_models.png(make_models.picture(size=8)))
        with open(os.path.join(inner, "m.gltf"), "w") as f:
            make_models.json.dump(doc, f)
        done = whit("import", os.path.join(inner, "m.gltf"), "-o", os.path.join(folder, "x.pbrt"), "--force")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("is a picture of the model itself", done.stderr)
        with open(os.path.join(folder, "duck.png"), "rb") as f, open(os.path.join(inner, "a.png"), "rb") as g:
            self.assertEqual((f.read(), g.read()), (texture, texture))

    def test_names_are_names_and_no_statements(self):
        model = make_models.base_color_texture()
        nasty = 'a\rInclude "/etc/hostname"\r\nShape "sphere"\n\u0000"\\'
        for kind in ("nodes", "meshes", "materials", "images"):
            for thing in model.doc[kind]:
                thing["name"] = nasty
        model.doc["extensions"]["KHR_lights_punctual"]["lights"][0]["name"] = nasty
        path = self.write("nasty.glb", model)
        expected = self.model("base_color_texture")
        self.assertTrue(np.array_equal(self.render(path), expected))
        scene = os.path.join(self.folder, "nasty.pbrt")
        self.assertEqual(whit("import", path, "-o", scene).returncode, 0)
        self.assertTrue(np.array_equal(self.render(scene), expected))

    def test_what_is_scaled_to_nothing_is_not_shown(self):
        model = make_models.triangles_u16()
        mesh = 0
        for scale in ([0, 0, 0], [1, 0, 1]):
            model.node(mesh=mesh, scale=scale)
        path = self.write("nothing.glb", model)
        done = whit(path, "--quick", "-o", os.path.join(self.folder, "n.exr"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 meshes are scaled to nothing", done.stderr)
        self.assertTrue(np.array_equal(self.render(path), self.model("triangles_u16")))

    def test_placements_are_bounded(self):
        model = make_models.Model()
        mesh = model.add(node=False)
        model.use("EXT_mesh_gpu_instancing")
        count = model.put("accessors", {"componentType": make_models.FLOAT, "count": 2000000, "type": "VEC3"})
        model.node(mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": count}}})
        path = self.write("bomb.glb", model)
        done = whit(path, "--quick", "-o", os.path.join(self.folder, "n.exr"))
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("bomb.glb: /nodes/1: places meshes more than 1000000 times", done.stderr)

    def test_pipes_are_read_once(self):
        done = subprocess.run([WHIT, "check", "/dev/stdin"], input='LightSource "infinite"\nWorldBegin\nShape "sphere"\nWorldEnd\n', text=True,
                              capture_output=True, timeout=60)
        self.assertNotIn("the file is empty", done.stderr)

    def test_models_where_text_is_expected_are_named(self):
        with open(self.paths["skin"], "rb") as f:
            done = subprocess.run([WHIT, "-", "--quick"], stdin=f, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 3)
        self.assertIn("it is a glTF model", done.stderr)

    def test_import_does_not_overwrite_what_was_edited(self):
        scene = os.path.join(self.folder, "mine.pbrt")
        self.assertEqual(whit("import", self.paths["skin"], "-o", scene).returncode, 0)
        self.assertEqual(whit("import", self.paths["skin"], "-o", scene).returncode, 0)  # the same again
        with open(scene, "a") as f:
            f.write("# mine\n")
        done = whit("import", self.paths["skin"], "-o", scene)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("is there already", done.stderr)
        with open(scene) as f:
            self.assertIn("# mine", f.read())
        self.assertEqual(whit("import", self.paths["skin"], "-o", scene, "--force").returncode, 0)

    def test_imports_that_fail_leave_nothing(self):
        folder = os.path.join(self.folder, "empty")
        os.makedirs(folder)
        model = make_models.base_color_texture()
        model.doc["images"][0] = {"uri": "missing.png"}
        self.write("lacks.gltf", model)
        done = whit("import", os.path.join(self.folder, "lacks.gltf"), "-o", os.path.join(folder, "lacks.pbrt"))
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("missing.png", done.stderr)
        self.assertEqual(os.listdir(folder), [])

    def test_errors_name_the_file_and_the_place_in_it(self):
        model = make_models.triangles_u16()
        model.doc["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 17
        model.doc["nodes"][0]["children"] = [0]
        path = self.write("wrong.gltf", model)
        done = whit(path, "--quick")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("wrong.gltf: /meshes/0/primitives/0/attributes/POSITION: ", done.stderr)
        self.assertIn("wrong.gltf: /nodes/0", done.stderr)  # all of them, not only the first

    def test_nothing_outside_of_the_folder_is_read(self):
        inner = os.path.join(self.folder, "inner")
        os.makedirs(inner, exist_ok=True)
        model = make_models.triangles_u16()
        with open(os.path.join(self.folder, "secret.bin"), "wb") as f:
            f.write(bytes(model.bytes))
        for uri in ("../secret.bin", "%2e%2e/secret.bin", "x/../../secret.bin", os.path.join(self.folder, "secret.bin")):
            path = os.path.join(inner, "outside.gltf")
            with open(path, "w") as f:
                f.write(model.gltf(uri))
            done = whit(path, "--quick", "-o", os.path.join(self.folder, "o.exr"))
            self.assertNotEqual(done.returncode, 0, uri)
            self.assertIn("--allow-outside", done.stderr)
        with open(path, "w") as f:
            f.write(model.gltf("../secret.bin"))
        done = whit(path, "--quick", "--allow-outside", "-o", os.path.join(self.folder, "o.exr"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(whit("check", path, "--allow-outside").returncode, 0)

    def test_required_extensions_that_are_not_there_are_errors(self):
        for required, code in ((True, 3), (False, 0)):
            model = make_models.triangles_u16()
            model.use("ACME_hologram", required=required)
            path = self.write("hologram.gltf", model)
            done = whit(path, "--quick", "-o", os.path.join(self.folder, "o.exr"))
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertEqual(done.stderr.count("ACME_hologram"), 2 if required else 1, done.stderr)  # the error and its remedy
            if required:
                self.assertIn("re-export without \"ACME_hologram\"", done.stderr)


def store():
    """Renders the golden pictures."""
    os.makedirs(GOLDEN, exist_ok=True)
    test = EveryModelTest()
    EveryModelTest.setUpClass()
    for name in test.paths:
        picture = reduced(test.model(name)).astype(np.uint8)
        with open(os.path.join(GOLDEN, name + ".png"), "wb") as f:
            f.write(make_models.png(picture))
    EveryModelTest.tearDownClass()


if __name__ == "__main__":
    if not WHIT:
        sys.exit(77)
    if sys.argv[1:] == ["--store"]:
        store()
    else:
        unittest.main()
