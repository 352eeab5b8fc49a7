"""--sandbox: whole commands on scenes that reach out. tests/tools/sandbox_test.cpp has the kernel's own answers; here the
same command without the flag succeeds, so that it is the sandbox that says no."""
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT", "")
# The sanitizers' search for leaks stops the program from outside, which is what a sandbox forbids.
os.environ["ASAN_OPTIONS"] = ":".join(filter(None, (os.environ.get("ASAN_OPTIONS"), "detect_leaks=0")))
SOURCE = os.environ.get("WHIT_SOURCE_DIR", "")

SCENE = """Film "image" "integer xresolution" [16] "integer yresolution" [16] "string filename" "{film}"
Camera "perspective" "float fov" [50]
WorldBegin
LightSource "point" "point from" [0 0 0]
{body}
Translate 0 0 4
Shape "sphere"
WorldEnd
"""
TEXTURE = 'Texture "t" "color" "imagemap" "string filename" "{}"\nMaterial "matte" "texture Kd" "t"\n'
MESH = 'Shape "plymesh" "string filename" "{}"\n'
PLY = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 9\n1 0 9\n0 1 9\n3 0 1 2\n")


@unittest.skipUnless(WHIT, "the program is not built")
class Sandbox(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = os.path.realpath(folder.name)
        for name in ("scene", "out", "other"):
            os.mkdir(self.path(name))
        picture = os.path.join(SOURCE, "tests", "field", "half-grey.png")
        for name in ("scene/t.png", "other/t.png"):
            shutil.copy(picture, self.path(name))
        for name in ("scene/a.ply", "other/a.ply"):
            self.write(name, PLY)
        self.write("other/more.pbrt", 'Material "matte"\n')

        code, said = self.render("", "--sandbox")
        if "cannot take files away" in said:
            self.assertEqual(code, 4)
            self.skipTest("this kernel has no Landlock, and the sandbox is refused")

    def path(self, name):
        return os.path.join(self.root, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as f:
            f.write(text)

    def run_whit(self, *args):
        done = subprocess.run([WHIT, *args], cwd=self.path("out"), capture_output=True, text=True, timeout=120,
                              check=False)
        return done.returncode, done.stderr

    def render(self, body, *flags, film="picture.exr"):
        self.write("scene/scene.pbrt", SCENE.format(body=body, film=film))
        return self.run_whit("../scene/scene.pbrt", "--quiet", *flags)

    def test_what_is_below_is_rendered(self):
        self.assertEqual(self.render(TEXTURE.format("t.png") + MESH.format("a.ply")), (0, ""))
        with open(self.path("out/picture.exr"), "rb") as f:
            outside = f.read()
        self.assertEqual(self.render(TEXTURE.format("t.png") + MESH.format("a.ply"), "--sandbox"), (0, ""))
        with open(self.path("out/picture.exr"), "rb") as f:
            self.assertEqual(f.read(), outside)

    def test_what_reaches_out_is_refused(self):
        os.symlink(self.path("other"), self.path("scene/link"))
        for body in (f'Include "{self.path("other/more.pbrt")}"', 'Include "../other/more.pbrt"', 'Include "link/more.pbrt"',
                     MESH.format(self.path("other/a.ply")), MESH.format("link/a.ply"),
                     TEXTURE.format(self.path("other/t.png")), TEXTURE.format("../other/t.png"),
                     TEXTURE.format("link/t.png")):
            self.assertEqual(self.render(body), (0, ""), body)
            code, said = self.render(body, "--sandbox")
            self.assertEqual(code, 4, body)
            self.assertRegex(said, "Permission denied", body)
            self.assertIn("--allow PATH adds to that", said)
            self.assertEqual(self.render(body, "--sandbox", "--allow", self.path("other")), (0, ""), body)
        code, said = self.render('Include "/etc/passwd"', "--sandbox")
        self.assertEqual(code, 4)
        self.assertRegex(said, '"/etc/passwd": Permission denied')

    def test_pictures_elsewhere_are_refused(self):
        elsewhere = self.path("other/picture.exr")
        code, said = self.render("", "--sandbox", film=elsewhere)
        self.assertEqual((code, os.path.exists(elsewhere)), (4, False))
        self.assertRegex(said, "Permission denied")
        self.assertEqual(self.render("", "--sandbox", "-o", elsewhere), (0, ""))
        self.assertTrue(os.path.exists(elsewhere))

    def test_wrong_usage(self):
        for flags, said in ((["--allow", "."], "--sandbox lets be read"), (["--sandbox", "--allow", "none"], "there is no"),
                            (["--sandbox", "--display-server", "h:1"], "forbids")):
            code, text = self.render("", *flags)
            self.assertEqual(code, 2)
            self.assertIn(said, text)

    def test_import(self):
        model = '{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"name": "n"}], "buffers": [%s]}'
        self.write("scene/good.gltf", model % "")
        self.assertEqual(self.run_whit("import", "../scene/good.gltf", "-o", "good.pbrt", "--sandbox", "--quiet")[0], 0)
        code, said = self.run_whit("import", "../scene/good.gltf", "-o", self.path("out/x.pbrt"), "--sandbox", "--allow", "none")
        self.assertEqual(code, 2, said)

    def test_watch(self):
        self.write("scene/scene.pbrt", SCENE.format(body='Include "../other/more.pbrt"', film="picture.exr"))
        process = subprocess.Popen([WHIT, "watch", "../scene/scene.pbrt", "--sandbox"], cwd=self.path("out"),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        try:
            self.assertRegex(process.stdout.readline(), "http://127.0.0.1:")
            with open(f"/proc/{process.pid}/status", encoding="ascii") as f:
                status = f.read()
            # 2: a filter of system calls, by the kernel's account.
            self.assertEqual(re.search(r"Seccomp:\s+(\d)", status)[1], "2")
            self.assertEqual(re.search(r"NoNewPrivs:\s+(\d)", status)[1], "1")
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(timeout=60)

    def test_the_list_of_files(self):
        self.write("scene/scene.pbrt", SCENE.format(body=TEXTURE.format("t.png") + MESH.format("../other/a.ply") +
                                                    'Include "part.pbrt"', film="picture.exr"))
        self.write("scene/part.pbrt", 'Shape "sphere"\n')
        done = subprocess.run([WHIT, "check", "--files", "scene/scene.pbrt"], cwd=self.root, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        listed = [line.split(" ", 1) for line in done.stdout.splitlines()]
        read = {os.path.realpath(os.path.join(self.root, name)) for kind, name in listed if kind == "read"}
        self.assertEqual(read, {self.path(p) for p in ("scene/scene.pbrt", "scene/part.pbrt", "scene/t.png", "other/a.ply")})
        self.assertEqual([name for kind, name in listed if kind == "write"], ["picture.exr", "picture.png"])


if __name__ == "__main__":
    unittest.main()
