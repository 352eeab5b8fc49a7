#!/usr/bin/env python3
"""`cmake --install` of the portable build: what is there, that it runs from wherever it is moved to without the build, and
that it makes the build's pictures."""
import os
import select
import shutil
import subprocess
import unittest

import installed


class Install(installed.Folder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        before = os.path.join(cls.folder, "before")
        installed.run("cmake", "--install", installed.PORTABLE, "--prefix", before)
        # Nothing may know where it was installed to.
        cls.prefix = os.path.join(cls.folder, "prefix")
        os.rename(before, cls.prefix)
        cls.whit = os.path.join(cls.prefix, "bin", "whit")

    def test_what_is_there(self):
        for name, words in installed.TEXTS.items():
            with open(os.path.join(self.prefix, name), encoding="utf-8") as f:
                self.assertIn(words, f.read(), name)
        # Everything lies where a distribution expects it.
        for where, _, names in os.walk(self.prefix):
            for name in names:
                file = os.path.relpath(os.path.join(where, name), self.prefix)
                self.assertTrue(file in ["bin/whit"] + installed.MODULES or file.startswith("share/"), file)

    def test_the_loader_looks_beside_the_program_alone(self):
        self.assertEqual(installed.run_paths(self.whit), ["$ORIGIN/../lib/whit"])
        for module in installed.MODULES:
            self.assertEqual(installed.run_paths(os.path.join(self.prefix, module)), [])

    def test_the_scenes_are_whole(self):
        scenes = [os.path.join(where, name) for where, _, names in os.walk(self.prefix + "/share/whit/scenes")
                  for name in names if name.endswith(".pbrt") and os.path.basename(where) != "include"]
        self.assertGreater(len(scenes), 15)
        # 1: it has something to say. 3: an error, as a file that is missing.
        said = subprocess.run([self.whit, "check", *scenes], capture_output=True, text=True, check=False, env={}, timeout=100)
        self.assertIn(said.returncode, (0, 1), said.stderr)

    def test_the_same_pictures(self):
        self.same_pictures(self.whit, self.prefix + "/share/whit/scenes/cornell-box.pbrt")

    def test_the_modules_are_found_in_a_sandbox_too(self):
        installed.run(self.whit, self.prefix + "/share/whit/scenes/cornell-box.pbrt", "--quick", "--quiet", "--sandbox", "-o",
                      "out.tiff", env={}, cwd=self.folder)
        self.assertTrue(os.path.exists(self.path("out.tiff")))

    def test_watch_finds_its_server(self):
        watch = subprocess.Popen([self.whit, "watch", self.prefix + "/share/whit/scenes/cornell-box.pbrt"], env={},
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        with watch:
            ready, _, _ = select.select([watch.stdout], [], [], 60)
            address = watch.stdout.readline() if ready else ""
            watch.kill()
            self.assertTrue(address.startswith("http://"), watch.stderr.read())


if __name__ == "__main__":
    if not installed.BUILT or not shutil.which("cmake"):
        print("build/portable is not built, or there is no cmake")
        raise SystemExit(77)
    unittest.main()
