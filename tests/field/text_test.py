#!/usr/bin/env python3
"""Files as they are found in the world: what is said of their text, and what `whit fmt` does to them.

The inputs are beside this file, each with what is right in its first lines.
"""
import hashlib
import os
import re
import shutil
import stat
import subprocess
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
WHIT = os.environ.get("WHIT")
SCENE = 'Camera "perspective"\nWorldBegin\nShape "sphere"\nWorldEnd\n'


@unittest.skipUnless(WHIT, "the program is not built")
class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit field ")
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def copy(self, name, *to):
        shutil.copyfile(os.path.join(FOLDER, name), self.path(*(to or (name,))))

    def write(self, text, *names):
        with open(self.path(*names), "w", encoding="utf-8") as f:
            f.write(text)

    def read(self, *names):
        with open(self.path(*names), "rb") as f:
            return f.read()

    def whit(self, *arguments):
        """Exit code and what was said."""
        done = subprocess.run([WHIT, *arguments], stdin=subprocess.DEVNULL, capture_output=True, cwd=self.folder,
                              timeout=60, check=False)
        self.assertGreaterEqual(done.returncode, 0, done.stderr)
        self.said = done.stderr.decode("utf-8")
        return done.returncode, done.stdout.decode("utf-8")

    def render(self, scene, out, code=0):
        got, _ = self.whit(scene, "--outfile", out, "--type", "float", "--display", "none", "--quiet")
        self.assertEqual(got, code, self.said)
        return self.said

    def assert_same_pictures(self, a, b):
        self.assertEqual(self.whit("diff", "--exact", a, b)[0], 0, a)

    def problems(self, scene):
        """(place, severity, message) of everything `whit check` says."""
        self.copy(scene)
        self.assertEqual(self.whit("check", scene)[0], 1)
        return re.findall(r"^%s:(\d+:\d+): (error|warning): (.*)$" % re.escape(scene), self.said, re.M)


class Tolerated(Case):
    """Mistakes that pbrt-v3 renders past: a warning for a render, an error for `whit check` and --strict."""

    def expect(self, scene, place, message):
        """A warning there; "" for a scene without a mistake."""
        self.copy(scene)
        if not place:
            self.assertEqual(self.render(scene, scene + ".exr"), "")
            self.assertEqual(self.whit("check", scene)[0], 0, self.said)
            return
        said = self.render(scene, scene + ".exr")
        self.assertEqual(len(re.findall("warning:", said)), 1, said)
        self.assertRegex(said, r"^%s:%s: warning: %s" % (re.escape(scene), place, message))
        self.assertEqual([p[:2] for p in self.problems(scene)], [(place, "error")])
        self.assertEqual(self.whit("--strict", scene, "--quiet", "--display", "none")[0], 3)
        self.assertIn("error:", self.said)

    def test_crossing_blocks(self):
        self.expect("object-nesting.pbrt", "17:3", "AttributeEnd inside the block of ObjectBegin")
        self.expect("object-nesting-right.pbrt", "", "")
        self.assert_same_pictures("object-nesting.pbrt.exr", "object-nesting-right.pbrt.exr")

    def test_unknown_named_materials(self):
        self.expect("named-material-unknown.pbrt", "11:17", 'no material named "nobody"')
        # The red material before it stays.
        text = self.read("named-material-unknown.pbrt").decode().replace('NamedMaterial "nobody"', "")
        self.write(text, "without.pbrt")
        self.assertEqual(self.render("without.pbrt", "without.exr"), "")
        self.assert_same_pictures("named-material-unknown.pbrt.exr", "without.exr")


class Messages(Case):
    def test_one_mistake_is_one_message(self):
        self.assertEqual(self.problems("word-after-numbers.pbrt"), [("10:1", "error", 'unknown directive "Shpae"')])

    def test_spaces_that_are_none(self):
        self.assertEqual([p[:2] for p in self.problems("nbsp.pbrt")], [("7:1", "error")])
        self.assertIn("no-break space, U+00A0", self.said)

    def test_quotes_and_comments_of_others(self):
        self.assertEqual([p[:2] for p in self.problems("quotes.pbrt")],
                         [("7:22", "error"), ("9:1", "error"), ("10:1", "error")])
        self.assertIn('\N{LEFT DOUBLE QUOTATION MARK} is no quote here: write "', self.said)
        self.assertIn("' is no quote here: write \"", self.said)
        self.assertIn("comments begin with #", self.said)

    def test_media_are_placed_where_they_are_made(self):
        self.copy("media-check.pbrt")
        said = self.render("media-check.pbrt", "media.exr")
        self.assertRegex(said, r"(?m)^media-check.pbrt:13:1: warning: participating media are not simulated")
        self.write(self.read("media-check.pbrt").decode().replace('MediumInterface "fog" ""', 'MediumInterface "" ""'),
                   "none.pbrt")
        self.assertEqual(self.render("none.pbrt", "none.exr"), "")

    def test_a_long_path_keeps_its_end(self):
        deep = self.path("a-folder-whose-name-is-long-enough", "another-folder-whose-name-is-long-enough")
        os.makedirs(deep)
        with open(os.path.join(deep, "scene.pbrt"), "w", encoding="utf-8") as f:
            f.write('Camera "perspective"\nWorldBegin\nInclude "geometry/missing.pbrt"\nWorldEnd\n')
        self.whit("check", os.path.join(deep, "scene.pbrt"))
        self.assertIn('another-folder-whose-name-is-long-enough/geometry/missing.pbrt": No such file', self.said)

    def test_other_versions_of_pbrt_are_said_once(self):
        self.write('Film "rgb" "string filename" "x.exr"\nSampler "zsobol"\nCamera "perspective"\nColorSpace "aces2065-1"\n'
                   'WorldBegin\n' + 'Attribute "shape" "rgb reflectance" [1 0 0]\n' * 50 +
                   'Material "diffuse"\nShape "sphere"\n', "v4.pbrt")
        self.whit("check", "v4.pbrt")
        self.assertEqual(self.said.count("this is a pbrt-v4 file"), 1, self.said)
        self.assertEqual(len(re.findall(r"error:", self.said)), 1, self.said)
        self.assertEqual(self.said.count("no statement Attribute"), 1, self.said)  # in the list of what differs

    def test_nothing_reaches_a_terminal_raw(self):
        # Escape sequences in the names of files, plugins, parameters, textures, materials and objects.
        evil = "\x1b[31mred\x07\xc2\x9b"
        name = evil + ".pbrt"
        for body in ('Shape "%s"', 'Shape "sphere" "float %s" 1', 'Material "%s"', 'NamedMaterial "%s"', '%s',
                     'Texture "%s" "float" "%s"', 'ObjectInstance "%s"', 'Include "%s"', 'LightSource "%s"',
                     'Material "matte" "texture Kd" "%s"', 'Shape "plymesh" "string filename" "%s"', 'MediumInterface "%s"',
                     'Texture "a" "spectrum" "imagemap" "string filename" "%s" Material "matte" "texture Kd" "a"',
                     'LightSource "point" "spectrum I" "%s"', 'AttributeBegin # %s', '"%s"'):
            self.write('Film "image" "string filename" "no-folder/%s.exr"\nWorldBegin\n%s\nWorldEnd\n'
                       % (evil, body.replace("%s", evil)), name)
            for command in ([name], ["check", name], ["explain", name], ["fmt", "-i", name], ["--logdir", evil, name]):
                _, out = self.whit(*command)
                self.assertNotRegex(self.said, "[\x00-\x09\x0b-\x1f\x7f-\x9f]", command)
                self.assertNotRegex(out, "[\x00-\x09\x0b-\x1f\x7f-\x9f]", command)


class FormatInPlace(Case):
    def mode(self, *names):
        return stat.S_IMODE(os.stat(self.path(*names)).st_mode)

    def format(self, *arguments, code=0):
        self.assertEqual(self.whit("fmt", "-i", *arguments)[0], code, self.said)

    def test_the_mode_stays(self):
        for mode in (0o600, 0o755, 0o664):
            self.write(SCENE.replace(" ", "   "), "a.pbrt")
            os.chmod(self.path("a.pbrt"), mode)
            self.format("a.pbrt")
            self.assertEqual(self.mode("a.pbrt"), mode)
            self.assertNotIn(b"   ", self.read("a.pbrt"))
        self.assertEqual(os.listdir(self.folder), ["a.pbrt"])

    def test_links_are_followed_and_stay(self):
        os.mkdir(self.path("sub"))
        self.write(SCENE.replace(" ", "   "), "sub", "a.pbrt")
        os.link(self.path("sub", "a.pbrt"), self.path("hard.pbrt"))
        os.symlink("sub/a.pbrt", self.path("link.pbrt"))
        os.symlink("link.pbrt", self.path("link-to-link.pbrt"))
        self.format("link-to-link.pbrt")
        self.assertTrue(os.path.islink(self.path("link-to-link.pbrt")) and os.path.islink(self.path("link.pbrt")))
        self.assertNotIn(b"   ", self.read("sub", "a.pbrt"))
        self.assertTrue(os.path.samefile(self.path("hard.pbrt"), self.path("sub", "a.pbrt")))

    def test_a_protected_file_is_refused(self):
        self.write(SCENE.replace(" ", "   "), "a.pbrt")
        before = self.read("a.pbrt")
        os.chmod(self.path("a.pbrt"), 0o444)
        self.format("a.pbrt", code=4)
        self.assertIn("write-protected", self.said)
        self.assertEqual((self.read("a.pbrt"), self.mode("a.pbrt")), (before, 0o444))
        os.chmod(self.path("a.pbrt"), 0o644)
        self.format("a.pbrt")
        os.chmod(self.path("a.pbrt"), 0o444)  # Nothing to change, and so nothing to refuse.
        self.format("a.pbrt")

    def test_what_is_no_file_is_refused(self):
        os.mkdir(self.path("folder"))
        self.format("folder", code=4)
        self.format("-", code=2)

    def test_an_empty_file_may_be_included(self):
        self.write("", "empty.pbrt")
        self.assertEqual(self.whit("fmt", "empty.pbrt"), (0, ""))
        self.format("empty.pbrt")
        self.assertEqual(self.read("empty.pbrt"), b"")

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full")
    def test_a_full_output_is_no_success(self):
        self.write(SCENE, "a.pbrt")
        for command in (["fmt", "a.pbrt"], ["--cat", "a.pbrt"]):
            with open("/dev/full", "wb") as full:
                done = subprocess.run([WHIT, *command], stdin=subprocess.DEVNULL, stdout=full, stderr=subprocess.PIPE,
                                      cwd=self.folder, timeout=60, check=False)
            self.assertEqual(done.returncode, 4, command)

    def test_no_room_loses_nothing(self):
        # A limit on the size of files stands for a full disk. The text grows: one line becomes many.
        text = "WorldBegin " + "AttributeBegin " * 200 + 'Shape "sphere" ' * 100 + "AttributeEnd " * 200 + "WorldEnd\n"
        for hard in (False, True):
            self.write(text, "a.pbrt")
            if hard:
                os.link(self.path("a.pbrt"), self.path("b.pbrt"))
            done = subprocess.run(["bash", "-c", 'trap "" XFSZ; ulimit -f 12; exec "$0" fmt -i a.pbrt', WHIT],
                                  stdin=subprocess.DEVNULL, capture_output=True, cwd=self.folder, timeout=60, check=False)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertEqual(self.read("a.pbrt").decode(), text)
            self.assertEqual(sorted(os.listdir(self.folder)), ["a.pbrt", "b.pbrt"] if hard else ["a.pbrt"])


class ToPly(Case):
    def setUp(self):
        super().setUp()
        self.copy("toply-overwrites.pbrt")
        self.copy("mesh_00001.ply")
        self.digest = hashlib.md5(self.read("mesh_00001.ply")).hexdigest()

    def check_kept(self, *names):
        self.assertEqual(hashlib.md5(self.read(*names)).hexdigest(), self.digest)

    def test_meshes_take_free_names_and_the_picture_stays(self):
        self.render("toply-overwrites.pbrt", "before.exr")
        for command in (["fmt", "--toply"], ["--toply"]):
            code, text = self.whit(*command, "toply-overwrites.pbrt")
            self.assertEqual(code, 0, self.said)
            self.check_kept("mesh_00001.ply")
            self.assertIn('"mesh_00002.ply"', text)
            self.write(text, "after.pbrt")
            self.render("after.pbrt", "after.exr")
            self.assert_same_pictures("before.exr", "after.exr")
        # The second command found its mesh there, byte by byte.
        self.assertEqual([f for f in sorted(os.listdir(self.folder)) if f.endswith(".ply")],
                         ["mesh_00001.ply", "mesh_00002.ply"])

    def test_meshes_stand_beside_the_scene(self):
        os.mkdir(self.path("sub"))
        self.copy("toply-overwrites.pbrt", "sub", "s.pbrt")
        self.copy("mesh_00001.ply", "sub", "mesh_00001.ply")
        for command in (["fmt", "--toply"], ["--toply"], ["fmt", "-i", "--toply"]):
            self.assertEqual(self.whit(*command, "sub/s.pbrt")[0], 0, self.said)
            self.assertEqual(sorted(os.listdir(self.path("sub"))), ["mesh_00001.ply", "mesh_00002.ply", "s.pbrt"])
            self.assertFalse(os.path.exists(self.path("mesh_00002.ply")))
            self.check_kept("sub", "mesh_00001.ply")

    def test_no_mesh_is_left_of_a_scene_that_is_refused(self):
        text = self.read("toply-overwrites.pbrt").decode()
        self.write(text + "Spheer\n", "broken.pbrt")
        os.chmod(self.path("toply-overwrites.pbrt"), 0o444)
        for scene, code in (("broken.pbrt", 3), ("toply-overwrites.pbrt", 4)):
            self.assertEqual(self.whit("fmt", "-i", "--toply", scene)[0], code, self.said)
            self.assertFalse(os.path.exists(self.path("mesh_00002.ply")))


if __name__ == "__main__":
    unittest.main()
