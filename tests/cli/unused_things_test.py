#!/usr/bin/env python3
"""What nothing uses never stops a render: the picture is that of the scene without it, and a warning says what is wrong.
`whit check` calls it an error, --strict refuses it, and the same mistake in something that is used stops the render.
"""
import os
import re
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
FIELD = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "field"))
HEAD = """Camera "perspective" "float fov" 40
Film "image" "integer xresolution" 16 "integer yresolution" 16
Sampler "halton" "integer pixelsamples" 4
Integrator "whitted"
"""
WORLD = """WorldBegin
LightSource "point" "rgb I" [20 20 20]
%s
Translate 0 0 5
Shape "sphere"
WorldEnd
"""
FLAT = "ConcatTransform [0 0 0 0  0 1 0 0  0 0 -1 0  100 0 0 1]"
TRIANGLE = 'Shape "trianglemesh" "integer indices" [0 1 2] "point P" [0 0 5 1 0 5 0 1 5]'

# What is not used, and the same where it is: by name, (unused, used, exit code when used).
CASES = {
    "a texture whose file is gone": ('Texture "t" "color" "imagemap" "string filename" "gone.png"',
                                     'Texture "t" "color" "imagemap" "string filename" "gone.png"\n'
                                     'Material "matte" "texture Kd" "t"', 4),
    "a texture of an unknown kind": ('Texture "t" "color" "voronoi"',
                                     'Texture "t" "color" "voronoi"\nMaterial "matte" "texture Kd" "t"', 3),
    "a texture inside one that is not used": (
        'Texture "a" "color" "imagemap" "string filename" "gone.png"\nTexture "b" "color" "scale" "texture tex1" "a"',
        'Texture "a" "color" "imagemap" "string filename" "gone.png"\nTexture "b" "color" "scale" "texture tex1" "a"\n'
        'Material "matte" "texture Kd" "b"', 4),
    "a named material": ('MakeNamedMaterial "m" "string type" "matte" "texture Kd" "undefined"',
                         'MakeNamedMaterial "m" "string type" "matte" "texture Kd" "undefined"\nNamedMaterial "m"', 3),
    "a material": ('AttributeBegin\nMaterial "matte" "texture Kd" "undefined"\nAttributeEnd',
                   'Material "matte" "texture Kd" "undefined"', 3),
    "a mix of unusable materials": (
        'MakeNamedMaterial "a" "string type" "matte" "texture Kd" "undefined"\n'
        'MakeNamedMaterial "b" "string type" "mix" "string namedmaterial1" "a" "string namedmaterial2" "a"',
        'MakeNamedMaterial "a" "string type" "matte" "texture Kd" "undefined"\n'
        'MakeNamedMaterial "b" "string type" "mix" "string namedmaterial1" "a" "string namedmaterial2" "a"\n'
        'NamedMaterial "b"', 3),
    "a bsdf file": ('MakeNamedMaterial "m" "string type" "fourier" "string bsdffile" "gone.bsdf"',
                    'MakeNamedMaterial "m" "string type" "fourier" "string bsdffile" "gone.bsdf"\nNamedMaterial "m"', 4),
    "a parameter that is not asked for": (
        'Texture "t" "float" "imagemap" "string filename" "gone.png"\nAttributeBegin\n'
        'Material "uber" "rgb Ks" 0 "texture roughness" "t" "texture index" "undefined"\nTranslate 0 9 5\n'
        'Shape "sphere"\nAttributeEnd'.replace('"rgb Ks" 0', '"rgb Ks" [0 0 0]'),
        'Texture "t" "float" "imagemap" "string filename" "gone.png"\nAttributeBegin\n'
        'Material "uber" "texture roughness" "t"\nTranslate 0 9 5\nShape "sphere"\nAttributeEnd', 4),
    "a value that is not asked for": (
        'AttributeBegin\nMaterial "glass" "float index" 0 "float eta" 1.5\nTranslate 0 9 5\nShape "sphere"\nAttributeEnd',
        'AttributeBegin\nMaterial "glass" "float index" 0\nTranslate 0 9 5\nShape "sphere"\nAttributeEnd', 3),
    "a shape of an object that is never placed": ('ObjectBegin "o"\nShape "sphere" "float radius" -1\nObjectEnd',
                                                  'ObjectBegin "o"\nShape "sphere" "float radius" -1\nObjectEnd\n'
                                                  'ObjectInstance "o"', 3),
    "a mesh's file in such an object": ('ObjectBegin "o"\nShape "plymesh" "string filename" "gone.ply"\nObjectEnd',
                                        'Shape "plymesh" "string filename" "gone.ply"', 4),
    "an area light that no shape has": ('AttributeBegin\nAreaLightSource "diffuse" "spectrum L" "gone.spd"\nAttributeEnd',
                                        'AttributeBegin\nAreaLightSource "diffuse" "spectrum L" "gone.spd"\n' + TRIANGLE +
                                        '\nAttributeEnd', 4),
    "a map of a light that is black": ('LightSource "infinite" "rgb L" [0 0 0] "string mapname" "gone.exr"',
                                       'LightSource "infinite" "string mapname" "gone.exr"', 4),
    "a flat transform": ("AttributeBegin\n" + FLAT + "\nTranslate 1 0 0\nAttributeEnd",
                         "AttributeBegin\n" + FLAT + "\n" + TRIANGLE + "\nAttributeEnd", 3),
    "a flat transform in an object that is never placed": (
        'ObjectBegin "o"\n' + FLAT + '\nShape "sphere"\nObjectEnd',
        'ObjectBegin "o"\n' + FLAT + '\nShape "sphere"\nObjectEnd\nObjectInstance "o"', 3),
    "a flat transform of a texture": (
        'AttributeBegin\n' + FLAT + '\nTexture "t" "color" "uv"\nAttributeEnd\n'
        'Texture "u" "color" "uv" "string mapping" "spherical"',
        'AttributeBegin\n' + FLAT + '\nLightSource "distant"\nAttributeEnd', 3),
}


@unittest.skipUnless(WHIT, "the program is not built")
class UnusedThings(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def whit(self, *arguments):
        done = subprocess.run([WHIT, *arguments], capture_output=True, text=True, check=False, cwd=self.folder,
                              stdin=subprocess.DEVNULL, timeout=60)
        return done.returncode, done.stderr

    def scene(self, text, name="scene.pbrt"):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as f:
            f.write(text)
        return name

    def picture(self, scene, *flags):
        """The bytes of a scene's picture, and what was said."""
        picture = os.path.join(self.folder, "picture.pfm")
        if os.path.exists(picture):
            os.remove(picture)
        code, said = self.whit(scene, "--quiet", "--display", "none", "-o", "picture.pfm", *flags)
        self.assertEqual(code, 0, said)
        with open(picture, "rb") as f:
            return f.read(), said

    def test_the_picture_is_that_without(self):
        for name, (unused, used, used_code) in CASES.items():
            with self.subTest(name):
                plain, said = self.picture(self.scene(HEAD + WORLD % ""))
                self.assertEqual(said, "")
                scene = self.scene(HEAD + WORLD % unused)
                picture, said = self.picture(scene)
                self.assertNotIn("error: ", said)
                if 'Translate 0 9 5' not in unused:  # which is a shape out of view
                    self.assertEqual(picture, plain)
                if "texture" not in name or "flat" not in name:
                    self.assertRegex(said, r"(?m)^scene.pbrt:\d+:\d+: warning: ")
                    self.assertIn("nothing that is seen depends on it", said)
                    # Each place once.
                    places = re.findall(r"(?m)^scene.pbrt:(\d+:\d+): ", said)
                    self.assertEqual(len(places), len(set(places)), said)
                    self.assertEqual(self.whit(scene, "--strict", "--quiet")[0] in (3, 4), True)
                    code, said = self.whit("check", scene)
                    self.assertEqual(code, 1)
                    self.assertRegex(said, r"(?m)^scene.pbrt:\d+:\d+: error: ")
                code, said = self.whit(self.scene(HEAD + WORLD % used), "--quiet")
                self.assertEqual(code, used_code, said)
                self.assertEqual(len(re.findall("(?m)^scene.pbrt:.*: error: ", said)), 1, said)

    def test_files_met_in_the_field(self):
        for name in ("unused-things", "singular-transform-unused", "focaldistance-unused"):
            with self.subTest(name):
                with open(os.path.join(FIELD, name + ".pbrt"), encoding="utf-8") as f:
                    text = f.read()
                picture, said = self.picture(self.scene(text))
                # Their lines 14 to 19 (and the lens) are what nothing uses; the sphere stands 5 in front of the camera.
                plain = re.sub(r"(?ms)^(Texture|MakeNamed|AttributeBegin|  AttributeBegin).*(?=^\s*Translate 0 0 5)", "", text)
                plain = plain.replace(' "float lensradius" 0 "float focaldistance" 0', "")
                self.assertNotEqual(plain, text)
                without, silence = self.picture(self.scene(plain))
                self.assertEqual(silence, "")
                self.assertEqual(picture, without)
                self.assertEqual(name == "focaldistance-unused", said == "", said)

    def test_lights_that_light_nothing(self):
        broken = 'LightSource "goniometric" "string mapname" "gone.exr"'
        scene = self.scene(HEAD + WORLD % broken)
        self.assertEqual(self.whit(scene, "--quiet")[0], 4)
        self.assertIn("nothing that is seen depends on it", self.picture(scene, "--without", "delta-lights")[1])
        self.picture(self.scene(HEAD + WORLD % (broken + '\nMaterial "mirror"')))
        sky = broken.replace("goniometric", "infinite") + '\nMaterial "mirror"'
        self.assertEqual(self.whit(self.scene(HEAD + WORLD % sky), "--quiet")[0], 4)

    def test_numbers_of_a_lens_and_a_film_that_nobody_looks_at(self):
        lens = 'Camera "perspective" "float lensradius" %s "float focaldistance" 0\n'
        film = 'Film "image" "float diagonal" 0 "integer xresolution" 8 "integer yresolution" 8\n'
        self.picture(self.scene(film + lens % 0 + WORLD % ""))
        code, said = self.whit(self.scene(lens % 0.1 + WORLD % ""), "--quiet")
        self.assertEqual(code, 3)
        self.assertIn('"focaldistance" must be above 0', said)


if __name__ == "__main__":
    unittest.main()
