"""Standard output on a device that is full: every command says so and exits with 4, with nothing lost of what it says on
stderr."""
import os
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT", "")
SCENE = 'Film "image" "integer xresolution" 4 "integer yresolution" 4\nWorldBegin\nShape "sphere"\nWorldEnd\n'


@unittest.skipUnless(WHIT and os.path.exists("/dev/full"), "the program is not built, or there is no /dev/full")
class FullOutput(unittest.TestCase):
    def test_every_command_that_prints(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "a.pbrt"), "w", encoding="utf-8") as f:
                f.write(SCENE)
            subprocess.run([WHIT, "a.pbrt", "--quiet"], cwd=folder, check=True)
            for command in (["help"], ["help", "matte"], ["help", "--json"], ["help", "--man"], ["help", "--completion", "bash"],
                            ["--help"], ["--version"], ["version"], ["render", "--help"], ["a.pbrt", "--cat"],
                            ["a.pbrt", "--toply"], ["fmt", "a.pbrt"], ["explain", "a.pbrt"], ["explain", "a.pbrt", "--json"],
                            ["explain", "a.pbrt", "--memory"], ["check", "a.pbrt", "--json"], ["check", "--list"],
                            ["check", "--files", "a.pbrt"], ["diff", "a.exr", "a.exr"], ["diff", "a.exr", "a.exr", "--json"],
                            ["a.pbrt", "--debug-pixel", "1,1"]):
                with open("/dev/full", "wb") as full:
                    done = subprocess.run([WHIT, *command], cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True,
                                          timeout=120, check=False)
                self.assertEqual(done.returncode, 4, (command, done.stderr))
                self.assertIn("cannot write", done.stderr, command)


if __name__ == "__main__":
    unittest.main()
