"""whit merge: parts of a picture, by samples, pixels or both, are bit by bit the picture of a single render; what cannot be
joined is named. Parts are made by --sample-range and --crop-pixels, which are tested here too."""
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python"))
from parts_scene import GAUSSIAN, LAYERS, LOOK, WORLD  # noqa: E402
from viewer import Viewer  # noqa: E402

WHIT = os.environ.get("WHIT", "")

# With a filter as is wanted; 41 x 27 pixels: no multiple of a tile.
SCENE = """Film "image" "integer xresolution" [41] "integer yresolution" [27] "string filename" "picture.exr"
""" + LOOK + """Sampler "%(sampler)s" "integer pixelsamples" [%(samples)d]
%(options)s
""" + WORLD
SINC = 'PixelFilter "sinc" "float xwidth" [3] "float ywidth" [3]'  # with negative weights


@unittest.skipUnless(WHIT, "the program is not built")
class Merge(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.write()

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, sampler="halton", samples=16, options=""):
        with open(self.path("scene.pbrt"), "w", encoding="utf-8") as f:
            f.write(SCENE % {"sampler": sampler, "samples": samples, "options": options})

    def whit(self, *args, code=0, folder=None):
        done = subprocess.run([WHIT, *args], cwd=folder or self.folder, capture_output=True, text=True, timeout=300,
                              check=False, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def render(self, *args, code=0):
        return self.whit("scene.pbrt", "--display", "none", "--quiet", *args, code=code)

    def part(self, name, *args):
        self.render("--checkpoint", name, "--outfile", name + ".exr", *args)
        return name

    def merge(self, *args, code=0):
        return self.whit("merge", "--quiet", "--display", "none", *args, code=code)

    def same_files(self, first, second):
        with open(self.path(first), "rb") as a, open(self.path(second), "rb") as b:
            return a.read() == b.read()

    def test_parts_are_the_picture_of_one_render(self):
        # Whole files are compared: pixels, layers, what the header says. The ranges' ends are no round numbers.
        cases = [("halton", 16, "", LAYERS), ("sobol", 16, GAUSSIAN, LAYERS), ("random", 19, SINC, []),
                 ("stratified", 16, GAUSSIAN, ["--type", "float"])]
        for sampler, samples, options, flags in cases:
            with self.subTest(sampler=sampler, options=options):
                self.write(sampler, samples, options)
                self.render("--outfile", "whole.exr", *flags)
                parts = [self.part("a", "--sample-range", "0:5", "--crop-pixels", "0", "41", "0", "10", *flags),
                         self.part("b", "--sample-range", "5:", "--crop-pixels", "0", "41", "0", "10", *flags),
                         self.part("c", "--crop-pixels", "0,17,10,27", *flags),
                         self.part("d", "--sample-range", ":11", "--crop-pixels", "17", "41", "10", "27", *flags),
                         self.part("e", "--sample-range", "11:12", "--crop-pixels", "17", "41", "10", "27", *flags),
                         self.part("f", "--sample-range", f"12:{samples}", "--crop-pixels=17,41,10,27", *flags)]
                self.merge(*reversed(parts), "--outfile", "merged.exr")
                self.assertTrue(self.same_files("merged.exr", "whole.exr"))

    def test_many_parts_of_a_filter_that_reaches_far(self):
        self.write("random", 16, GAUSSIAN)
        self.render("--outfile", "whole.exr")
        parts = [self.part(f"{s}-{x}", "--sample-range", f"{s}:{s + 1}", "--crop-pixels", str(x), str(min(x + 9, 41)), "0", "27")
                 for s in range(16) for x in range(0, 41, 9)]
        self.merge(*parts, "--outfile", "merged.exr", "--nthreads", "1")
        self.assertTrue(self.same_files("merged.exr", "whole.exr"))

    def test_a_part_is_a_picture_of_its_samples(self):
        # Without --checkpoint too. The mean of both halves is the whole's, but for three roundings of floats.
        def picture(name):
            with open(self.path(name), "rb") as f:
                data = f.read()
            import array
            values = array.array("f")
            values.frombytes(data[data.index(b"-1.0\n") + 5:])
            return values
        self.render("--outfile", "whole.pfm")
        self.render("--outfile", "first.pfm", "--sample-range", "0:8")
        self.render("--outfile", "second.pfm", "--sample-range", "8:16")
        for whole, first, second in zip(*map(picture, ("whole.pfm", "first.pfm", "second.pfm"))):
            self.assertAlmostEqual(whole, (first + second) / 2, delta=4 * 2**-24 * max(whole, 1e-30))

    def test_pixels_are_the_cropwindow_of_them(self):
        self.render("--outfile", "pixels.pfm", "--crop-pixels", "10", "20", "5", "6")
        self.render("--outfile", "window.pfm", "--cropwindow", str(9.5 / 41), str(19.5 / 41), str(4.5 / 27), str(5.5 / 27))
        self.assertEqual(os.path.getsize(self.path("pixels.pfm")), len(b"PF\n10 1\n-1.0\n") + 10 * 3 * 4)
        self.assertTrue(self.same_files("pixels.pfm", "window.pfm"))

    def test_a_part_that_was_killed_goes_on(self):
        self.render("--outfile", "whole.exr")
        part = self.part("a", "--sample-range", "0:9")
        self.render("--resume", "a", "--outfile", "a.exr", "--sample-range", "0:9")  # of one that has ended: nothing to do
        self.assertIn("--sample-range was 0:9 and is none", self.render("--resume", "a", code=2))
        self.merge(part, self.part("b", "--sample-range", "9:16"), "--outfile", "merged.exr")
        self.assertTrue(self.same_files("merged.exr", "whole.exr"))

    def test_from_another_folder_and_after_a_move(self):
        self.render("--outfile", "whole.exr")
        a, b = self.part("a", "--sample-range", "0:9"), self.part("b", "--sample-range", "9:16")
        other = self.path("other")
        os.mkdir(other)
        self.whit("merge", "../a", "../b", "--quiet", "--display", "none", "--outfile", "../merged.exr", folder=other)
        os.rename(self.path("scene.pbrt"), self.path("moved.pbrt"))
        said = self.merge(a, b, code=4)
        self.assertIn("scene.pbrt", said)
        self.merge(a, b, "--scene", "moved.pbrt", "--outfile", "moved.exr")
        with open(self.path("moved.pbrt"), "a", encoding="utf-8") as f:
            f.write("# a change\n")
        said = self.merge(a, b, "--scene", "moved.pbrt", "--outfile", "changed.exr", code=2)
        self.assertIn("the scene's text is another one", said)

    def test_what_cannot_be_joined_is_named(self):
        a, b, c = (self.part(n, "--sample-range", r) for n, r in (("a", "0:4"), ("b", "4:10"), ("c", "8:16")))
        top = self.part("top", "--crop-pixels", "0", "41", "0", "9")
        rest = self.part("rest", "--crop-pixels", "0", "41", "8", "27")
        left = self.part("left", "--crop-pixels", "0", "9", "9", "27")
        seed = self.part("seed", "--seed", "7", "--sample-range", "4:16")
        layers = self.part("layers", "--aov", "N", "--sample-range", "4:16")
        self.render("--target-error", "50%", "--checkpoint", "target", "--outfile", "t.exr")
        with open(self.path("a"), "rb") as f:
            data = f.read()
        with open(self.path("cut"), "wb") as f:
            f.write(data[:-9])
        with open(self.path("flipped"), "wb") as f:
            f.write(data[:400] + bytes([data[400] ^ 1]) + data[401:])
        for parts, code, words in (
                ([a], 2, r'samples 4 to 15 of 16 are in no part of pixels 0 to 40 of rows 0 to 26: --sample-range 4:16'),
                ([b, a], 2, r'samples 10 to 15 of 16 are in no part'),
                ([a, c], 2, r'samples 4 to 7 of 16 are in no part'),
                ([a, b, c], 2, r'samples 8 to 9 of pixels .* are in "b" and in "c"'),
                ([a, a], 2, r'samples 0 to 3 of pixels .* are in "a" and in "a"'),
                ([top], 2, r'pixels 0 to 40 of rows 9 to 26 are in no part: --crop-pixels 0 41 9 27 renders them'),
                ([top, left], 2, r'pixels 9 to 40 of rows 9 to 26 are in no part: --crop-pixels 9 41 9 27'),
                ([top, rest], 2, r'"top" has pixels 0 to 40 of rows 0 to 8, and "rest" has .*: they overlap'),
                ([a, seed], 2, r'"a" and "seed" are of different renders: --seed was none and is 7'),
                ([a, layers], 2, r'different renders: --aov was none and is N'),
                (["target"], 2, r'"target" is of a render to an accuracy'),
                ([a, "cut"], 4, r'cannot join "cut": it is damaged'),
                ([a, "flipped"], 4, r'cannot join "flipped": it is damaged'),
                ([a, "scene.pbrt"], 4, r'cannot join "scene.pbrt": it is no checkpoint'),
                ([a, "nothing"], 4, r'cannot join "nothing": No such file'),
                ([], 2, "parts")):
            with self.subTest(parts=parts):
                self.assertRegex(self.merge(*parts, "--outfile", "none.exr", code=code), words)
                self.assertFalse(os.path.exists(self.path("none.exr")))

    def leave_unfinished(self, *flags):
        """The checkpoint "unfinished" of a render that was killed."""
        process = subprocess.Popen([WHIT, "scene.pbrt", "--spp", "1000000", "--checkpoint", "unfinished", "--every", "0.05s",
                                    *flags, "--quiet"], cwd=self.folder)
        try:
            while not os.path.exists(self.path("unfinished")):
                self.assertIsNone(process.poll())
        finally:
            process.kill()
            process.wait()

    def test_parts_that_have_not_ended(self):
        self.leave_unfinished("--display", "none")
        self.assertIn('"unfinished" is of a render that has not ended; its command with --resume unfinished goes on with it',
                      self.merge("unfinished", code=2))

    def test_flags_that_make_no_sense(self):
        for flags, words in (
                (["--sample-range", "4"], "is no range"), (["--sample-range", "a:b"], "is no range"),
                (["--sample-range", ":"], "is no range"), (["--sample-range", "-1:4"], "is no range"),
                (["--sample-range", "4:4"], "none of the 16 samples of a pixel, which are 0:16"),
                (["--sample-range", "9:17"], "none of the 16 samples"),
                (["--sample-range", "16:"], "none of the 16 samples"),
                (["--sample-range", "0:4", "--target-error", "1%"], "how far to go"),
                (["--sample-range", "0:4", "--debug-pixel", "1,1"], "no picture"),
                (["--crop-pixels", "0", "42", "0", "27"], "the picture has 41 x 27 pixels"),
                (["--crop-pixels", "5", "5", "0", "27"], "x0 < x1"), (["--crop-pixels", "-1", "5", "0", "27"], "0 <= x0"),
                (["--crop-pixels", "0", "5", "0", "7", "--pixel", "1,1"], "one of them will do")):
            with self.subTest(flags=flags):
                self.assertIn(words, self.render(*flags, code=2))

    def test_what_is_there_so_far(self):
        # Rows 0 to 9 have 9 of 16 samples, the last pixels of the others 1, and all others none: a picture of each part has
        # the same bits where it is, and there is black where there is none.
        names = [self.part("a", "--sample-range", "3:12", "--crop-pixels", "0", "41", "0", "10"),
                 self.part("b", "--sample-range", "15:16", "--crop-pixels", "30", "41", "10", "27")]
        said = self.whit("merge", *names, "--so-far", "--outfile", "so-far.pfm", "--display", "none")
        share = 100 * (9 * 41 * 10 + 11 * 17) / (16 * 41 * 27)
        self.assertIn(f"{share:.3g} % of the samples are there, the rest is in no part", said)
        self.merge("a", "--so-far", "--outfile", "a.pfm"), self.merge("b", "--so-far", "--outfile", "b.pfm")
        pictures = [self.pixels(n) for n in ("so-far.pfm", "a.pfm", "b.pfm")]
        self.render("--outfile", "c.pfm", "--sample-range", "3:12", "--crop-pixels", "0", "41", "0", "10")
        # A .pfm begins with the lowest row.
        self.assertEqual(pictures[1][3 * 41 * 17:], self.pixels("c.pfm"))
        for together, a, b in zip(*pictures):
            self.assertIn(together, (a, b))
            self.assertIn(0, (a, b))

    def test_parts_between_which_samples_are_missing_so_far(self):
        # The mean of samples 0 to 3 and 12 to 15 is that of both halves, but for three roundings of floats.
        names = [self.part("a", "--sample-range", "0:4"), self.part("b", "--sample-range", "12:16")]
        self.merge(*names, "--so-far", "--outfile", "both.pfm"), self.merge("a", "--so-far", "--outfile", "a.pfm")
        self.merge("b", "--so-far", "--outfile", "b.pfm")
        for both, a, b in zip(*(self.pixels(n) for n in ("both.pfm", "a.pfm", "b.pfm"))):
            self.assertAlmostEqual(both, (a + b) / 2, delta=4 * 2**-24 * max(both, 1e-30))
        self.merge("b", "--so-far", "--outfile", "b.exr")
        with open(self.path("b.exr"), "rb") as f:
            self.assertIn(b"25 % of the samples are there", f.read())
        # What overlaps is refused as ever, and all of it together is the whole, header and all.
        self.assertRegex(self.merge("a", "a", "--so-far", "--outfile", "n.exr", code=2), 'are in "a" and in "a"')
        self.render("--outfile", "whole.exr")
        self.merge(*names, self.part("c", "--sample-range", "4:12"), "--so-far", "--outfile", "merged.exr")
        self.assertTrue(self.same_files("merged.exr", "whole.exr"))

    def test_a_part_that_has_not_ended_so_far(self):
        self.leave_unfinished("--outfile", "none")
        self.merge("unfinished", "--so-far", "--outfile", "so-far.pfm")
        self.assertGreater(max(self.pixels("so-far.pfm")), 0)

    def test_a_viewer_sees_what_is_there(self):
        viewer = Viewer()
        self.addCleanup(viewer.close)
        flags = ["--so-far", "--outfile", "none", "--display-server", viewer.address]
        self.merge(self.part("a", "--sample-range", "0:4"), *flags)
        self.merge("a", self.part("b", "--sample-range", "12:16"), *flags, "--shown")
        self.assertEqual(viewer.made, [("scene.pbrt", 41, 27)])  # the second found it there
        self.assertEqual([u[:2] for u in viewer.updates], [(c, (0, 0, 41, 27)) for c in "RGBRGB"])
        self.merge("a", "b", "--so-far", "--outfile", "both.pfm")
        rows = self.pixels("both.pfm")
        red = [rows[3 * (41 * y + x)] for y in range(26, -1, -1) for x in range(41)]
        self.assertEqual(list(struct.unpack("<1107f", viewer.updates[3][2])), red)
        self.assertIn("none is named", self.merge("a", "b", "--so-far", "--shown", code=2))
        said = self.merge("a", "b", "--so-far", "--outfile", "none", "--display-server", "127.0.0.1:9")
        self.assertIn("warning: cannot reach display server 127.0.0.1:9", said)

    def pixels(self, name):
        with open(self.path(name), "rb") as f:
            data = f.read()
        data = data[data.index(b"-1.0\n") + 5:]
        return list(struct.unpack(f"<{len(data) // 4}f", data))

    def test_no_picture(self):
        before = set(os.listdir(self.folder))
        self.render("--outfile", "none", "--checkpoint", "a", "--aov", "N", "--sample-range", "0:4")
        self.render("--outfile", "none", "--stats=-")
        self.assertEqual(set(os.listdir(self.folder)) - before, {"a"})
        self.assertIn("nothing would come of it", self.render("--outfile", "none", code=2))
        # Where the state cannot be kept either there is nothing to show for the render: /dev/full takes no file.
        self.render("--outfile", "none", "--checkpoint", "/dev/full/a", code=4)

    def test_figures_are_of_all_parts(self):
        self.render("--stats=whole.json", "--outfile", "whole.exr")
        a, b = self.part("a", "--sample-range", "0:9"), self.part("b", "--sample-range", "9:16")
        self.merge(a, b, "--outfile", "merged.exr", "--stats", "merged.json")
        def figures(name):
            with open(self.path(name), encoding="utf-8") as f:
                return json.load(f)
        whole, merged = figures("whole.json"), figures("merged.json")
        self.assertEqual(re.sub(r"\s", "", json.dumps(merged["rays"])), re.sub(r"\s", "", json.dumps(whole["rays"])))


if __name__ == "__main__":
    unittest.main()
