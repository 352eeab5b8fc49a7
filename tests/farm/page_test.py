"""docs/farm.md: its commands run as they stand, but for those that want a cluster."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python"))
import package  # noqa: E402  (finds the package)

CLUSTERS = ("--scheduler", "--cluster")


class Page(unittest.TestCase):
    def test_the_commands(self):
        with open(os.path.join(package.ROOT, "docs", "farm.md"), encoding="utf-8") as f:
            blocks = re.findall(r"(?ms)^```sh\n(.*?)^```$", f.read())
        self.assertEqual(len(blocks), 2)
        lines = [line for block in blocks for line in block.splitlines() if not any(c in line for c in CLUSTERS)]
        self.assertGreater(len(lines), 6)
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "scene.pbrt"), "w", encoding="utf-8") as f:
                f.write(package.SCENE.replace('"integer pixelsamples" [4]', '"integer pixelsamples" [128]'))
            os.mkdir(os.path.join(folder, "bin"))
            for name, command in (("whit", package.WHIT), ("whit-farm", f"{sys.executable} -m whit.farm")):
                path = os.path.join(folder, "bin", name)
                with open(path, "w", encoding="utf-8") as f:
                    f.write(f'#!/bin/sh\nexec {command} "$@"\n')
                os.chmod(path, 0o755)
            environment = {**os.environ, "PATH": os.path.join(folder, "bin") + ":" + os.environ["PATH"], "WHIT": package.WHIT,
                           "PYTHONPATH": package.FOLDER}
            for line in lines:
                with self.subTest(line):
                    done = subprocess.run(["bash", "-c", line], cwd=folder, env=environment, capture_output=True, text=True,
                                          check=False, timeout=300)
                    self.assertEqual(done.returncode, 0, done.stderr)
            for name in ("picture.exr", "a.part", "b.part", "job.sh"):
                self.assertGreater(os.path.getsize(os.path.join(folder, name)), 100, name)


if __name__ == "__main__":
    unittest.main()
