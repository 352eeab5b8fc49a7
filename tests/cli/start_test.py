#!/usr/bin/env python3
"""What a start takes (`"start"` of `whit render --stats FILE.json`): its parts add up to the whole, by the clock and of
processor time, and each part is where the work is."""
import json
import os
import resource
import shutil
import struct
import subprocess
import tempfile
import time
import unittest

WHIT = os.environ.get("WHIT")
ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))

HEAD = """\
Film "image" "integer xresolution" [32] "integer yresolution" [24] "string filename" ["out.exr"]
Sampler "halton" "integer pixelsamples" [1]
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
"""
PARTS = ["program", "flags", "parse", "plan", "output", "inputs", "geometry", "materials", "placing", "pictures", "lights",
         "ray_tracer"]
CLOCKS = ["seconds", "cpu_seconds"]
SIDE = 150  # of a mesh: 2 * 150 * 150 = 45 000 triangles


def sky(width, height):
    """A PFM picture, the bottom row first."""
    rows = [struct.pack("<3f", 1 + y / height, 1, 2 - y / height) * width for y in range(height)]
    return b"PF\n%d %d\n-1.0\n" % (width, height) + b"".join(rows)


def sheet():
    """Points and triangles of a square that is not quite flat."""
    points = [(x / SIDE - 0.5, y / SIDE - 0.5, 0.05 * ((x * y) % 7) / 7) for y in range(SIDE + 1) for x in range(SIDE + 1)]
    triangles = []
    for y in range(SIDE):
        for x in range(SIDE):
            a = y * (SIDE + 1) + x
            triangles += [(a, a + 1, a + SIDE + 2), (a, a + SIDE + 2, a + SIDE + 1)]
    return points, triangles


def ply(points, triangles):
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(points)
    header += "".join("property float %s\n" % axis for axis in "xyz")
    header += "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(triangles)
    return (header.encode() + b"".join(struct.pack("<3f", *p) for p in points) +
            b"".join(struct.pack("<Biii", 3, *t) for t in triangles))


def inline(points, triangles):
    return 'Shape "trianglemesh" "integer indices" [%s] "point P" [%s]\n' % (
        " ".join("%d %d %d" % t for t in triangles), " ".join("%g %g %g" % p for p in points))


@unittest.skipUnless(WHIT, "the program is not built")
class Start(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit start ")
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, data):
        with open(os.path.join(self.folder, name), "wb") as f:
            f.write(data if isinstance(data, bytes) else data.encode())

    def figures(self, *arguments):
        """The figures of a run, with what it took by the clock and of processor time as seen from outside."""
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        subprocess.run([WHIT, *arguments, "--quiet", "--stats", "s.json"], check=True, cwd=self.folder, timeout=120)
        elapsed, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        with open(os.path.join(self.folder, "s.json"), encoding="utf-8") as f:
            return json.load(f), {"seconds": elapsed, "cpu_seconds": cpu}

    def unaccounted(self, figures, whole):
        """What is wrong with the sums, or None."""
        for clock in CLOCKS:
            start = figures["start"][clock]
            self.assertEqual(list(start), ["ready"] + PARTS)
            self.assertGreaterEqual(min(start.values()), -1e-6, start)
            parts = sum(start[p] for p in PARTS)
            # The clocks are read one after the other, and tick in microseconds.
            self.assertLessEqual(parts, start["ready"] + 1e-3)
            if parts < 0.9 * start["ready"] - 1e-3:
                return "parts of %g %s of %g: %s" % (parts, clock, start["ready"], start)
            # The steps that machines have known so far are the same times.
            for step in ("parse", "plan"):
                self.assertEqual(start[step], figures[clock][step])
            built = sum(start[p] for p in PARTS[PARTS.index("inputs"):])
            if not 0.9 * figures[clock]["build"] - 1e-3 <= built <= figures[clock]["build"] + 1e-3:
                return "a build of %g %s made of %g" % (figures[clock]["build"], clock, built)
            told = start["ready"] + figures[clock]["render"] + figures[clock]["write"]
            # No more than is seen from outside, where the kernel's clock of processes ticks in hundredths of a second.
            # It may be less: the end of the process is not told, in which sanitizers look for leaks.
            if told > whole[clock] + 0.011:
                return "%g %s told of, %g taken" % (told, clock, whole[clock])
        return None

    def check(self, scene, *flags):
        """Renders until the sums are right: on a machine with other work a pause may fall between two parts. The best
        figures of a few."""
        self.write("scene.pbrt", HEAD + scene + "WorldEnd\n")
        problems = []
        for _ in range(6):
            figures, whole = self.figures("scene.pbrt", *flags)
            problem = self.unaccounted(figures, whole)
            if not problem:
                return figures["start"]
            problems.append(problem)
        self.fail("\n".join(problems))

    def test_a_map_light(self):
        self.write("sky.pfm", sky(1024, 512))
        mapped = self.check('LightSource "infinite" "string mapname" ["sky.pfm"]\nShape "sphere"\n')["cpu_seconds"]
        # A light that is no picture has none to be read, and none to be made a distribution of.
        plain = self.check('LightSource "infinite"\nShape "sphere"\n')["cpu_seconds"]
        self.assertGreater(mapped["pictures"], 0)
        self.assertEqual(plain["pictures"], 0)
        self.assertGreater(mapped["lights"], plain["lights"])

    def test_a_sky(self):
        self.write("sky.pfm", sky(600, 300))
        start = self.check('LightSource "skybox" "string mapname" ["sky.pfm"]\nShape "sphere"\n')
        self.assertGreater(start["cpu_seconds"]["pictures"], start["cpu_seconds"]["lights"])

    def test_meshes(self):
        """45 000 triangles against a sphere: thousands of times the work, of which a part must be seen where it is
        done, on whatever machine."""
        points, triangles = sheet()
        self.write("sheet.ply", ply(points, triangles))
        light = 'LightSource "distant"\n'
        ball = self.check(light + 'Shape "sphere"\n')["cpu_seconds"]
        read = self.check(light + 'Shape "plymesh" "string filename" ["sheet.ply"]\n')["cpu_seconds"]
        for part in ("geometry", "placing", "ray_tracer"):
            self.assertGreater(read[part], 2 * ball[part], part)
        # The same in the scene's text takes its time to be parsed.
        in_text = self.check(light + inline(points, triangles))["cpu_seconds"]
        self.assertGreater(in_text["parse"], 2 * read["parse"])

    def test_textures(self):
        shutil.copy(ROOT + "/scenes/assets/tiles.png", self.folder)
        self.check('LightSource "distant"\nTexture "t" "spectrum" "imagemap" "string filename" ["tiles.png"]\n'
                   'Material "matte" "texture Kd" ["t"]\nShape "sphere"\n')

    def test_many_lights_and_instances(self):
        ball = 'AttributeBegin Translate %g %g -3 AreaLightSource "diffuse" Shape "sphere" "float radius" [0.02] AttributeEnd\n'
        self.check("".join(ball % (0.1 * (i % 20), 0.1 * (i // 20)) for i in range(400)) +
                   'ObjectBegin "o" Shape "sphere" "float radius" [0.3] ObjectEnd\n' +
                   "".join('AttributeBegin Translate %d 0 0 ObjectInstance "o" AttributeEnd\n' % i for i in range(50)))

    def test_what_was_before_is_no_part_of_a_second_picture(self):
        scene = HEAD + 'LightSource "point"\nShape "sphere"\nWorldEnd\n'
        self.write("two.pbrt", scene + scene.replace("out.exr", "two.exr"))
        self.write("one.pbrt", scene)
        for arguments, known in ((["two.pbrt"], ["program", "flags", "parse"]), (["one.pbrt", "one.pbrt"], ["program", "flags"])):
            (first, second), _ = self.figures(*arguments)
            for part in known:
                self.assertGreater(first["start"]["seconds"][part], 0)
                self.assertEqual(second["start"]["seconds"][part], 0)
            self.assertLess(second["start"]["cpu_seconds"]["ready"], first["start"]["cpu_seconds"]["ready"])
            self.assertGreater(second["start"]["seconds"]["ready"], 0)

    def test_people_are_told_too(self):
        points, triangles = sheet()
        self.write("scene.pbrt", HEAD + 'LightSource "distant"\n' + inline(points, triangles) + "WorldEnd\n")
        done = subprocess.run([WHIT, "scene.pbrt", "--stats"], capture_output=True, text=True, check=True, cwd=self.folder)
        self.assertRegex(done.stderr, r"(?m)^start \d.*, parse .*, plan .*, build .*, render .*, write .* on \d+ thread")
        self.assertRegex(done.stderr, r"ready to trace after .* \(.* of processor time\): program loaded in .*, scene parsed in "
                                      r".*, geometry read in .*, ray tracer built in .*; \d+ MiB resident after parsing")


if __name__ == "__main__":
    unittest.main()
