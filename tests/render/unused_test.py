#!/usr/bin/env python3
"""What a scene declares and does not use is not read, and costs nothing but its parsing.

A scene, and the same with 2 GiB of textures, 200 MiB of meshes in objects that are never placed, files included in such
objects, and 10,000 materials. None of the files is what its name says: whoever reads one fails.
"""
import os
import re
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
SANITIZED = os.environ.get("WHIT_SANITIZE")
ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
FILES, MATERIALS = 20, 10000


def rendering(measured):
    """What rendering took, of what Unused.render() returns."""
    return measured[1] - measured[2]


@unittest.skipUnless(WHIT, "the program is not built")
class Unused(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        with open(os.path.join(ROOT, "scenes", "mesh.pbrt"), encoding="utf-8") as f:
            self.scene = f.read().replace('["assets/', '["%s/scenes/assets/' % ROOT)

    def hollow(self, name, size):
        """A file of zeros that takes no room on the disk."""
        with open(os.path.join(self.folder, name), "wb") as f:
            f.truncate(size)

    def unused(self):
        lines = []
        for i in range(FILES):
            self.hollow("%d.png" % i, (2 << 30) // FILES)
            self.hollow("%d.ply" % i, (200 << 20) // FILES)
            self.hollow("%d.pbrt" % i, 1 << 20)
            lines.append('Texture "unused %d" "spectrum" "imagemap" "string filename" "%d.png"' % (i, i))
            lines.append('ObjectBegin "unused %d" Shape "plymesh" "string filename" "%d.ply" Include "%d.pbrt" ObjectEnd'
                         % (i, i, i))
        for i in range(MATERIALS):
            lines.append('MakeNamedMaterial "unused %d" "string type" "plastic" "texture Kd" "unused %d"' % (i, i % FILES))
        return "\n".join(lines) + "\n"

    def render(self, text, name):
        """The picture's bytes (their names differ), and the peak and the size after parsing, in MiB."""
        scene = os.path.join(self.folder, name + ".pbrt")
        with open(scene, "w", encoding="utf-8") as f:
            f.write(text)
        picture = os.path.join(self.folder, name + ".pfm")
        done = subprocess.run([WHIT, scene, "--spp", "4", "--outfile", picture, "--display", "none", "--stats"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        peak = re.search(r"peak memory (\d+) MiB", done.stderr)
        parsed = re.search(r"(\d+) MiB resident after parsing", done.stderr)
        with open(picture, "rb") as f:
            return f.read(), int(peak[1]), int(parsed[1])

    def test_it_costs_its_parsing(self):
        marker = "WorldBegin\n"
        self.assertIn(marker, self.scene)
        scene_among = self.scene.replace(marker, marker + self.unused(), 1)
        # Threads that meet by chance take a MiB more: the least of three is what it costs.
        alone, alone_peak, alone_parsed = min((self.render(self.scene, "alone") for _ in range(3)), key=rendering)
        among, among_peak, among_parsed = min((self.render(scene_among, "among") for _ in range(3)), key=rendering)
        self.assertEqual(alone, among)
        if not SANITIZED:
            # Two MiB for rounding: of whole ones each difference is off by up to one.
            self.assertLess(among_peak - among_parsed, alone_peak - alone_parsed + 0.05 * alone_peak + 2)

    def test_mistakes_in_it_are_found(self):
        # Not used is no reason not to be checked, and none to render nothing.
        text = self.scene.replace("WorldBegin\n", 'WorldBegin\nMakeNamedMaterial "unused" "string type" "mirror" '
                                  '"float Kr" [1]\nTexture "gone" "float" "imagemap" "string filename" "gone.png"\n', 1)
        scene = os.path.join(self.folder, "wrong.pbrt")
        with open(scene, "w", encoding="utf-8") as f:
            f.write(text)
        for command, code, severity in (("check", 1, "error"), ("render", 0, "warning")):
            flags = ["--spp", "1", "--outfile", self.folder + "/wrong.exr", "--display", "none"] if code == 0 else []
            done = subprocess.run([WHIT, command, scene, *flags], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertRegex(done.stderr, r'warning: parameter "Kr" of mirror')
            self.assertRegex(done.stderr, severity + r": cannot open .*gone.png")


if __name__ == "__main__":
    unittest.main()
