#!/usr/bin/env python3
"""`cmake --install`: what is installed runs from there, and brings its manual page and completions along."""
import os
import shutil
import subprocess
import tempfile
import unittest

BUILD = os.environ.get("WHIT_BINARY_DIR", "")
WHIT = os.environ.get("WHIT")

SCENE = """\
Film "image" "integer xresolution" [8] "integer yresolution" [8]
Camera "perspective"
WorldBegin
  LightSource "distant"
  Shape "sphere"
WorldEnd
"""


class Install(unittest.TestCase):
    def test_what_is_installed_works(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix = os.path.join(folder, "prefix")
            done = subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], capture_output=True, text=True,
                                  timeout=60, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            files = sorted(os.path.relpath(os.path.join(where, name), prefix)
                           for where, _, names in os.walk(prefix) for name in names)
            for name in ("bin/whit", "share/man/man1/whit.1", "share/bash-completion/completions/whit",
                         "share/zsh/site-functions/_whit", "share/fish/vendor_completions.d/whit.fish"):
                self.assertIn(name, files)
                self.assertGreater(os.path.getsize(os.path.join(prefix, name)), 1000, name)
            for module in ("whit_oiio.so", "whit_http.so"):
                self.assertTrue(any(f.startswith("lib") and f.endswith("/whit/" + module) for f in files), files)
            scene = os.path.join(folder, "scene.pbrt")
            with open(scene, "w", encoding="utf-8") as f:
                f.write(SCENE)
            # A .tiff is written by the module, which the installed program must find beside its own place; not in the
            # build folder, whose path it has no longer.
            moved = os.path.join(folder, "moved")
            os.rename(prefix, moved)
            whit = os.path.join(moved, "bin", "whit")
            # Debugging information, which a build with sanitizers has, may name it; the loader must not look there.
            dynamic = subprocess.run(["readelf", "-d", whit], capture_output=True, text=True, timeout=60, check=True).stdout
            paths = [line for line in dynamic.split("\n") if "PATH)" in line]
            self.assertEqual(len(paths), 1, dynamic)
            self.assertNotIn(os.path.realpath(BUILD), paths[0])
            done = subprocess.run([whit, scene, "--quiet", "-o", os.path.join(folder, "out.tiff")], capture_output=True,
                                  text=True, timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertTrue(os.path.exists(os.path.join(folder, "out.tiff")))


if __name__ == "__main__":
    if not WHIT or not shutil.which("cmake") or not os.path.exists(os.path.join(BUILD, "share", "whit.1")):
        print("the program and its texts are not built, or there is no cmake")
        raise SystemExit(77)
    unittest.main()
