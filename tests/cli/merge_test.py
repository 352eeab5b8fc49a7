"""whit merge: parts of a picture, by samples, pixels or both, are bit by bit the picture of a single render; what cannot be
joined is named. Parts are made by --sample-range and --crop-pixels, which are tested here too."""
import json
import os
import re
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT", "")

# Shadows of a lamp, glass, two things of one name, a filter as is wanted; 41 x 27 pixels: no multiple of a tile.
SCENE = """Film "image" "integer xresolution" [41] "integer yresolution" [27] "string filename" "picture.exr"
LookAt 0 2 -6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [45]
Sampler "%(sampler)s" "integer pixelsamples" [%(samples)d]
%(options)s
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [20 18 15] "string lightgroup" "lamp"
  Translate 1 4 -2
  Rotate 90 1 0 0
  Shape "disk" "float radius" [0.7]
AttributeEnd
Material "matte" "rgb Kd" [0.5 0.6 0.7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-5 0 -5 5 0 -5 5 0 5 -5 0 5]
Translate 0 1 0
Material "glass"
Shape "sphere"
Translate 2 0 1
Material "plastic"
Shape "sphere"
WorldEnd
"""
GAUSSIAN = 'PixelFilter "gaussian" "float xwidth" [2] "float ywidth" [2]'
SINC = 'PixelFilter "sinc" "float xwidth" [3] "float ywidth" [3]'  # with negative weights
LAYERS = ["--aov", "albedo,N,Z,shape,material,variance,samples,lightgroups"]


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

    def test_parts_that_have_not_ended(self):
        process = subprocess.Popen([WHIT, "scene.pbrt", "--spp", "1000000", "--checkpoint", "unfinished", "--every", "0.05s",
                                    "--display", "none", "--quiet"], cwd=self.folder)
        try:
            while not os.path.exists(self.path("unfinished")):
                self.assertIsNone(process.poll())
        finally:
            process.kill()
            process.wait()
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
