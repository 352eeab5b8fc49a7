#!/usr/bin/env python3
"""The program's flags, commands, exit codes and files, by running it on a tiny scene."""
import json
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
TIMEOUT = 60

# 32 x 24 pixels of a sphere that fills the middle: no ray of the pixels at the border hits it.
SCENE = """\
Film "image" "integer xresolution" [32] "integer yresolution" [24] "string filename" ["film-name.exr"]
Sampler "random" "integer pixelsamples" [2]
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
  LightSource "point" "rgb I" [10 10 10] "point from" [0 0 4]
  Shape "sphere"
WorldEnd
"""
WARNS = SCENE.replace('Shape "sphere"', 'Shape "sphere" "float raduis" [1]')      # line 7
FAILS = SCENE.replace('Shape "sphere"', 'Shape "sphere" "float radius" [-1]')     # line 7


def exr_windows(path):
    """(data window, display window) of an EXR, each (x0, y0, x1, y1) with both ends included, from its header."""
    with open(path, "rb") as f:
        header = f.read(16384)
    if header[:4] != b"\x76\x2f\x31\x01":
        raise AssertionError(path + " is no EXR")

    def box(name):
        at = header.index(name + b"\0box2i\0") + len(name) + 7
        return struct.unpack("<4i", header[at + 4:at + 20])
    return box(b"dataWindow"), box(b"displayWindow")


@unittest.skipUnless(WHIT, "the program is not built")
class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit cli ")  # a path with spaces
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("a scene.pbrt", SCENE)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as f:
            f.write(text)
        return name

    def bytes(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def files(self):
        return sorted(os.listdir(self.folder))

    def whit(self, *arguments, stdin=None, **environment):
        """Exit code, stdout, stderr; run in the temporary folder."""
        env = {k: v for k, v in os.environ.items() if k not in ("OCIO", "NO_COLOR")}
        done = subprocess.run([WHIT, *arguments], input=stdin if stdin is not None else "", capture_output=True, text=True,
                              cwd=self.folder, timeout=TIMEOUT, check=False, env={**env, **environment})
        self.assertGreaterEqual(done.returncode, 0, "signal %d\n%s" % (-done.returncode, done.stderr))
        return done.returncode, done.stdout, done.stderr

    def good(self, *arguments, **more):
        """Runs a command that must succeed without a word on stderr; returns its stdout."""
        code, out, err = self.whit(*arguments, **more)
        self.assertEqual((code, err), (0, ""), arguments)
        return out

    def fails(self, code, message, *arguments, **more):
        """Runs a command that must end with `code` and say `message`, and that must leave no new file."""
        before = self.files()
        got, out, err = self.whit(*arguments, **more)
        self.assertEqual(got, code, "%s\n%s" % (arguments, err))
        self.assertRegex(err, message)
        self.assertEqual(self.files(), before, arguments)
        return out, err

    def picture(self, *flags, name="out.exr", scene="a scene.pbrt"):
        """Renders; the name of the file written."""
        self.good(scene, "--quiet", "--display", "none", "--outfile", name, *flags)
        return name

    def same(self, a, b):
        """Whether two pictures have the same pixels, as `whit diff --exact` says."""
        code, _, err = self.whit("diff", a, b, "--exact")
        self.assertIn(code, (0, 1), err)
        return code == 0


class Usage(Case):
    def test_misspelt_flags_are_errors_with_a_suggestion(self):
        self.fails(2, "unknown flag --nthread; did you mean --nthreads?", "a scene.pbrt", "--nthread", "2")
        self.fails(2, "unknown flag --ouftile; did you mean --outfile?", "--ouftile=x.exr", "a scene.pbrt")
        self.fails(2, "unknown flag --zzzzzz\n", "a scene.pbrt", "--zzzzzz")
        self.fails(2, "not expected", "a scene.pbrt", "-x")
        self.fails(2, "unknown flag --jsn; did you mean --json?", "explain", "a scene.pbrt", "--jsn")

    def test_values_that_make_no_sense(self):
        for flags in (["--spp", "0"], ["--spp", "x"], ["--nthreads", "-1"], ["--type", "double"], ["--outfile"],
                      ["--texture-memory", "0"], ["--cropwindow", "0", "1", "0"], ["--cropwindow", ".5", "0", "0", "1"],
                      ["--cropwindow", "0", "1.5", "0", "1"], ["--traversal", "quick"]):
            _, err = self.fails(2, "^whit: .*" + flags[0], "a scene.pbrt", *flags)
            self.assertLess(max(map(len, err.splitlines())), 160, err)

    def test_missing_scene(self):
        self.fails(4, 'cannot open "nothing.pbrt"', "nothing.pbrt")
        self.fails(4, "cannot open", ".")
        for command in ("check", "fmt", "explain"):
            code, _, err = self.whit(command, "nothing.pbrt")
            self.assertIn('cannot open "nothing.pbrt"', err)
            self.assertIn(code, (1, 4), command)

    def test_several_scenes_cannot_share_an_output(self):
        self.fails(2, "--outfile with several scenes", "a scene.pbrt", "a scene.pbrt", "-o", "x.exr")

    def test_unwritable_output_is_found_before_rendering(self):
        # As many samples as would take hours.
        spp = ["--spp", "1000000"]
        self.fails(4, 'cannot write "/nonexistent/view.exr"', "a scene.pbrt", "--outfile", "/nonexistent/view.exr", *spp)
        self.fails(4, 'cannot write "x.xyz".*\\.exr', "a scene.pbrt", "--outfile", "x.xyz", *spp)
        self.fails(4, 'cannot write "/nonexistent/x.png"', "a scene.pbrt", "--display", "/nonexistent/x.png", *spp)
        os.mkdir(self.path("folder.exr"))
        self.fails(4, 'cannot write "folder.exr"', "a scene.pbrt", "--outfile", "folder.exr", *spp)
        self.write("elsewhere.pbrt", SCENE.replace("film-name.exr", "/nonexistent/film.exr"))
        self.fails(4, 'cannot write "/nonexistent/film.exr"', "elsewhere.pbrt", *spp)

    def test_ocio_and_views(self):
        self.fails(4, 'OpenColorIO config "no.ocio"', "a scene.pbrt", "--ocio", "no.ocio", "--spp", "1000000")
        self.fails(4, 'OpenColorIO config "no.ocio"', "a scene.pbrt", "--spp", "1000000", OCIO="no.ocio")
        self.fails(2, 'unknown view "nonsense".*"ACES SDR"', "a scene.pbrt", "--view", "nonsense", "--spp", "1000000")
        self.fails(2, 'view "exposure=1"', "a scene.pbrt", "--view", "exposure=1", "--spp", "1000000")

    def test_help_for_machines(self):
        known = json.loads(self.good("help", "--json"))
        perspective = next(p for p in known["plugins"] if p["name"] == "perspective")
        fov = next(p for p in perspective["parameters"] if p["name"] == "fov")
        self.assertEqual((fov["types"], fov["default"], fov["unit"]), (["float"], "90", "degrees"))
        self.assertEqual((fov["range"], fov["maximum"]), ("above 0 and at most 179.999", 179.999))
        self.assertIn("Shape", [s["name"] for s in known["statements"]])

    def test_help_and_version(self):
        overview = self.good("help")
        self.assertEqual(overview, self.good("--help"))
        for word in ("whit [render]", "perfectglass", "skybox", "trianglemesh"):
            self.assertIn(word, overview)
        matte = self.good("help", "material", "matte")
        self.assertRegex(matte, r'"float sigma" or "texture sigma"  \(default 0, degrees\)')
        self.assertIn('"float fov"  (default 90, degrees, above 0 and at most 179.999)\n',
                      self.good("help", "camera", "perspective"))
        # Every vertex is allowed, so no range is printed.
        self.assertIn('"point3 P"  (scene length)\n', self.good("help", "shape", "trianglemesh"))
        self.assertIn("xresolution", self.good("help", "film"))
        self.assertIn("\nTranslate x y z\n", self.good("help", "statement"))
        self.assertIn("tex1", self.good("help", "float", "texture", "scale"))
        self.fails(2, 'did you mean "matte"', "help", "material", "mate")
        self.fails(2, 'did you mean "material"', "help", "materiel")
        self.assertRegex(self.good("--version"), r"^whit \d+\.\d+")
        for command in ("render", "check", "fmt", "explain", "cost", "diff", "bench"):
            self.assertIn("--help", self.good(command, "--help"))


class Rendering(Case):
    def test_names_come_from_the_film(self):
        self.good("a scene.pbrt", "--quiet")
        self.assertEqual(self.files(), ["a scene.pbrt", "film-name.exr", "film-name.png"])

    def test_paths_with_spaces(self):
        os.mkdir(self.path("a folder"))
        self.good("a scene.pbrt", "--quiet", "--outfile", "a folder/a picture.exr")
        self.assertEqual(sorted(os.listdir(self.path("a folder"))), ["a picture.exr", "a picture.png"])

    def test_quiet_is_silent_and_the_summary_is_not(self):
        code, out, err = self.whit("a scene.pbrt")
        self.assertEqual((code, out), (0, ""))
        for what in (r"parse .*, plan .*, build .*, render .*, write ", r"\d+ camera, .* shadow; .* Mrays/s", "peak memory",
                     r"invalid samples 0\b", "film-name.exr", r"film-name.png  \[sRGB"):
            self.assertRegex(err, what)
        self.assertNotIn("\033", err)  # no colour and no cursor movements in a log

    def test_quiet_shows_warnings(self):
        self.write("warns.pbrt", WARNS)
        code, _, err = self.whit("warns.pbrt", "--quiet")
        self.assertEqual(code, 0)
        self.assertRegex(err, r'^warns.pbrt:7:18: warning: sphere has no parameter "raduis"\n')
        self.assertIn('did you mean "radius"?', err)

    def test_equal_messages_are_shown_three_times(self):
        # Lines 7 to 1006, as an exporter with a mistake writes them.
        self.write("many.pbrt", SCENE.replace('  Shape "sphere"\n', '  Shape "sphere" "float raduis" [1] Translate 3 0 0\n' * 1000))
        code, _, err = self.whit("many.pbrt", "--quiet")
        self.assertEqual(code, 0)
        self.assertEqual(re.findall(r"(?m)^many.pbrt:(\d+):18: warning: ", err), ["7", "8", "9"])
        self.assertIn("the same at 997 more places, the last at many.pbrt:1006:18\n", err)
        self.assertTrue(err.endswith("0 errors, 1000 warnings\n"), err)

    def test_a_hundred_messages_are_shown(self):
        names = "".join('  Texture "t%d" "color" "imagemap" "string filename" "%d.png" Material "matte" "texture Kd" "t%d" '
                        'Shape "sphere"\n' % (i, i, i) for i in range(150))
        self.write("many.pbrt", SCENE.replace("  Shape", names + "  Shape"))
        code, _, err = self.whit("many.pbrt", "--quiet")
        self.assertEqual(code, 4)
        self.assertEqual(len(re.findall("error: cannot open", err)), 100)
        self.assertTrue(err.endswith("150 errors, 0 warnings; 50 of them are not shown\n"), err[-300:])

    def test_strict(self):
        self.write("warns.pbrt", WARNS)
        self.fails(3, r"^warns.pbrt:7:18: error: ", "warns.pbrt", "--strict")
        self.good("a scene.pbrt", "--strict", "--quiet")

    def test_keep_going(self):
        self.write("fails.pbrt", FAILS)
        self.fails(3, r"^fails.pbrt:7:\d+: error: ", "fails.pbrt")
        code, _, err = self.whit("fails.pbrt", "--keep-going", "--quiet", "-o", "rest.exr", "--display", "none")
        self.assertEqual(code, 0)
        self.assertRegex(err, r"^fails.pbrt:7:\d+: error: ")
        # What is left is the scene without the sphere.
        self.write("empty.pbrt", SCENE.replace('Shape "sphere"', ""))
        self.assertTrue(self.same("rest.exr", self.picture(scene="empty.pbrt")))
        self.assertFalse(self.same("rest.exr", self.picture(name="whole.exr")))

    def test_a_broken_texture_ends_the_render(self):
        # A picture whose rows are cut off, as a download may leave it, on a sphere that fills a picture of 15625 tiles.
        with open(self.path("broken.pfm"), "wb") as f:
            f.write(b"PF\n64 64\n-1.0\n" + bytes(64 * 64))
        textured = 'Texture "t" "color" "imagemap" "string filename" "broken.pfm" Material "matte" "texture Kd" "t" Shape'
        scene = SCENE.replace("Shape", textured).replace("[40]", "[5]").replace("[32]", "[2000]").replace("[24]", "[2000]")
        self.write("textured.pbrt", scene)
        self.fails(4, "broken.pfm", "textured.pbrt", "--quiet", "--spp", "4000")
        code, _, err = self.whit("textured.pbrt", "--quiet", "--keep-going", "--display", "none", "--quick")
        self.assertEqual(code, 0)
        self.assertIn("broken.pfm", err)

    def test_spp_and_seed(self):
        a = self.picture(name="a.exr")
        self.assertTrue(self.same(a, self.picture("--spp", "2", "--seed", "0", name="b.exr")))
        self.assertFalse(self.same(a, self.picture("--spp", "3", name="c.exr")))
        self.assertFalse(self.same(a, self.picture("--seed", "1", name="d.exr")))
        self.assertTrue(self.same("d.exr", self.picture("--seed=1", name="e.exr")))
        _, _, err = self.whit("a scene.pbrt", "--spp", "3")
        self.assertIn("%d camera" % (3 * 32 * 24), err.replace(" k", "k"))

    def test_nthreads(self):
        for n in ("1", "2"):
            code, _, err = self.whit("a scene.pbrt", "--nthreads", n)
            self.assertEqual(code, 0)
            self.assertIn("on %s thread%s." % (n, "" if n == "1" else "s"), err)

    def test_quick(self):
        # A quarter of the resolution each way, one sample per pixel.
        self.assertEqual(exr_windows(self.path(self.picture("--quick")))[0], (0, 0, 7, 5))
        _, _, err = self.whit("a scene.pbrt", "--quick")
        self.assertIn("%d camera" % (8 * 6), err)
        self.assertIn("1 samples per pixel", err)

    def test_crop_windows_in_all_spellings(self):
        # x from 0.25 * 32 = 8 to 0.5 * 32 = 16, y from 0.5 * 24 = 12 to 24; ends excluded.
        pictures = []
        for i, flags in enumerate((["a scene.pbrt", "--cropwindow", "0.25", ".5", "0.5", "1"],
                                   ["--cropwindow", "0.25", ".5", "0.5", "1", "a scene.pbrt"],
                                   ["--cropwindow", "0.25,0.5,0.5,1", "a scene.pbrt"],
                                   ["--cropwindow=0.25,0.5,0.5,1", "a scene.pbrt"],
                                   ["a scene.pbrt", "--cropwindow=0.25", "0.5", "0.5", "1"])):
            with self.subTest(flags=flags):
                pictures.append("crop%d.exr" % i)
                self.good(*flags, "--quiet", "--display", "none", "-o", pictures[-1])
                self.assertEqual(exr_windows(self.path(pictures[-1])), ((8, 12, 15, 23), (0, 0, 31, 23)))
                self.assertTrue(self.same(pictures[0], pictures[-1]))

    def test_pixel(self):
        for i, flags in enumerate((["a scene.pbrt", "--pixel", "3,4"], ["--pixel", "3,4", "a scene.pbrt"],
                                   ["--pixel=3,4", "a scene.pbrt"], ["--pixel", "3", "4", "a scene.pbrt"])):
            with self.subTest(flags=flags):
                self.good(*flags, "--quiet", "--display", "none", "-o", "pixel%d.exr" % i)
                self.assertEqual(exr_windows(self.path("pixel%d.exr" % i)), ((3, 4, 3, 4), (0, 0, 31, 23)))

    def test_debug_pixel(self):
        for asked in ("16,12,1", "16,12"):
            before = self.files()
            account = self.good("a scene.pbrt", "--debug-pixel", asked)
            self.assertRegex(account, r"^sample \d of pixel 16,12: film position ")
            self.assertRegex(account, r"meets the shape of a scene.pbrt:7:3 at distance 4\.")
            self.assertRegex(account, r"(?m)^radiance \[[^]]*\], luminance [0-9.]+$")
            self.assertEqual(self.files(), before)
        self.fails(2, "--debug-pixel: there are pixels 0,0 to 31,23 with samples 0 to 1", "a scene.pbrt",
                   "--debug-pixel", "16,12,2")
        for wrong in ("16", "16,12,0,0", "16,,1", "1.5,2", "x"):
            self.fails(2, "--debug-pixel needs x,y or x,y,sample, like 320,240,7", "a scene.pbrt", "--debug-pixel", wrong)

    def test_an_invalid_sample_is_located(self):
        self.write("b.pbrt", SCENE.replace("WorldBegin", 'WorldBegin LightSource "infinite" "rgb L" [-9 1 1]'))
        code, _, err = self.whit("b.pbrt", "--quiet", "--display", "none", "--outfile", "out.exr", "--pixel", "3,4")
        self.assertEqual(code, 0)
        self.assertRegex(err, "2 samples were not valid .*; the first is sample 0 of pixel 3,4 "
                              r"\(--debug-pixel 3,4,0 tells how it comes about\)")
        self.assertIn("not a valid sample", self.good("b.pbrt", "--debug-pixel", "3,4,0"))

    def test_several_worlds_in_one_file(self):
        second = SCENE.replace("film-name", "second").replace('Shape "sphere"', 'Shape "disk"')
        self.write("two.pbrt", SCENE.replace("film-name", "first") + second)
        self.write("second.pbrt", second)
        self.good("two.pbrt", "--quiet")
        self.assertTrue(self.same("first.exr", self.picture(name="x.exr")))
        self.assertTrue(self.same("second.exr", self.picture(name="y.exr", scene="second.pbrt")))
        self.assertFalse(self.same("first.exr", "second.exr"))

    def test_several_scenes(self):
        self.write("b.pbrt", SCENE.replace("film-name", "b"))
        self.good("a scene.pbrt", "b.pbrt", "--quiet", "--display", "none")
        self.assertTrue(self.same("film-name.exr", "b.exr"))

    def test_standard_input(self):
        expected = self.picture(name="expected.exr")
        self.good("--quiet", stdin=SCENE)
        self.assertTrue(self.same("film-name.exr", expected))
        self.good("-", "--quiet", "-o", "x.exr", stdin=SCENE)
        self.assertTrue(self.same("x.exr", expected))
        _, err = self.fails(3, r"^<stdin>:7:\d+: error: ", "--quiet", stdin=FAILS)
        self.assertIn("radius", err)
        self.fails(3, "error: ", "--quiet", stdin="")

    def test_formats(self):
        magic = {"exr": b"\x76\x2f\x31\x01", "png": b"\x89PNG\r\n\x1a\n", "pfm": b"PF\n32 24\n", "jpg": b"\xff\xd8\xff",
                 "jpeg": b"\xff\xd8\xff", "tif": b"II*\0", "tiff": b"II*\0",
                 "tga": b"\0\0"}  # no identification, no palette; then 2 or 10: true colour
        for extension, start in magic.items():
            with self.subTest(extension=extension):
                self.good("a scene.pbrt", "--quiet", "-o", "picture." + extension)
                data = self.bytes("picture." + extension)
                self.assertEqual(data[:len(start)], start)
                if extension == "tga":
                    self.assertIn(data[2], (2, 10))
                    self.assertEqual(struct.unpack("<HH", data[12:16]), (32, 24))
                # A display picture appears beside a linear one only.
                others = [f for f in self.files() if f.startswith("picture.") and not f.endswith(extension)]
                self.assertEqual(others, ["picture.png"] if extension in ("exr", "pfm") else [])
                for f in ["picture." + extension] + others:
                    os.remove(self.path(f))

    def test_half_and_float(self):
        half, full = self.picture(name="half.exr"), self.picture("--type", "float", name="float.exr")
        # A half has 11 bits: a relative error of up to 2^-11 each; the mean square is below its square.
        code, out, _ = self.whit("diff", half, full, "--json")
        self.assertEqual(code, 0)
        self.assertLess(json.loads(out)["measures"]["relmse"], 2.0 ** -22)
        self.assertGreater(json.loads(out)["differing_pixels"], 0)
        # Three channels of 2 (1: half) or 4 (2: float) bytes; the type follows each channel's name in the header.
        for name, kind in (("half.exr", b"\1"), ("float.exr", b"\2")):
            self.assertIn(b"R\0" + kind + b"\0\0\0", self.bytes(name)[:4096])

    def test_metadata(self):
        header = self.bytes(self.picture("--seed", "5"))[:8192]
        for what in (b"whit:command", b"whit a scene.pbrt --seed 5", b"whit:samplesPerPixel", b"whit:scene", b"Software"):
            self.assertIn(what, header)

    def test_equal_renders_are_equal_files(self):
        # What differs from run to run is in --stats. Where the files go, how many threads there are and what is said of it
        # makes no difference to a picture.
        self.good("a scene.pbrt", "--outfile", "one.exr", "--aov", "variance,N", "--quiet", "--nthreads", "1")
        self.good("a scene.pbrt", "-o", "two.exr", "--display", "other.png", "--aov", "variance,N", "--quiet",
                  "--stats", "s.json")
        self.assertEqual(self.bytes("one.exr"), self.bytes("two.exr"))
        self.assertEqual(self.bytes("one.png"), self.bytes("other.png"))
        with open(self.path("s.json"), encoding="utf-8") as f:
            stats = json.load(f)
        self.assertIn("--display other.png", stats["settings"]["command"])
        self.assertGreater(stats["seconds"]["render"], 0)

    def test_every_seed_is_in_the_header(self):
        # Up to the largest of 32 bits, as text: an OpenEXR attribute is name, type, length and value.
        for seed in (b"0", b"2147483648", b"4294967295"):
            self.good("a scene.pbrt", "--quiet", "--seed", seed.decode())
            self.assertIn(b"whit:seed\0string\0" + len(seed).to_bytes(4, "little") + seed,
                          self.bytes("film-name.exr")[:8192])
            self.assertIn(b"whit:seed\0" + seed, self.bytes("film-name.png")[:8192])
        self.fails(2, "--seed", "a scene.pbrt", "--seed", "4294967296")

    def test_views_and_exposure_change_the_display_picture_only(self):
        def pair(*flags):
            self.good("a scene.pbrt", "--quiet", "-o", "v.exr", *flags)
            shutil.copy(self.path("v.exr"), self.path("linear.exr"))
            return self.bytes_of_pixels("v.png")
        self.picture(name="plain.exr")
        plain = pair()
        seen = {plain}
        for flags in (["--view", "ACES SDR"], ["--view", "exposure=0.6"], ["--exposure", "1"], ["--exposure=-1"]):
            seen.add(pair(*flags))
            self.assertTrue(self.same("linear.exr", "plain.exr"), flags)
        self.assertEqual(len(seen), 5)
        self.assertEqual(pair("--view", "sRGB"), plain)
        self.assertEqual(pair("--exposure", "0"), plain)
        # The film may say so, too; the flag wins.
        self.write("film.pbrt", SCENE.replace('"string filename"', '"string view" ["exposure=0.6"] "string filename"'))
        self.good("film.pbrt", "--quiet", "-o", "f.png")
        self.assertEqual(self.bytes_of_pixels("f.png"), self.bytes_of_pixels_after("--view", "exposure=0.6"))

    def bytes_of_pixels_after(self, *flags):
        self.good("a scene.pbrt", "--quiet", "-o", "g.png", *flags)
        return self.bytes_of_pixels("g.png")

    def bytes_of_pixels(self, name):
        """The IDAT chunks of a PNG: everything but its metadata, which names the command."""
        data, at, pixels = self.bytes(name), 8, b""
        while at < len(data):
            length, kind = struct.unpack(">I4s", data[at:at + 8])
            pixels += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
            at += 12 + length
        return pixels

    def test_an_ocio_config_is_used(self):
        self.write("identity.ocio", """ocio_profile_version: 2
roles: {default: raw, scene_linear: raw}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays: {screen: [!<View> {name: Straight, colorspace: raw}]}
active_displays: [screen]
active_views: [Straight]
colorspaces: [!<ColorSpace> {name: raw, isdata: false}]
""")
        plain = self.bytes_of_pixels_after()
        self.assertNotEqual(self.bytes_of_pixels_after("--ocio", "identity.ocio"), plain)
        self.good("a scene.pbrt", "--quiet", "-o", "e.png", OCIO="identity.ocio")
        self.assertEqual(self.bytes_of_pixels("e.png"), self.bytes_of_pixels_after("--ocio", "identity.ocio"))

    def test_no_torn_files_are_left(self):
        self.picture()
        self.assertEqual(self.files(), ["a scene.pbrt", "out.exr"])


class Commands(Case):
    def test_check(self):
        self.assertEqual(self.good("check", "a scene.pbrt"), "")
        self.good("check", stdin=SCENE)
        self.write("warns.pbrt", WARNS)
        self.fails(1, r"^warns.pbrt:7:18: warning: ", "check", "warns.pbrt")
        self.write("both.pbrt", FAILS.replace("WorldEnd", '  Shape "sphere" "float raduis" [1]\nWorldEnd'))
        _, err = self.fails(1, r"both.pbrt:7:\d+: error: ", "check", "both.pbrt")
        self.assertRegex(err, r"both.pbrt:8:\d+: warning: ")
        self.assertIn("1 error, 1 warning", err)

    def test_explain(self):
        said = self.good("explain", "a scene.pbrt")
        self.assertRegex(said, r"(?m)^  delta-lights .*\n      for point at a scene.pbrt:6:3$")
        worlds = json.loads(self.good("explain", "--json", stdin=SCENE + SCENE))["worlds"]
        self.assertEqual(len(worlds), 2)
        self.assertEqual([e["effect"] for e in worlds[0]["effects"] if e["on"]], ["diffuse", "delta-lights", "shadows"])
        unused = SCENE.replace("WorldBegin", 'WorldBegin\n  Texture "t" "spectrum" "checkerboard"')
        self.write("unused.pbrt", unused)
        self.assertIn('left out\n  texture "t" at unused.pbrt:6:3: no visible surface uses it\n', self.good("explain", "unused.pbrt"))

    def test_bench_of_reading(self):
        figures = json.loads(self.good("bench", "--only", "ingestion", "--runs", "3", "--text-mb", "2", "--json"))
        self.assertEqual(figures["scenes"], [])
        figures = figures["ingestion"]
        self.assertGreater(figures["text_megabytes"], 2)
        for name in ("text_mb_per_s", "ply_mb_per_s", "build_mtris_per_s"):
            low, high = figures[name + "_spread"]
            self.assertTrue(0 < low <= figures[name] <= high, name)
        self.assertRegex(self.good("bench", "--only", "ingestion", "--runs", "1", "--text-mb", "2"),
                         r"(?s)\d MB/s .*\d MB/s .*\d Mtri/s ")

    def test_bench_writes_its_scenes(self):
        self.assertEqual(self.good("bench", "--only", "cornell,path", "--write", "scenes").splitlines(),
                         ["scenes/cornell.pbrt", "scenes/path.pbrt"])
        self.good("check", "scenes/cornell.pbrt", "scenes/path.pbrt")
        self.fails(4, "cannot write", "bench", "--only", "path", "--write", "scenes/path.pbrt/no")

    def test_bench_of_a_scene(self):
        self.fails(2, "nosuch not in", "bench", "--only", "nosuch")
        self.write("small.pbrt", SCENE)
        report = json.loads(self.good("bench", "small.pbrt", "--only", "ingestion", "--runs", "1", "--text-mb", "2", "--json"))
        scene, = report["scenes"]
        self.assertEqual((scene["name"], scene["invalid_samples"]), ("small.pbrt", 0))
        # A render takes its rays' time and more; the stages are shares of a whole.
        self.assertGreater(scene["floor_ratio"], 1)
        self.assertAlmostEqual(sum(scene["stages"].values()), 1, places=6)
        self.assertEqual(scene["floor"]["camera"]["rays"], scene["camera_samples"])
        self.assertGreater(scene["camera_samples_per_s_per_core"], 0)

    def test_fmt_and_cat(self):
        self.write("messy.pbrt", SCENE.replace("  ", "\t\t ").replace("[2]", "2 # two"))
        once = self.good("fmt", "messy.pbrt")
        self.assertEqual(self.good("fmt", stdin=once), once)
        self.assertIn("# two", once)
        self.assertEqual(self.good("--cat", "messy.pbrt"), once)
        self.assertEqual(self.good("--cat", stdin=once), once)
        self.assertEqual(self.good("fmt", "--in-place", "messy.pbrt"), "")
        self.assertEqual(self.bytes("messy.pbrt").decode(), once)
        # It means the same.
        self.assertTrue(self.same(self.picture(), self.picture(name="formatted.exr", scene="messy.pbrt")))
        before = self.write("broken.pbrt", "WorldBegin\nSpheer\n")
        self.fails(3, r"broken.pbrt:2:", "fmt", "--in-place", before)
        self.assertEqual(self.bytes("broken.pbrt"), b"WorldBegin\nSpheer\n")
        self.fails(2, "--in-place needs a file", "fmt", "--in-place")

    def test_cat_expands_includes_and_fmt_does_not(self):
        self.write("part.pbrt", 'Shape "disk"\n')
        self.write("whole.pbrt", SCENE.replace('Shape "sphere"', 'Include "part.pbrt"'))
        self.assertIn('Include "part.pbrt"', self.good("fmt", "whole.pbrt"))
        self.assertRegex(self.good("--cat", "whole.pbrt"), r'(?m)^ *Shape "disk"$')

    def test_toply(self):
        mesh = ('Shape "trianglemesh" "integer indices" [%s] "point P" [%s]'
                % (" ".join("%d %d %d" % (i, i + 1, i + 2) for i in range(998)),
                   " ".join("%g %g 0" % (i * 0.001, (i % 2) * 0.5) for i in range(1000))))
        self.write("mesh.pbrt", SCENE.replace('Shape "sphere"', mesh))
        text = self.good("--toply", "mesh.pbrt")
        self.assertIn('Shape "plymesh"', text)
        self.assertLess(len(text), 2000)
        self.write("with-ply.pbrt", text)
        self.assertTrue(self.same(self.picture(scene="mesh.pbrt"), self.picture(name="ply.exr", scene="with-ply.pbrt")))

    def test_no_colour_in_a_log(self):
        _, _, err = self.whit("check", stdin=WARNS)
        self.assertNotIn("\033", err)
        self.assertTrue(re.search(r"\n +\^", err), err)


if __name__ == "__main__":
    unittest.main()
