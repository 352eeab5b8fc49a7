#!/usr/bin/env python3
"""Memory is estimated before it is taken: what needs more than --max-memory is refused with the figure and the place, at
once and without taking it; what is said is near what is taken; and where memory ends all the same, that is an error.
"""
import json
import os
import re
import resource
import struct
import subprocess
import tempfile
import unittest
import zlib

WHIT = os.environ.get("WHIT")
SOURCES = os.environ.get("WHIT_SOURCE_DIR")
SANITIZED = os.environ.get("WHIT_SANITIZE")
MIB = 1 << 20

FILM = 'Film "image" "integer xresolution" [%d] "integer yresolution" [%d] "string filename" ["x.%s"]\n'
SMALL = FILM % (32, 32, "exr") + 'Sampler "halton" "integer pixelsamples" [1]\nLookAt 0 0 5  0 0 0  0 1 0\n' \
                                 'Camera "perspective" "float fov" [40]\n'
WORLD = 'WorldBegin\nLightSource "distant"\n%s\nWorldEnd\n'
OCTAHEDRON = 'Shape "loopsubdiv" "integer nlevels" %d "point P" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1] ' \
             '"integer indices" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]'
NUMBERS = {"KiB": 1 << 10, "MiB": 1 << 20, "GiB": 1 << 30}


def film_scene(width, height, more="", ending="exr"):
    return FILM % (width, height, ending) + more + WORLD % 'Shape "sphere"'


def world(text):
    return SMALL + WORLD % text


def png_header(width, height, size):
    """A picture without its pixels, in a file that is large enough for them to be possible."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    head = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return head + struct.pack(">I", size) + b"IDAT" + b"\x78\x01", len(head) + 8 + size


@unittest.skipUnless(WHIT, "the program is not built")
class Memory(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data, size=None):
        """A file, with a hole behind its bytes up to `size`."""
        with open(self.path(name), "wb") as f:
            f.write(data.encode() if isinstance(data, str) else data)
            if size:
                f.truncate(size)

    def whit(self, *args, limit=None):
        def before():
            if limit:
                resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

        return subprocess.run([WHIT, *args], cwd=self.folder, capture_output=True, text=True, check=False, timeout=300,
                              preexec_fn=before)

    def refused(self, name, scene, place, *flags):
        """That it needs more than 1 GiB: the figure, in MiB. `place` is the beginning of the statement it is said of."""
        with self.subTest(name):
            self.write(name + ".pbrt", scene)
            if os.path.exists(self.path("x.exr")):
                os.remove(self.path("x.exr"))
            done = self.whit(name + ".pbrt", "--max-memory", "1G", "--stats", *flags)
            self.assertEqual(done.returncode, 5, done.stderr)
            told = re.search(r"^%s.pbrt:(\d+):\d+: error: [a-z ]+ takes about (\d+|[\d.]+) ([KMG]iB) of memory, more than "
                             r"1024 MiB: .*(MiB|GiB)" % name, done.stderr, re.M)
            self.assertTrue(told, done.stderr)
            line = scene.split("\n")[int(told[1]) - 1].strip()
            self.assertTrue(line.startswith(place), line[:80])
            self.assertIn("--max-memory allows more", done.stderr)
            figure = float(told[2]) * NUMBERS[told[3]] / MIB
            self.assertGreater(figure, 1024 - 1)
            self.assertFalse(os.path.exists(self.path("x.exr")))
            return figure

    def test_films_are_refused(self):
        # 48 bytes a pixel of a unit that reaches no further, and 12 of the finished picture: 60 x 6000^2 = 2.0 GiB.
        box = 'PixelFilter "box"\n'
        self.assertAlmostEqual(self.refused("film0", film_scene(6000, 6000, box), "Film") / (60 * 36 / 1.048576), 1, delta=0.1)
        self.refused("film1", film_scene(65536, 65536), "Film")
        self.refused("film2", film_scene(65536, 600, box), "Film")
        self.refused("film3", film_scene(7000, 7000, box, "png"), "Film")
        self.refused("film4", film_scene(20000, 20000, box + 'Sampler "random"\n'), "Film", "--cropwindow", "0", "1", "0", ".1")
        self.refused("film5", film_scene(3000, 3000), "Film", "--target-error", "1%")
        # 25 pixels of units that reach 52 x 52 each are 11 times as many.
        self.refused("filter0", film_scene(2500, 2500, 'PixelFilter "gaussian" "float xwidth" 18 "float ywidth" 18\n'), "Film")
        self.refused("film6", film_scene(12000, 12000, box), "Film", "--cropwindow", "0.2", "0.9", "0.1", "0.9")
        for i, (kind, radius) in enumerate((("box", 90), ("gaussian", 100), ("triangle", 80), ("mitchell", 120))):
            text = 'PixelFilter "%s" "float xwidth" %g "float ywidth" %g\n' % (kind, radius, radius)
            self.refused("filter%d" % (i + 1), film_scene(400, 400, text), "PixelFilter")
        one = self.refused("aovs0", film_scene(3500, 3500), "Film", "--aov", "N", "--aov", "P", "--aov", "albedo")
        more = self.refused("aovs1", film_scene(3500, 3500), "Film", "--aov", "N", "--aov", "P", "--aov", "albedo", "--aov",
                            "variance", "--aov", "Z")
        self.assertGreater(more, 1.2 * one)
        self.refused("aovs2", film_scene(4000, 4000), "Film", "--aov", "shape")

    def ply(self, name, vertices, faces, *properties):
        head = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % vertices + "".join(
            "property float %s\n" % p for p in ("x", "y", "z", *properties)) + \
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % faces
        self.write(name + ".ply", head, len(head) + vertices * 4 * (3 + len(properties)) + 13 * faces)

    def test_meshes_and_curves_are_refused(self):
        self.ply("a", 5000000, 10000000)
        self.ply("b", 20000000, 100, "nx", "ny", "nz", "u", "v")
        self.ply("c", 100000000, 200000000)
        for name in "abc":
            self.refused("ply" + name, world('Shape "plymesh" "string filename" "%s.ply"' % name), 'Shape "plymesh"')
        # Each fits, all do not.
        self.ply("d", 1000000, 2000000)
        self.refused("two", world('Shape "plymesh" "string filename" "d.ply"\n' + OCTAHEDRON % 11), 'Shape "loopsubdiv"')
        self.refused("plys", world('Shape "plymesh" "string filename" "d.ply"\n' * 6), 'Shape "plymesh"')
        # An octahedron's 8 faces become 4^levels as many.
        for levels in (11, 12):
            self.refused("loop%d" % levels, world(OCTAHEDRON % levels), 'Shape "loopsubdiv"')
        side = 2500
        self.refused("heights", world('Shape "heightfield" "integer nu" %d "integer nv" %d "float Pz" [%s]' % (
            side, side, "0 " * side ** 2)), 'Shape "heightfield"')
        curve = 'Shape "curve" "string basis" "bspline" "integer splitdepth" %d "point P" [%s]'
        self.refused("curve", world(curve % (5, "0 0 0 1 1 1 " * 200000)), 'Shape "curve"')
        self.refused("depth20", world(curve % (20, "0 0 0 1 1 1 " * 200000)), 'Shape "curve"')

    def test_many_places_are_refused(self):
        text = 'ObjectBegin "o"\nShape "sphere"\nObjectEnd\n' + 'ObjectInstance "o"\n' * 2500000
        self.refused("instances", world(text), 'ObjectInstance')

    def test_gltf_is_refused(self):
        vertices, corners = 8000000, 24000000
        self.write("m.bin", b"", 12 * vertices + 4 * corners)
        self.write("m.gltf", json.dumps({
            "asset": {"version": "2.0"}, "buffers": [{"uri": "m.bin", "byteLength": 12 * vertices + 4 * corners}],
            "bufferViews": [{"buffer": 0, "byteLength": 12 * vertices}, {"buffer": 0, "byteOffset": 12 * vertices,
                                                                        "byteLength": 4 * corners}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 1]},
                          {"bufferView": 1, "componentType": 5125, "count": corners, "type": "SCALAR"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}))
        self.write("gltf.pbrt", world('Shape "gltf" "string filename" "m.gltf"'))
        done = self.whit("gltf.pbrt", "--max-memory", "1G")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertRegex(done.stderr, r"takes about \S+ [MG]iB of memory, more than 1024 MiB: .*meshes")

    def test_light_maps_are_refused(self):
        # 16 bytes for each texel, of sides that are powers of two of an infinite light: 16 x 16384 x 8192 = 2 GiB.
        self.write("m.png", *png_header(9000, 5000, 2 * MIB))
        self.assertGreater(self.refused("infinite", world('LightSource "infinite" "string mapname" "m.png"'),
                                        'LightSource "infinite"'), 2048)
        self.write("l.png", *png_header(30000, 30000, 3 * MIB))
        for kind in ("infinite", "skybox"):
            self.refused(kind + "30000", world('LightSource "%s" "string mapname" "l.png"' % kind), 'LightSource "%s"' % kind)

    def test_textures_are_not_refused_but_cached(self):
        # Their levels go to a file: what is in memory is a few rows.
        self.write("t.png", *png_header(30000, 30000, 3 * MIB))
        self.write("t.pbrt", world('Texture "t" "spectrum" "imagemap" "string filename" "t.png"\n'
                                   'Material "matte" "texture Kd" "t"\nTranslate 9 9 90 Shape "sphere"'))
        done = self.whit("explain", "t.pbrt", "--memory")
        self.assertRegex(done.stdout, r"textures +\d{2,4} MiB   this picture at t.pbrt:\d+:1")
        done = self.whit("t.pbrt", "--max-memory", "512M", "--stats", "s.json", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_figure_is_near_what_is_taken(self):
        if SANITIZED:
            self.skipTest("the sanitizers' memory")
        done = subprocess.run([os.path.join(SOURCES, "tools/check-memory"), "--whit", WHIT, "--small", "small", "ply", "inline",
                               "subdivision", "gltf", "curves", "instances", "textures", "film", "aovs", "adaptive",
                               "lights", "objects", "moving"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_where_memory_ends_is_an_error(self):
        """Whatever the limit: a picture, or exit code 5 with a message; no signal, and no torn file."""
        if SANITIZED:
            self.skipTest("the sanitizers reserve address space")
        self.ply("e", 300000, 300000, "nx", "ny", "nz")
        scenes = {"mesh": world('Shape "plymesh" "string filename" "e.ply"\n' + OCTAHEDRON % 7), "film": film_scene(1500, 1500),
                  "curves": world('Shape "curve" "string basis" "bspline" "integer splitdepth" 4 "point P" [%s]' % (
                      " ".join("%g %g %g" % (i * 37 % 200 / 100 - 1, i * 53 % 200 / 100 - 1, i % 7) for i in range(20000))))}
        for name, text in scenes.items():
            self.write(name + ".pbrt", text)
            codes = set()
            for mib in list(range(200, 401, 50)) + [500, 700, 1200, 4000]:
                picture = self.path("x.exr")
                if os.path.exists(picture):
                    os.remove(picture)
                done = self.whit(name + ".pbrt", "--spp", "1", "--display", "none", "--quiet", "--nthreads", "2", "-o", "x.exr",
                                 limit=mib * MIB)
                self.assertIn(done.returncode, (0, 5), "%s at %d MiB: %s" % (name, mib, done.stderr))
                self.assertEqual(os.path.exists(picture), done.returncode == 0, "%s at %d MiB" % (name, mib))
                if done.returncode == 5:
                    self.assertRegex(done.stderr, "memory")
                codes.add(done.returncode)
                self.assertEqual([f for f in os.listdir(self.folder) if f.startswith(".")], [])
            self.assertIn(0, codes)

    def test_lights_and_what_moves_are_refused(self):
        # 1400 bytes for each light, 12 KB for each shape that moves, 4 KB for each object.
        self.refused("lights", world('LightSource "point"\n' * 800000 + 'Shape "sphere"'), 'LightSource')
        moves = "TransformTimes 0 1\n"
        self.write("moves.pbrt", SMALL + moves + WORLD % (
            "ActiveTransform EndTime\nRotate 20 0 0 1\nActiveTransform All\n" + 'Shape "sphere"\n' * 130000))
        done = self.whit("moves.pbrt", "--max-memory", "1G")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertRegex(done.stderr, r"takes about \S+ [MG]iB of memory, more than 1024 MiB: .*instances")

    def test_tables_are_refused(self):
        # As large as its file, which is in memory beside it while it is read.
        self.write("t.bsdf", b"SCATFUN\1", 700 * MIB)
        self.assertAlmostEqual(self.refused("table", world('Material "fourier" "string bsdffile" "t.bsdf"\nShape "sphere"'),
                                            'Material "fourier"'), 1420, delta=40)

    def test_cost_and_watch_are_refused(self):
        # cost has six films of that size at once, 48 bytes a pixel; a render, which has one, is not refused.
        box = 'PixelFilter "box"\n'
        self.write("a.pbrt", film_scene(2500, 2500, box))
        done = self.whit("cost", "a.pbrt", "--time", "2s", "--max-memory", "1G")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertRegex(done.stderr, r"^a.pbrt:1:1: error: rendering takes about \d+ MiB of memory, more than 1024 MiB: ")
        self.assertEqual(self.whit("a.pbrt", "--quiet", "--spp", "1", "--max-memory", "1G").returncode, 0)
        self.write("b.pbrt", film_scene(6000, 6000, box))
        done = self.whit("watch", "--terminal", "b.pbrt", "--max-memory", "1G")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertRegex(done.stderr, r"b.pbrt:1:1: error: rendering takes about \d+ MiB of memory, more than 1024 MiB: ")
        for command in ("cost", "watch"):
            done = self.whit(command, "a.pbrt", "--max-memory", "much")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn('--max-memory: "much" is no size above 0', done.stderr)

    def test_sizes_on_the_command_line(self):
        self.write("a.pbrt", world('Shape "sphere"'))
        for size, code in (("2G", 0), ("2000M", 0), ("2GiB", 0), ("4000000000", 0), ("1.5 GB", 0), ("100", 5), ("1K", 5),
                           ("much", 2), ("-1G", 2), ("0", 2), ("1X", 2)):
            done = self.whit("a.pbrt", "--quiet", "--max-memory", size)
            self.assertEqual(done.returncode, code, size + done.stderr)

    def test_what_is_told_is_in_the_statistics_and_explained(self):
        self.write("a.pbrt", film_scene(500, 500))
        self.assertEqual(self.whit("a.pbrt", "--quiet", "--spp", "1", "--stats", "s.json").returncode, 0)
        with open(self.path("s.json"), encoding="utf-8") as f:
            stats = json.load(f)
        self.assertGreater(stats["memory_peak_bytes"], 20 * MIB)
        self.assertGreater(stats["memory_estimate_bytes"], 20 * MIB)
        told = json.loads(self.whit("explain", "a.pbrt", "--memory", "--json").stdout)["worlds"][0]["memory"]
        self.assertAlmostEqual(sum(use["bytes"] for use in told["uses"].values()), told["estimate_bytes"], delta=20)
        self.assertEqual(max(told["steps"].values()), told["estimate_bytes"])
        self.assertEqual(told["steps"][told["step"]], told["estimate_bytes"])
        self.assertEqual(told["uses"]["film"]["largest"]["where"], "a.pbrt:1:1")
        self.assertRegex(self.whit("explain", "a.pbrt", "--memory").stdout, r"film +\d+ MiB   a film of 500 x 500 pixels at a.pb")

    def test_keep_going_does_not_go_past_a_limit(self):
        self.write("a.pbrt", film_scene(60000, 60000))
        self.assertEqual(self.whit("a.pbrt", "--max-memory", "1G", "--keep-going").returncode, 5)

    def test_conformance_scenes_need_less_than_a_gigabyte(self):
        folder = os.path.join(SOURCES, "tests/conformance")
        scenes = sorted(os.path.join(at, f) for at, _, files in os.walk(folder) for f in files if f.endswith(".pbrt"))
        for scene in scenes[::8]:
            with self.subTest(scene):
                told = self.whit("explain", scene, "--memory", "--json")
                if told.returncode == 0:
                    self.assertLess(json.loads(told.stdout)["worlds"][0]["memory"]["estimate_bytes"], 1024 * MIB)


if __name__ == "__main__":
    unittest.main()
