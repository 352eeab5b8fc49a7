#!/usr/bin/env python3
"""`--denoise`: what is said where there is no library, which second picture is written, that the first stays as it is, and
what `diff` and `cost` say of it. A stand-in for the library (denoiser_stand_in.c) is compiled for most of it; what the
library itself makes is tested where it is installed."""
import os
import shutil
import subprocess
import tempfile
import unittest

try:
    import numpy as np
    import OpenImageIO as oiio
except ImportError:
    print("python3-numpy and python3-openimageio are needed (tools/install-deps test)")
    raise SystemExit(77)

HERE = os.path.dirname(os.path.abspath(__file__))
WHIT = os.environ.get("WHIT")

# A ball under a wide lamp, sampled at random: there is noise, and there are pixels without a surface.
SCENE = """\
Film "image" "integer xresolution" [64] "integer yresolution" [48]
Sampler "random" "integer pixelsamples" [4]
PixelFilter "box"
LookAt 0 1 6  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
  AttributeBegin
    AreaLightSource "diffuse" "rgb L" [8 8 8]
    Translate 0 4 1
    Rotate 90 1 0 0
    Shape "disk" "float radius" [1]
  AttributeEnd
  Material "matte" "rgb Kd" [0.6 0.3 0.2]
  Shape "sphere" "float radius" [1]
  Translate 0 -1 0
  Rotate -90 1 0 0
  Shape "disk" "float radius" [3]
WorldEnd
"""


def pixels(path):
    """Values by channel, and the header's entries."""
    image = oiio.ImageInput.open(path)
    spec = image.spec()
    values = image.read_image(oiio.FLOAT)
    image.close()
    return ({name: values[:, :, c] for c, name in enumerate(spec.channelnames)},
            {a.name: a.value for a in spec.extra_attribs})


def stand_in(folder, *flags):
    """The stand-in's file; None where there is no compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if not compiler:
        return None
    library = os.path.join(folder, "libOpenImageDenoise.so.%d" % (1 + len(flags)))
    subprocess.run([compiler, "-shared", "-fPIC", *flags, "-o", library, HERE + "/denoiser_stand_in.c"], check=True)
    return library


class Denoise(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory(prefix="whit denoise ")
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = scratch.name
        with open(cls.folder + "/scene.pbrt", "w", encoding="utf-8") as f:
            f.write(SCENE)
        # Not where the program runs: the loader may look there.
        cls.stand_ins = os.path.join(cls.folder, "stand-ins")
        os.makedirs(cls.stand_ins)
        cls.library = stand_in(cls.stand_ins)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_whit(self, *arguments, code=0, **environment):
        done = subprocess.run([WHIT, *arguments], capture_output=True, text=True, check=False, cwd=self.folder, timeout=120,
                              env={**os.environ, **environment})
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def render(self, *arguments, wants="color", code=0, library=None):
        library = library or self.library
        if not library:
            self.skipTest("no C compiler for the stand-in")
        return self.run_whit("scene.pbrt", "--denoise", *arguments, code=code, WHIT_OIDN=library, STAND_IN=wants)

    def test_without_the_library_nothing_is_rendered(self):
        for named in (self.path("none"), self.folder + "/empty"):
            os.makedirs(self.folder + "/empty", exist_ok=True)
            said = self.run_whit("scene.pbrt", "--denoise", "-o", "never.exr", code=2, WHIT_OIDN=named)
            self.assertRegex(said, r"^whit: --denoise: OpenImageDenoise cannot be loaded \(WHIT_OIDN: .*\); install it "
                                   r"\(`pip install oidn`, .*\), or name its file or folder in WHIT_OIDN\n$")
        self.assertFalse(os.path.exists(self.path("never.exr")))

    def test_a_library_without_its_functions(self):
        compiler = shutil.which("cc")
        if not compiler:
            self.skipTest("no C compiler")
        subprocess.run([compiler, "-shared", "-fPIC", "-x", "c", "-o", self.path("other.so"), "/dev/null"], check=True)
        said = self.run_whit("scene.pbrt", "--denoise", code=2, WHIT_OIDN=self.path("other.so"))
        self.assertIn("other.so lacks functions of version 1.4", said)

    def test_what_makes_no_picture_or_must_end_in_time(self):
        for flags, words in ((["--debug-pixel", "1,1"], "none is made"), (["--cat"], "none is made"),
                             (["--time-limit", "5s"], "is not known before")):
            self.assertIn(words, self.run_whit("scene.pbrt", "--denoise", *flags, code=2))

    def test_the_first_picture_stays_as_it_is(self):
        for name, flags in (("plain", []), ("aovs", ["--aov", "P,N"])):
            self.run_whit("scene.pbrt", *flags, "-o", name + ".exr", "--quiet")
            self.render(*flags, "-o", name + "2.exr", "--quiet", wants="albedo")
            for ending in (".exr", ".png"):
                with open(self.path(name + ending), "rb") as a, open(self.path(name + "2" + ending), "rb") as b:
                    self.assertTrue(a.read() == b.read(), name + ending)

    def test_the_second_picture(self):
        said = self.render("-o", "second.exr", "--type", "float")
        self.assertRegex(said, r"(?m)^denoised: second-denoised.exr and second-denoised.png  "
                               r"\[OpenImageDenoise 1\.4\.3, .* s; biased\]$")
        first, header = pixels(self.path("second.exr"))
        second, denoised = pixels(self.path("second-denoised.exr"))
        # The stand-in gives what it got.
        self.assertEqual(sorted(second), ["B", "G", "R"])
        for channel in second:
            self.assertTrue(np.array_equal(first[channel], second[channel]), channel)
        self.assertNotIn("whit:denoised", header)
        self.assertEqual(denoised["whit:denoised"], "OpenImageDenoise 1.4.3")
        self.assertTrue(os.path.exists(self.path("second-denoised.png")))

    def test_the_guides(self):
        self.run_whit("scene.pbrt", "--aov", "albedo,N", "-o", "guides.exr", "--type", "float", "--quiet")
        all_of_it, _ = pixels(self.path("guides.exr"))
        for wants, channels in (("albedo", ["Albedo.R", "Albedo.G", "Albedo.B"]), ("normal", ["N.X", "N.Y", "N.Z"])):
            # Whether they are written or not.
            for flags in ([], ["--aov", "albedo"]):
                self.render(*flags, "-o", "g.exr", "--type", "float", "--quiet", "--display", "none", wants=wants)
                made, _ = pixels(self.path("g-denoised.exr"))
                for channel, guide in zip("RGB", channels):
                    # Albedo is stored as half where colours are.
                    self.assertTrue(np.allclose(made[channel], all_of_it[guide], atol=1e-3), guide)
            self.assertFalse(os.path.exists(self.path("g-denoised.png")))

    def test_a_display_picture_and_a_crop(self):
        self.render("-o", "d.png", "--cropwindow", "0.25", "0.75", "0", "0.5", "--quiet")
        self.assertTrue(os.path.exists(self.path("d-denoised.png")))
        self.assertEqual(pixels(self.path("d-denoised.png"))[0]["R"].shape, (24, 32))  # halves of 48 and 64

    def test_version_2_and_folders(self):
        library = stand_in(self.stand_ins, "-DVERSION_2")
        if not library:
            self.skipTest("no C compiler for the stand-in")
        self.assertIn("OpenImageDenoise 2.3.1", self.render("-o", "two.exr", library=library))
        # Of a folder the newest.
        self.assertIn("OpenImageDenoise 2.3.1", self.render("-o", "two.exr", library=self.stand_ins))

    def test_its_errors(self):
        said = self.render("-o", "bad.exr", wants="error", code=4)
        self.assertIn("whit: OpenImageDenoise: no memory for the network", said)
        self.assertTrue(os.path.exists(self.path("bad.exr")))  # The picture that there is.
        self.assertFalse(os.path.exists(self.path("bad-denoised.exr")))

    def test_a_second_picture_that_cannot_be_written(self):
        os.makedirs(self.path("taken-denoised.exr"), exist_ok=True)
        self.render("-o", "taken.exr", code=4)
        self.assertFalse(os.path.exists(self.path("taken.exr")))  # It is known before rendering.

    def test_diff_calls_it_biased(self):
        self.render("-o", "biased.exr", "--aov", "variance", "--quiet")
        said = self.run_whit("diff", "biased.exr", "biased-denoised.exr", "--channels", "R,G,B")
        self.assertIn("note: biased-denoised.exr is denoised (OpenImageDenoise 1.4.3): it is biased", said)
        said = self.run_whit("diff", "--noise", "biased.exr", "biased-denoised.exr", "--channels", "R,G,B",
                             code=4)
        self.assertIn("biased-denoised.exr is denoised (OpenImageDenoise 1.4.3): it is biased, and its errors are no noise",
                      said)
        self.assertNotIn("denoised", self.run_whit("diff", "--noise", "biased.exr", "biased.exr"))

    def test_cost_measures_it(self):
        if not self.library:
            self.skipTest("no C compiler for the stand-in")
        table = self.run_whit("cost", "scene.pbrt", "--time", "6s", WHIT_OIDN=self.library, STAND_IN="color")
        self.assertRegex(table, r"denoise \(biased\)")
        # The stand-in gives the render's picture, so that nothing can have changed.
        self.assertNotRegex(self.run_whit("cost", "scene.pbrt", "--time", "6s", WHIT_OIDN=self.path("none")), r"denoise")

    def test_the_library_itself(self):
        environment = {key: value for key, value in os.environ.items() if key != "STAND_IN"}
        done = subprocess.run([WHIT, "scene.pbrt", "--denoise", "--spp", "1", "-o", "real.exr", "--type", "float"],
                              capture_output=True, text=True, check=False, cwd=self.folder, env=environment, timeout=120)
        if done.returncode == 2:
            self.skipTest("no OpenImageDenoise (pip install oidn)")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.run_whit("scene.pbrt", "--spp", "4096", "-o", "truth.exr", "--type", "float", "--quiet")
        truth, noisy, clean = (pixels(self.path(name))[0] for name in ("truth.exr", "real.exr", "real-denoised.exr"))

        def error(picture):
            return float(np.sqrt(np.mean([(picture[c] - truth[c]) ** 2 for c in "RGB"])))
        # What it is for: version 1.4.3 left 0.48 of the error of one sample per pixel.
        self.assertLess(error(clean), 2 / 3 * error(noisy))


if __name__ == "__main__":
    if not WHIT:
        print("the program is not built")
        raise SystemExit(77)
    unittest.main()
