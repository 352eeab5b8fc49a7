#!/usr/bin/env python3
"""Files that are written to while whit reads them: shortened, grown, overwritten in place and replaced, at random moments
of a run. Whatever the moment, the run ends by itself: with a picture of what was there before (0), with mistakes of the
scene (3), or with an error that names the file (4); never by a signal, and never with a picture beside an error.
"""
import os
import random
import re
import struct
import subprocess
import tempfile
import threading
import time
import unittest
import zlib

WHIT = os.environ.get("WHIT")
TRIES = 5 if os.environ.get("WHIT_SANITIZE") else 20
HEAD = """Camera "perspective" "float fov" 60
Film "image" "integer xresolution" 8 "integer yresolution" 8
Sampler "halton" "integer pixelsamples" 1
Integrator "whitted"
WorldBegin
LightSource "point" "rgb I" [20 20 20]
Translate 0 0 5
"""
CHANGED = "changed while it was read"
VERTICES = 100000


def ply():
    """A strip of triangles of about 3 MB: long enough in reading for something to happen meanwhile."""
    faces = VERTICES - 2
    head = ("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (VERTICES, faces))
    points = b"".join(struct.pack("<3f", i * 1e-5, i % 2, 0) for i in range(VERTICES))
    return head.encode() + points + b"".join(struct.pack("<B3i", 3, i, i + 1, i + 2) for i in range(faces))


def scene_text():
    """The same size of statements."""
    return (HEAD + 'Shape "sphere" "float radius" [ 0.5 ]\n' * 40000 + "WorldEnd\n").encode()


def gltf():
    """A model whose positions and indices are in a buffer of its own."""
    indices, positions = 12 * VERTICES, VERTICES * 12
    return ("""{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "buffers": [{"uri": "big.bin", "byteLength": %d}],
 "bufferViews": [{"buffer": 0, "byteLength": %d}, {"buffer": 0, "byteOffset": %d, "byteLength": %d}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": %d, "type": "VEC3", "min": [0, 0, 0], "max": [3, 1, 0]},
               {"bufferView": 1, "componentType": 5125, "count": %d, "type": "SCALAR"}]}"""
            % (positions + indices, positions, positions, indices, VERTICES, 3 * VERTICES)).encode()


def gltf_buffer():
    points = b"".join(struct.pack("<3f", i * 1e-5, i % 2, 0) for i in range(VERTICES))
    return points + b"".join(struct.pack("<3I", i, (i + 1) % VERTICES, (i + 2) % VERTICES) for i in range(VERTICES))


def noise(seed, side=256):
    """A PNG of noise."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    chance = random.Random(seed)
    rows = b"".join(b"\0" + chance.randbytes(3 * side) for _ in range(side))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 1)) + chunk(b"IEND", b""))


def repaint(path, _size, _share):
    """Another picture in the place of one, whole at any time."""
    with open(path + ".new", "wb") as f:
        f.write(noise("new"))
    os.rename(path + ".new", path)


def shorten(path, size, share):
    os.truncate(path, int(size * share))


def grow(path, size, share):
    with open(path, "ab") as f:
        f.write(b" " * int(size * share))


def overwrite(path, size, share):
    """In place, of the same size."""
    with open(path, "r+b") as f:
        f.seek(int(size * share * 0.9))
        f.write(b"\0" * (size // 20))


def replace(path, size, share):
    """As careful programs save."""
    with open(path + ".new", "wb") as f:
        f.write(b"x" * int(size * share))
    os.rename(path + ".new", path)


@unittest.skipUnless(WHIT, "the program is not built")
class ChangingFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.contents = {"big.ply": ply(), "big.pbrt": scene_text(), "big.gltf": gltf(), "big.bin": gltf_buffer()}

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        for name, content in self.contents.items():
            self.restore(name, content)
        self.restore("mesh.pbrt", (HEAD + 'Shape "plymesh" "string filename" "big.ply"\nWorldEnd\n').encode())
        self.restore("model.pbrt", (HEAD + 'Shape "gltf" "string filename" "big.gltf"\nWorldEnd\n').encode())
        self.restore("including.pbrt", b'Include "big.pbrt"\n')

    def path(self, name):
        return os.path.join(self.folder, name)

    def restore(self, name, content):
        """As it was, written an hour ago: a change within a tick of the clock cannot be told by time."""
        if os.path.lexists(self.path(name)):
            os.remove(self.path(name))
        with open(self.path(name), "wb") as f:
            f.write(content)
        hour_ago = time.time() - 3600
        os.utime(self.path(name), (hour_ago, hour_ago))

    def run_whit(self, *args):
        # Texels that memory has no room for have none in a file either.
        environment = dict(os.environ, TMPDIR="/nowhere")
        return subprocess.Popen([WHIT, *args], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)

    def hammer(self, name, change, args, codes=(0, 3, 4), picture=False, pictures=(), until=None):
        """What became of the runs: their codes, or that they saw a file change at a moment that chance chose. There are
        more of them where none has come to `until`: a machine that is busy with other things spares the right moment."""
        content, outcomes = self.contents[name], []
        chance = random.Random(name + change.__name__ + args[0])
        began = time.monotonic()
        self.run_whit(*args).communicate(timeout=120)
        usual = time.monotonic() - began
        tries = TRIES if change in (shorten, repaint) else TRIES // 2
        while len(outcomes) < tries or (until and until not in outcomes and len(outcomes) < 20 * tries):
            self.restore(name, content)
            if os.path.exists(self.path("picture.exr")):
                os.remove(self.path("picture.exr"))
            moment, share = chance.uniform(0, usual), chance.random()
            began = time.monotonic()
            run = self.run_whit(*args)
            timer = threading.Timer(moment, change, (self.path(name), len(content), share))
            timer.start()
            _, said = run.communicate(timeout=120)
            ended = time.monotonic()
            timer.join()
            said = said.decode("utf-8", "replace")
            if run.returncode == 0:
                # The last whole run tells best how long the next one takes.
                usual = ended - began
            self.assertIn(run.returncode, codes, "%s of %s after %.3f s, %.3f: %s"
                          % (change.__name__, name, moment, share, said[-2000:]))
            if CHANGED in said:
                self.assertEqual(run.returncode, 1 if args[0] == "check" else 4, said)
                self.assertRegex(said, re.escape(name) + ".*" + CHANGED)
            if picture:
                self.assertEqual(os.path.exists(self.path("picture.exr")), run.returncode == 0, said[-2000:])
            if pictures and run.returncode == 0:
                with open(self.path("picture.exr"), "rb") as f:
                    self.assertIn(f.read(), pictures)
            outcomes.append(CHANGED if CHANGED in said else run.returncode)
        return outcomes

    def all_changes(self, name, scene):
        outcomes = []
        for change in (shorten, grow, overwrite, replace):
            until = CHANGED if change is shorten else None
            outcomes += self.hammer(name, change, [scene, "--outfile", "picture.exr", "--quiet", "--display", "none"],
                                    picture=True, until=until)
        # Moments are spread over the whole run; some hit the reading.
        self.assertIn(CHANGED, outcomes)

    def test_mesh(self):
        self.all_changes("big.ply", "mesh.pbrt")

    def test_scene(self):
        self.all_changes("big.pbrt", "big.pbrt")

    def test_included_scene(self):
        self.all_changes("big.pbrt", "including.pbrt")

    def test_buffer_of_a_model(self):
        self.all_changes("big.bin", "model.pbrt")

    def test_texture_that_is_read_again_and_again(self):
        """Eight textures of which memory holds less than two, and nowhere to keep what has no room: they are decoded all
        the time. A picture is that of the old ones or of the new one, to the bit."""
        textures = "".join('Texture "%d" "color" "imagemap" "string filename" "%d.png"\n' % (i, i) for i in range(8))
        shapes = "".join('Material "matte" "texture Kd" "%d"\nTranslate 0 0 0.01\nShape "sphere" "float zmax" %g\n'
                         % (i, 0.9 - 0.2 * i) for i in range(8))
        head = HEAD.replace("8", "64").replace('"integer pixelsamples" 1', '"integer pixelsamples" 8')
        self.restore("painted.pbrt", (head + textures + shapes + "WorldEnd\n").encode())
        for i in range(8):
            self.restore("%d.png" % i, noise(i))
        self.contents["0.png"] = noise(0)
        args = ["painted.pbrt", "--outfile", "picture.exr", "--quiet", "--display", "none", "--texture-memory", "1"]
        whole = []
        for content in (noise(0), noise("new")):
            self.restore("0.png", content)
            run = self.run_whit(*args)
            run.communicate(timeout=120)
            self.assertEqual(run.returncode, 0)
            with open(self.path("picture.exr"), "rb") as f:
                whole.append(f.read())
        self.assertNotEqual(*whole)
        outcomes = self.hammer("0.png", repaint, args, codes=(0, 4), picture=True, pictures=whole, until=CHANGED)
        self.assertIn(CHANGED, outcomes)

    def test_other_commands(self):
        for change in (shorten, overwrite):
            self.hammer("big.pbrt", change, ["--cat", "big.pbrt"])
            self.hammer("big.pbrt", change, ["explain", "big.pbrt"])
            # These two also answer no.
            self.hammer("big.pbrt", change, ["fmt", "--check", "big.pbrt"], codes=(0, 1, 3, 4))
            self.hammer("big.pbrt", change, ["check", "big.pbrt"], codes=(0, 1))


if __name__ == "__main__":
    unittest.main()
