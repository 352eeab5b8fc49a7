#!/usr/bin/env python3
"""The Python package: pictures have the bits of the command's, arrays are the renderer's own memory, errors are exceptions."""
import contextlib
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy

from package import LONG, ROOT, SCENE, WHIT, whit


def resident():
    """Bytes of this process in memory."""
    with open("/proc/self/statm", encoding="ascii") as f:
        return int(f.read().split()[1]) * resource.getpagesize()


def peak():
    """The most that there were since it was reset."""
    with open("/proc/self/status", encoding="ascii") as f:
        return next(int(line.split()[1]) * 1024 for line in f if line.startswith("VmHWM"))


def read(path):
    with open(path, "rb") as f:
        return f.read()


class Folder(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="whit python ")  # a path with spaces
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.scene = self.write("scene.pbrt", SCENE)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def command(self, *arguments):
        """Renders as the command does; the bytes of its float .exr."""
        out = self.folder / "command.exr"
        done = subprocess.run([WHIT, *arguments, "--quiet", "--display", "none", "--outfile", str(out)], cwd=self.folder,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return read(out)

    def saved(self, picture, **options):
        path = self.folder / "package.exr"
        picture.save(path, **options)
        return read(path)


class Render(Folder):
    def test_files_are_those_of_the_command_to_the_bit(self):
        """Headers too: they have the command that makes the picture."""
        with contextlib.chdir(self.folder):
            for flags, arguments in (
                    (["--spp", "3", "--seed", "7"], {"spp": 3, "seed": 7}),
                    (["--cropwindow", "0.25", "0.75", "0", "0.5"], {"crop": (0.25, 0.75, 0, 0.5)}),
                    (["--integrator", "path", "--maxdepth", "3"], {"integrator": "path", "maxdepth": 3}),
                    (["--sampler", "sobol", "--lights", "tree"], {"sampler": "sobol", "lights": "tree"}),
                    (["--aov", "N,albedo,variance,shape_id"], {"aovs": ["N", "albedo", "variance", "shape_id"]}),
                    (["--without", "shadows"], {"without": ["shadows"]}),
                    (["--quick"], {"quick": True})):
                with self.subTest(flags):
                    known = set(whit.aovs())
                    if "aovs" in arguments:
                        arguments["aovs"] = [a for a in arguments["aovs"] if a in known]
                        flags = ["--aov", ",".join(arguments["aovs"])]
                        self.assertGreaterEqual(len(arguments["aovs"]), 3)
                    picture = whit.render("scene.pbrt", **arguments)
                    self.assertEqual(self.saved(picture), self.command("scene.pbrt", *flags))

    def test_pixels_are_linear_floats_of_the_window(self):
        picture = whit.render(self.scene, crop=(0.5, 1, 0, 1))
        self.assertEqual(picture.pixels.shape, (30, 20, 3))
        self.assertEqual(picture.pixels.dtype, numpy.float32)
        self.assertEqual((picture.width, picture.height), (20, 30))
        self.assertEqual(picture.window, (20, 0, 40, 30))
        self.assertEqual(picture.resolution, (40, 30))
        self.assertEqual(picture.samples_per_pixel, 4)
        self.assertTrue(picture.complete)
        whole = whit.render(self.scene)
        numpy.testing.assert_array_equal(picture.pixels, whole.pixels[:, 20:])
        numpy.testing.assert_array_equal(numpy.asarray(whole), whole.pixels)
        self.assertEqual(numpy.asarray(whole, dtype="f8").dtype, numpy.float64)
        self.assertGreater(whole.pixels.mean(), 0.01)

    def test_a_text_and_a_file_make_the_same_picture(self):
        by_path = whit.render(self.scene)
        for scene in (SCENE, str(self.scene)):
            numpy.testing.assert_array_equal(whit.render(scene).pixels, by_path.pixels)

    def test_a_text_includes_files_of_the_current_folder(self):
        before, world = SCENE.split("WorldBegin\n")
        self.write("world.pbrt", world.replace("WorldEnd\n", ""))
        with contextlib.chdir(self.folder):
            picture = whit.render(before + 'WorldBegin\nInclude "world.pbrt"\nWorldEnd\n')
        numpy.testing.assert_array_equal(picture.pixels, whit.render(self.scene).pixels)

    def test_threads_and_two_renders_at_once_change_no_bit(self):
        expected = whit.render(SCENE, spp=16).pixels
        numpy.testing.assert_array_equal(whit.render(SCENE, spp=16, threads=1).pixels, expected)
        found = [None] * 4

        def one(i):
            found[i] = whit.render(SCENE, spp=16, threads=1 + i % 2)

        threads = [threading.Thread(target=one, args=(i,)) for i in range(len(found))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for picture in found:
            numpy.testing.assert_array_equal(picture.pixels, expected)

    def test_channels_have_the_names_of_files(self):
        picture = whit.render(SCENE, aovs=["N", "variance"])
        self.assertEqual(list(picture.channels),
                         ["R", "G", "B", "N.X", "N.Y", "N.Z", "variance.R", "variance.G", "variance.B"])
        numpy.testing.assert_array_equal(picture.channels["G"], picture.pixels[:, :, 1])
        self.assertTrue(numpy.shares_memory(picture.channels["G"], picture.pixels))
        # Two samples of each of the blocks that variance is taken from are too few for some; those that are known are
        # no negative numbers.
        self.assertEqual(picture.variance.shape, (30, 40, 3))
        self.assertTrue((picture.variance >= 0).all())
        numpy.testing.assert_array_equal(picture.variance[:, :, 2], picture.channels["variance.B"])
        self.assertIsNone(whit.render(SCENE, spp=1).variance)
        numpy.testing.assert_array_equal(whit.render(SCENE).pixels, picture.pixels)

    def test_the_film_says_which_aovs_unless_somebody_does(self):
        asks = SCENE.replace('"integer yresolution" [30]', '"integer yresolution" [30] "string aovs" ["N"]')
        self.assertIn("N.X", whit.render(asks, spp=1).channels)
        self.assertEqual(list(whit.render(asks, spp=1, aovs=("none",)).channels), ["R", "G", "B"])
        wrong = SCENE.replace('"integer yresolution" [30]', '"integer yresolution" [30]\n "string aovs" ["M"]')
        with self.assertRaises(whit.SceneError) as raised:
            whit.render(wrong, spp=1)
        self.assertEqual(raised.exception.diagnostics[0].line, 2)

    def test_statistics_have_the_keys_of_the_command(self):
        import json

        stats = self.folder / "stats.json"
        self.command(str(self.scene), "--stats", str(stats))
        expected = json.loads(stats.read_text(encoding="utf-8"))
        found = whit.render(self.scene).statistics

        def keys(value):
            return {k: keys(v) for k, v in value.items()} if isinstance(value, dict) else None

        self.assertEqual(keys(found), keys(expected))
        for name in ("rays", "samples", "invalid_samples", "seed"):
            self.assertEqual(found[name], expected[name])
        self.assertEqual(found["samples"], 40 * 30 * 4)

    def test_an_accuracy_is_a_target(self):
        picture = whit.render(SCENE, target_error=0.2, confidence=0.9, max_samples=4096, aovs=["variance"])
        self.assertTrue(picture.target["met"])
        self.assertEqual((picture.target["target"], picture.target["confidence"]), (0.2, 0.9))
        self.assertLess(picture.target["achieved"]["value"], 0.2)
        self.assertIsNone(whit.render(SCENE, spp=1).target)
        few = whit.render(SCENE, target_error=1e-6, max_samples=16)
        self.assertFalse(few.target["met"])
        self.assertEqual(few.samples_per_pixel, 16)

    def test_which_world_of_a_file(self):
        two = SCENE + SCENE.replace("[40]", "[20]")
        self.assertEqual(whit.render(two, spp=1).width, 40)
        self.assertEqual(whit.render(two, spp=1, world=1).width, 20)
        with self.assertRaisesRegex(whit.UsageError, "world: <text> has the worlds 0 to 1, and no 2"):
            whit.render(two, spp=1, world=2)

    def test_textures_are_read_by_the_module_beside_the_package(self):
        """A .hdr, which OpenImageIO reads: the module that has it must be found."""
        # 8 x 4 pixels of (1, 1, 1): mantissas 128, exponent 129.
        pixels = bytes([128, 128, 128, 129]) * 32
        (self.folder / "sky.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + pixels)
        text = ('Film "image" "integer xresolution" 4 "integer yresolution" 4 Camera "perspective"\nWorldBegin\n'
                'LightSource "infinite" "string mapname" "sky.hdr"\nWorldEnd\n')
        with contextlib.chdir(self.folder):
            numpy.testing.assert_allclose(whit.render(text).pixels, 1, rtol=1e-5)


class Memory(Folder):
    def test_arrays_are_the_renderers_own_memory(self):
        picture = whit.render(SCENE)
        pixels = picture.pixels
        self.assertEqual(pixels.ctypes.data, picture._core.address())
        self.assertFalse(pixels.flags.owndata)
        self.assertFalse(pixels.flags.writeable)
        with self.assertRaises(ValueError):
            pixels[0, 0, 0] = 1
        expected = pixels.copy()
        del picture
        numpy.testing.assert_array_equal(pixels, expected)  # It keeps what it is a view of.

    def test_a_picture_in_4k_is_handed_over_without_a_copy(self):
        empty = ('Film "image" "integer xresolution" 3840 "integer yresolution" 2160 PixelFilter "box"\n'
                 'Sampler "random" "integer pixelsamples" 1 Camera "perspective"\nWorldBegin\n'
                 'LightSource "infinite"\nWorldEnd\n')
        picture = whit.render(empty)
        size = 3840 * 2160 * 3 * 4  # 95 MiB
        with open("/proc/self/clear_refs", "w", encoding="ascii") as f:
            f.write("5")  # resets the peak
        before = resident()
        pixels = picture.pixels
        red, array = picture.channels["R"], numpy.asarray(picture)
        self.assertEqual(pixels.nbytes, size)
        for one in (pixels, array):
            self.assertEqual(one.ctypes.data, picture._core.address())
        self.assertTrue(numpy.shares_memory(red, pixels))
        # A copy would be 95 MiB; an array object is some hundred bytes.
        self.assertLess(peak() - before, size / 50)

    def test_a_thousand_renders_leave_nothing_behind(self):
        tiny = ('Film "image" "integer xresolution" 8 "integer yresolution" 8 Sampler "random" "integer pixelsamples" 1\n'
                'Camera "perspective"\nWorldBegin\nLightSource "infinite"\nShape "sphere" "float radius" 9\nWorldEnd\n')
        for _ in range(200):  # Until allocators and thread pools have what they want.
            whit.render(tiny)
        before = resident()
        for _ in range(1000):
            whit.render(tiny)
        # 8 KiB a render would be 8 MiB. The allowance is for the system's allocator.
        self.assertLess(resident() - before, 4 << 20)


class Saving(Folder):
    def test_endings_choose_the_format(self):
        picture = whit.render(SCENE, aovs=["N"])
        for name, magic in (("a.exr", b"\x76\x2f\x31\x01"), ("a.pfm", b"PF"), ("a.png", b"\x89PNG"), ("a.jpg", b"\xff\xd8"),
                            ("a.tiff", b"II*\0")):
            picture.save(self.folder / name)
            self.assertEqual(read(self.folder / name)[:len(magic)], magic, name)
        self.assertEqual(picture._repr_png_()[:4], b"\x89PNG")
        self.assertEqual(picture._repr_png_(), read(self.folder / "a.png"))

    def test_display_pictures_are_those_of_the_command(self):
        self.command(str(self.scene), "--view", "ACES SDR", "--exposure", "1")
        done = subprocess.run([WHIT, str(self.scene), "--quiet", "--outfile", str(self.folder / "c.exr"), "--exposure", "1"],
                              check=True, timeout=300)
        self.assertEqual(done.returncode, 0)
        picture = whit.render(self.scene)
        picture.save(self.folder / "p.exr", display=self.folder / "p.png", exposure=1)
        same = whit.diff(self.folder / "p.png", self.folder / "c.png", exact=True)
        self.assertTrue(same.same, same.verdict)
        shown = picture.display(exposure=1)
        self.assertEqual((shown.shape, shown.dtype), ((30, 40, 3), numpy.uint8))
        # A stop more is twice the light: sRGB of a linear x above 0.0031308 is 1.055 x^(1 / 2.4) - 0.055.
        light = numpy.clip(2 * picture.pixels.astype("f8"), 0, 1)
        encoded = numpy.where(light > 0.0031308, 1.055 * light ** (1 / 2.4) - 0.055, 12.92 * light)
        self.assertLessEqual(abs(shown - 255 * encoded).max(), 0.51)  # half a step, and a float's rounding

    def test_what_cannot_be_written_is_an_error(self):
        picture = whit.render(SCENE, spp=1)
        for path, words in ((self.folder / "no" / "a.exr", "no"), (self.folder / "a.xyz", "xyz"), (self.folder, "")):
            with self.assertRaises(whit.FileError) as raised:
                picture.save(path)
            self.assertIn(words, str(raised.exception))
        with self.assertRaisesRegex(whit.UsageError, "no such view|there is no view|view"):
            picture.save(self.folder / "a.png", view="nonsense")
        with self.assertRaises(whit.UsageError):
            picture.display(view="nonsense")
        with self.assertRaises(whit.FileError):
            picture.display(ocio=str(self.folder / "no.ocio"))

    def test_no_picture_takes_the_place_of_a_file_of_the_scene(self):
        whit.render(SCENE, spp=1).save(self.folder / "sky.exr")
        with contextlib.chdir(self.folder):
            picture = whit.render(SCENE.replace("WorldBegin", 'WorldBegin LightSource "infinite" "string mapname" "sky.exr"'),
                                  spp=1)
            with self.assertRaisesRegex(whit.FileError, "is a file that the scene reads"):
                picture.save("sky.exr")

    def test_what_a_file_cannot_hold_is_a_warning(self):
        bright = whit.render('Film "image" "integer xresolution" 2 "integer yresolution" 2 Camera "perspective"\nWorldBegin\n'
                             'LightSource "infinite" "rgb L" [1e6 1e6 1e6]\nWorldEnd\n')
        with self.assertWarnsRegex(UserWarning, "65504|half|float"):
            bright.save(self.folder / "bright.exr")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            bright.save(self.folder / "bright.exr", full_float=True)


class Errors(Folder):
    def test_a_wrong_scene_says_where(self):
        wrong = self.write("wrong.pbrt", SCENE.replace('Shape "sphere"', 'Shpae "sphere"'))
        with self.assertRaises(whit.SceneError) as raised:
            whit.render(wrong)
        line = SCENE[:SCENE.index('Shape "sphere"')].count("\n") + 1
        error = raised.exception.diagnostics[0]
        self.assertEqual((error.severity, error.file, error.line), ("error", str(wrong), line))
        self.assertEqual(error.remedy, "did you mean Shape?")
        self.assertIn("%s:%d:" % (wrong, line), str(raised.exception))
        self.assertIsInstance(raised.exception, whit.Error)
        self.assertIn("Shpae", str(error))

    def test_all_functions_raise_it(self):
        wrong = SCENE.replace('Shape "sphere"', 'Shpae "sphere"')
        for ask in (whit.render, whit.Scene, whit.explain, lambda scene: whit.cost(scene, seconds=1)):
            with self.assertRaises(whit.SceneError):
                ask(wrong)
        self.assertEqual(whit.check(wrong)[0].severity, "error")

    def test_files_that_are_not_there(self):
        for ask in (whit.render, whit.Scene, whit.explain, lambda scene: whit.cost(scene, seconds=1)):
            with self.assertRaises(whit.FileError) as raised:
                ask(self.folder / "no.pbrt")
            self.assertIn("no.pbrt", str(raised.exception))
            self.assertIsInstance(raised.exception, OSError)

    def test_warnings_are_in_the_picture(self):
        odd = SCENE.replace('"float fov" [35]', '"float fov" [35] "float fvo" [3]')
        picture = whit.render(odd, spp=1)
        self.assertEqual([d.severity for d in picture.diagnostics], ["warning"])
        with self.assertRaises(whit.SceneError):
            whit.render(odd, spp=1, strict=True)

    def test_going_past_errors(self):
        wrong = SCENE.replace("WorldEnd", 'Shape "plymesh" "string filename" "no.ply"\nWorldEnd')
        with self.assertRaises(whit.FileError):
            whit.render(wrong)
        picture = whit.render(wrong, keep_going=True)
        numpy.testing.assert_array_equal(picture.pixels, whit.render(SCENE).pixels)
        self.assertEqual([d.severity for d in picture.diagnostics], ["error"])

    def test_arguments_that_make_no_sense(self):
        for arguments, words in (({"spp": 0}, "spp: 0 is not within 1"), ({"spp": 1.5}, "spp: a whole number"),
                                 ({"seed": -1}, "seed: -1"), ({"crop": (0.5, 0.5, 0, 1)}, "crop: needs x0"),
                                 ({"crop": (0, 1)}, "crop: needs x0"), ({"threads": -1}, "threads: -1"),
                                 ({"integrator": "pth"}, 'integrator: .*did you mean "path"'),
                                 ({"sampler": "nothing"}, "sampler: "), ({"lights": "some"}, "lights: "),
                                 ({"texture_filter": "x"}, "texture_filter: "), ({"aovs": ["albdo"]}, "aovs: .*albedo"),
                                 ({"without": ["shadow"]}, "without: .*shadows"), ({"target_error": 0}, "target_error: 0"),
                                 ({"target_error": 0.1, "confidence": 1}, "confidence: 1"),
                                 ({"target_error": 0.1, "spp": 4}, "max_samples is a limit"),
                                 ({"time_limit": float("nan")}, "time_limit"), ({"max_samples": 0}, "max_samples: 0"),
                                 ({"without": ["shadows"], "only": ["shadows"]}, "exclude each other"),
                                 ({"texture_memory": 0}, "texture_memory: 0")):
            with self.subTest(arguments):
                with self.assertRaisesRegex(whit.UsageError, words) as raised:
                    whit.render(SCENE, **arguments)
                self.assertIsInstance(raised.exception, ValueError)
                self.assertNotIn("--", str(raised.exception))
        with self.assertRaisesRegex(whit.UsageError, "a path or a text is needed, not int"):
            whit.render(3)

    def test_paths_and_texts_need_not_be_utf8(self):
        scene = os.fsencode(self.folder) + b"/\xff.pbrt"
        with open(scene, "wb") as f:
            f.write(SCENE.encode().replace(b"Shape", b"Sh\xffpe"))
        with self.assertRaises(whit.SceneError) as raised:
            whit.render(os.fsdecode(scene))
        self.assertEqual(raised.exception.diagnostics[0].file, os.fsdecode(scene))

    def test_more_memory_than_there_is(self):
        huge = SCENE.replace("[40]", "[65536]").replace("[30]", "[65536]")
        # 65536 x 65536 pixels of 32 bytes of sums are 128 GiB.
        with self.assertRaises(whit.LimitError) as raised:
            whit.render(huge)
        self.assertIsInstance(raised.exception, MemoryError)


class Meanwhile(Folder):
    def test_progress_goes_up_to_one_in_the_calling_thread(self):
        shares, threads = [], set()

        def progress(share):
            shares.append(share)
            threads.add(threading.get_ident())

        whit.render(SCENE, spp=256, progress=progress)
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(shares[-1], 1)
        self.assertTrue(all(0 <= s <= 1 for s in shares))
        self.assertEqual(threads, {threading.get_ident()})

    def test_progress_can_end_it(self):
        picture = whit.render(LONG, progress=lambda share: False)
        self.assertFalse(picture.complete)
        self.assertLess(picture.samples_per_pixel, 1000000)

    def test_an_exception_in_progress_ends_it(self):
        def progress(share):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            whit.render(LONG, progress=progress)

    def test_other_threads_run_meanwhile(self):
        """A thread that only counts gets to run while another renders for as long as it takes to see that."""
        counted = []
        rendering = threading.Thread(target=lambda: whit.render(LONG, progress=lambda share: len(counted) < 1000))
        rendering.start()
        while rendering.is_alive():
            counted.append(1)
            time.sleep(0)
        rendering.join()
        self.assertGreaterEqual(len(counted), 1000)

    def test_ctrl_c_stops_a_render(self):
        program = ("import sys; sys.path.insert(0, %r); from package import LONG, whit\n"
                   "def progress(share):\n"
                   "    if share > 0: print('rendering', flush=True)\n"
                   "try: whit.render(LONG, progress=progress)\n"
                   "except KeyboardInterrupt: print('interrupted'); sys.exit(7)\n"
                   % os.path.dirname(os.path.abspath(__file__)))
        running = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(running.kill)
        self.assertEqual(running.stdout.readline(), "rendering\n")
        running.send_signal(signal.SIGINT)
        out, error = running.communicate(timeout=60)
        self.assertEqual((running.returncode, out.splitlines()[-1], error), (7, "interrupted", ""))


class Scene(Folder):
    def test_renders_have_the_bits_of_render(self):
        scene = whit.Scene(self.scene)
        self.assertEqual((scene.resolution, scene.samples_per_pixel), ((40, 30), 4))
        for arguments in ({}, {"spp": 2}, {"spp": 2, "seed": 5}, {"crop": (0, 0.5, 0, 0.5)}, {"aovs": ["N"]}, {}):
            mine, other = scene.render(**arguments), whit.render(self.scene, **arguments)
            self.assertEqual(list(mine.channels), list(other.channels))
            for name, values in mine.channels.items():
                numpy.testing.assert_array_equal(values, other.channels[name])
        self.assertIn("scene.pbrt, 40 x 30, 4 samples", repr(scene))

    def test_another_camera(self):
        scene = whit.Scene(SCENE)
        numpy.testing.assert_allclose(scene.camera, whit.look_at((0, 2, 6), (0, 0.5, 0), (0, 1, 0)), atol=1e-12)
        numpy.testing.assert_array_equal(scene.render(camera=scene.camera).pixels, scene.render().pixels)
        moved = scene.render(camera=whit.look_at((3, 2, 5), (0, 0.5, 0), (0, 1, 0)), spp=64)
        built = whit.render(SCENE.replace("LookAt 0 2 6", "LookAt 3 2 5"), spp=64)
        # The same view from another render space: a few of the samples fall on the other side of an edge, and each is 1/64
        # of its pixel. The scene's own view is another picture.
        scale = built.pixels.mean()
        self.assertLess(abs(moved.pixels - built.pixels).mean(), 0.01 * scale)
        self.assertGreater(abs(moved.pixels - scene.render(spp=64).pixels).mean(), 0.1 * scale)
        numpy.testing.assert_array_equal(scene.render().pixels, whit.render(SCENE).pixels)  # and back

    def test_another_resolution(self):
        scene = whit.Scene(SCENE)
        small = scene.render(resolution=(20, 10))
        self.assertEqual(small.pixels.shape, (10, 20, 3))
        expected = whit.render(SCENE.replace("[40]", "[20]").replace("[30]", "[10]"))
        numpy.testing.assert_array_equal(small.pixels, expected.pixels)
        self.assertEqual(scene.render().pixels.shape, (30, 40, 3))

    def test_what_makes_no_camera(self):
        scene = whit.Scene(SCENE)
        for camera, words in ((numpy.zeros((4, 4)), "last row"), (numpy.diag([0, 1, 1, 1]), "no inverse"),
                              (numpy.eye(3), "not 3 x 3"), ("x", "4 x 4"), (numpy.full((4, 4), numpy.nan), "finite")):
            with self.assertRaisesRegex(whit.UsageError, words):
                scene.render(camera=camera)
        for resolution in ((0, 4), (4,), (4, 70000)):
            with self.assertRaises(whit.UsageError):
                scene.render(resolution=resolution)
        for eye, at, up in (((0, 0, 0), (0, 0, 0), (0, 1, 0)), ((0, 0, 0), (0, 1, 0), (0, 2, 0))):
            with self.assertRaises(whit.UsageError):
                whit.look_at(eye, at, up)
        numpy.testing.assert_array_equal(scene.render().pixels, whit.render(SCENE).pixels)

    def test_renders_of_one_scene_wait_for_each_other(self):
        scene = whit.Scene(SCENE)
        found = {}
        threads = [threading.Thread(target=lambda n=n: found.update({n: scene.render(spp=n)})) for n in (1, 2, 3, 8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for n, picture in found.items():
            numpy.testing.assert_array_equal(picture.pixels, whit.render(SCENE, spp=n).pixels)

    def test_its_text_need_not_stay(self):
        scene = whit.Scene(self.scene)
        self.scene.unlink()
        self.assertEqual(scene.render(spp=1).width, 40)
        self.assertEqual(scene.diagnostics, [])

    def test_times_of_what_was_done_before_are_nothing(self):
        scene = whit.Scene(SCENE)
        self.assertGreater(scene.render().statistics["seconds"]["build"], 0)
        self.assertEqual(scene.render().statistics["seconds"]["build"], 0)


if __name__ == "__main__":
    unittest.main()
