"""The portable build, which is the one for others, installed into a folder of its own."""
import os
import subprocess
import tempfile
import unittest

ROOT = os.environ.get("WHIT_SOURCE_DIR") or os.path.normpath(
    os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
PORTABLE = os.path.join(ROOT, "build", "portable")
BUILT = os.path.exists(os.path.join(PORTABLE, "share", "whit.1"))

MODULES = ["lib/whit/whit_http.so", "lib/whit/whit_oiio.so"]
# What must be there, each with some of its text.
TEXTS = {
    "share/man/man1/whit.1": ".TH WHIT 1",
    "share/bash-completion/completions/whit": "complete",
    "share/zsh/site-functions/_whit": "#compdef whit",
    "share/fish/vendor_completions.d/whit.fish": "complete -c whit",
    "share/whit/scenes/cornell-box.pbrt": "WorldBegin",
    "share/whit/scenes/include/cornell-walls.pbrt": "Shape",
    "share/doc/whit/README.md": "# whit",
    "share/doc/whit/LICENSE": "Apache License",
    "share/doc/whit/docs/install.md": "# ",
}


def run(*command, env=None, cwd=None, code=0):
    """What it said on standard output; anything else than `code` is a failure that shows all it said."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300, env=env, cwd=cwd,
                          stdin=subprocess.DEVNULL)
    if done.returncode != code:
        raise AssertionError("%s: exit code %d\n%s%s" % (command, done.returncode, done.stdout, done.stderr))
    return done.stdout


def run_paths(path):
    """Where the loader is told to look for a program's libraries."""
    lines = run("readelf", "-d", path).split("\n")
    return [line.split("[")[1].rstrip("]") for line in lines if "RPATH)" in line or "RUNPATH)" in line]


class Folder(unittest.TestCase):
    """With a folder that goes with the test, whose name has a space."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="whit install ")
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = cls.scratch.name

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def same_pictures(self, whit, scene):
        """What `whit` makes of a scene, as EXR and as the TIFF that a module writes, is what the build makes of it."""
        for program, folder in ((whit, "theirs"), (os.path.join(PORTABLE, "whit"), "built")):
            os.makedirs(self.path(folder), exist_ok=True)
            for name in ("out.exr", "out.tiff"):
                run(program, scene, "--spp", "1", "--quick", "--quiet", "-o", name, env={}, cwd=self.path(folder))
        for name in ("out.exr", "out.tiff"):
            with open(self.path("theirs", name), "rb") as a, open(self.path("built", name), "rb") as b:
                self.assertTrue(a.read() == b.read(), name)
