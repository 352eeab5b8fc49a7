"""whit --hand-out and --pass: shares of the passes of a render to an accuracy, by as many as there are and however they go about
it, are bit by bit the picture of one machine."""
import json
import os
import re
import subprocess
import tempfile
import unittest

from parts_scene import GAUSSIAN, LAYERS, LOOK, WORLD

WHIT = os.environ.get("WHIT", "")

# 45 x 31 pixels: no multiple of a tile.
SCENE = """Film "image" "integer xresolution" [45] "integer yresolution" [31] "string filename" "picture.exr"
""" + LOOK + """Sampler "%(sampler)s" "integer pixelsamples" [16]
%(options)s
""" + WORLD


@unittest.skipUnless(WHIT, "the program is not built")
class HandOut(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.write()

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, sampler="sobol", options=""):
        with open(self.path("scene.pbrt"), "w", encoding="utf-8") as f:
            f.write(SCENE % {"sampler": sampler, "options": options})

    def whit(self, *args, code=0):
        done = subprocess.run([WHIT, "scene.pbrt", *args], cwd=self.folder, capture_output=True, text=True, timeout=300,
                              check=False, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def share(self, said, k, n, *flags, code=0):
        """The name of a part."""
        name = f"part-{said['pass']}-{k}"
        self.whit(*flags, "--pass", said["file"], "--share", f"{k}/{n}", "--checkpoint", name, "--quiet", code=code)
        return name

    def decide(self, flags, pass_by_pass, outfile="shared.exr", code=0):
        """A farm of one: `pass_by_pass` makes the parts of each pass, and the lines to say. What was said on stderr."""
        with open(self.path("said"), "w+", encoding="utf-8") as said, subprocess.Popen(
                [WHIT, "scene.pbrt", *flags, "--hand-out", "passes", "--outfile", outfile, "--display", "none", "--quiet"],
                cwd=self.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=said, text=True) as process:
            for line in process.stdout:
                names = pass_by_pass(json.loads(line))
                if names is None:
                    process.stdin.close()
                    continue
                try:
                    process.stdin.write("".join(name + "\n" for name in names) + "\n")
                    process.stdin.flush()
                except BrokenPipeError:
                    break
            process.wait(timeout=60)
            said.seek(0)
            self.assertEqual(process.returncode, code, said.read())
            said.seek(0)
            return said.read()

    def same_files(self, first, second):
        with open(self.path(first), "rb") as a, open(self.path(second), "rb") as b:
            return a.read() == b.read()

    def test_shares_are_the_picture_of_one_machine(self):
        # Whole files are compared, headers too. What takes samples anew has sets of 16; wide filters share borders.
        cases = [("sobol", "", ["--target-error", "4%", *LAYERS]), ("random", GAUSSIAN, ["--target-error", "5%", *LAYERS]),
                 ("halton", "", ["--target-error", "6%", "--crop-pixels", "3,40,5,30", "--seed", "7"]),
                 ("sobol", GAUSSIAN, ["--target-error", "0.1%", "--max-samples", "21", "--type", "float"])]
        for sampler, options, flags in cases:
            with self.subTest(sampler=sampler, options=options, flags=flags):
                self.write(sampler, options)
                met = "--max-samples" not in flags
                self.whit(*flags, "--outfile", "whole.exr", "--display", "none", "--quiet", "--stats=whole.json",
                          code=0 if met else 5)
                passes = []

                def render(said):
                    passes.append(said)
                    n = min(1 + said["pass"] % 3, said["tiles"])
                    return [self.share(said, k, n, *flags) for k in range(n, 0, -1)]

                self.decide([*flags, "--stats=shared.json"], render, code=0 if met else 5)
                self.assertTrue(self.same_files("shared.exr", "whole.exr"))
                self.assertGreater(len(passes), 2)
                self.assertEqual(os.listdir(self.path("passes")), [])
                with open(self.path("whole.json"), encoding="utf-8") as a, open(self.path("shared.json"), encoding="utf-8") as b:
                    self.assertEqual(json.load(a)["rays"], json.load(b)["rays"])
                for name in os.listdir(self.folder):
                    if name.startswith("part-"):
                        os.remove(self.path(name))

    def test_the_one_who_decides_was_killed(self):
        flags = ["--target-error", "4%"]
        self.whit(*flags, "--outfile", "whole.exr", "--display", "none", "--quiet")

        def render(said):
            return [self.share(said, k, 2, *flags) for k in (1, 2)]

        said = self.decide([*flags, "--checkpoint", "state"], lambda s: render(s) if s["pass"] < 3 else None, "none.exr", 4)
        self.assertIn("standard input ended in pass 3", said)
        self.assertFalse(os.path.exists(self.path("none.exr")))
        for name in os.listdir(self.folder):
            if name.startswith("part-"):
                os.remove(self.path(name))
        self.decide([*flags, "--resume", "state"], render)
        self.assertTrue(self.same_files("shared.exr", "whole.exr"))
        # And one machine goes on where many were.
        for name in os.listdir(self.folder):
            if name.startswith("part-"):
                os.remove(self.path(name))
        self.decide([*flags, "--checkpoint", "other"], lambda s: render(s) if s["pass"] < 4 else None, "none.exr", 4)
        self.whit(*flags, "--resume", "other", "--outfile", "one.exr", "--display", "none", "--quiet")
        self.assertTrue(self.same_files("one.exr", "whole.exr"))

    def test_parts_that_are_none_of_a_pass_are_named(self):
        flags = ["--target-error", "4%"]
        first = {}

        def then(of_second):
            def render(said):
                if said["pass"] == 1:
                    names = [self.share(said, k, 2, *flags) for k in (1, 2)]
                    first["part"] = names[0]
                    return names
                return of_second(said)
            return render

        def damaged(said):
            name = self.share(said, 1, 2, *flags)
            with open(self.path(name), "rb") as f:
                data = f.read()
            with open(self.path(name), "wb") as f:
                f.write(data[:700] + bytes([data[700] ^ 1]) + data[701:])
            return [name]

        cases = [
            (lambda s: [self.share(s, 1, 2, *flags)], 2, r"not all of pass 2 is there: of 2 shares these are missing: 2"),
            (lambda s: [], 2, r"not all of pass 2 is there: no part was named"),
            (lambda s: [first["part"]], 2, r'"part-1-1" is of another render or of another pass: the pass is another one'),
            (lambda s: [self.share(s, 1, 2, *flags)] * 2, 2, r'share 1/2 is in "part-2-1" and in "part-2-1"'),
            (lambda s: [self.share(s, 1, 2, *flags), self.share(s, 2, 3, *flags)], 2,
             r'"part-2-2" is one of 3 shares, and "part-2-1" one of 2'),
            (damaged, 4, r'cannot join "part-2-1": it is damaged'),
            (lambda s: ["nothing"], 4, r'cannot join "nothing": No such file'),
            (lambda s: ["scene.pbrt"], 4, r'cannot join "scene.pbrt": it is no checkpoint'),
            (lambda s: [self.other()], 2, r'"other" is no share of a pass')]
        for of_second, code, words in cases:
            with self.subTest(words=words):
                self.assertRegex(self.decide(flags, then(of_second), "none.exr", code), words)
                self.assertFalse(os.path.exists(self.path("none.exr")))
                for name in os.listdir(self.folder):
                    if name.startswith("part-"):
                        os.remove(self.path(name))

    def other(self):
        self.whit("--checkpoint", "other", "--outfile", "none", "--quiet", "--spp", "1")
        return "other"

    def test_passes_of_others_are_refused(self):
        flags = ["--target-error", "4%"]

        def render(said):
            one = ["--pass", said["file"], "--share", "1/2", "--checkpoint", "p", "--quiet"]
            self.assertRegex(self.whit("--target-error", "5%", *one, code=2),
                             r'cannot take a share of "passes/pass-1", which is of another render: --target-error was 4% and is 5%')
            self.assertIn("--seed was none and is 3", self.whit(*flags, "--seed", "3", *one, code=2))
            with open(self.path(said["file"]), "rb") as f:
                data = f.read()
            with open(self.path("cut"), "wb") as f:
                f.write(data[:-9])
            self.assertIn('"cut": it is damaged', self.whit(*flags, "--pass", "cut", *one[2:], code=4))
            self.assertIn("it is no pass", self.whit(*flags, "--pass", "scene.pbrt", *one[2:], code=4))
            # What a share has kept goes on as that share, and as no other.
            part = self.share(said, 1, 2, *flags)
            self.whit(*flags, "--pass", said["file"], "--share", "1/2", "--resume", part, "--quiet")
            self.assertIn("the share was 1/2 and is 2/2",
                          self.whit(*flags, "--pass", said["file"], "--share", "2/2", "--resume", part, "--quiet", code=2))
            with open(self.path("scene.pbrt"), "a", encoding="utf-8") as f:
                f.write("# a change\n")
            self.assertIn("the scene's text is another one", self.whit(*flags, *one, code=2))
            return None

        self.decide(flags, render, code=4)
        self.assertRegex(self.merge("part-1-1"), "of a render to an accuracy, whose samples are of no fixed number")

    def merge(self, *parts):
        return subprocess.run([WHIT, "merge", *parts, "-o", "m.exr"], cwd=self.folder, capture_output=True, text=True,
                              check=False).stderr

    def test_flags_that_make_no_sense(self):
        target, part = ["--target-error", "1%"], ["--pass", "p", "--share", "1/2"]
        for flags, words in (
                (["--hand-out", "f"], "is of a render to a --target-error"), ([*part, "--checkpoint", "c"], "is of a render to"),
                ([*target, "--time-limit", "1s", "--hand-out", "f"], "no clock"), ([*target, "--pass", "p"], "belong together"),
                ([*target, "--share", "1/2"], "belong together"), ([*target, *part, "--hand-out", "f"], "a command of its own"),
                ([*target, *part], "--checkpoint names the file"), ([*target, *part, "--checkpoint", "c", "-o", "a.exr"],
                                                                    "makes no picture"),
                ([*target, *part, "--checkpoint", "c", "--json", "-"], "makes no picture"),
                ([*target, "--hand-out", "f", "--json", "-"], "on standard output"),
                ([*target, "--hand-out", "f", "--stats", "-"], "on standard output"),
                ([*target, "--hand-out", "f", "--sandbox"], "cannot know"),
                *(([*target, "--pass", "p", "--checkpoint", "c", "--share", s], "is no share")
                  for s in ("0/2", "3/2", "1", "1/", "/2", "a/b", "1/2x", "1/99999999"))):
            with self.subTest(flags=flags):
                self.assertIn(words, self.whit(*flags, code=2))

    def test_it_stops_when_asked_to(self):
        # With what there is, as one machine: the picture of the first pass.
        def render(said):
            return [self.share(said, 1, 1, "--target-error", "1%")] if said["pass"] == 1 else None

        with subprocess.Popen([WHIT, "scene.pbrt", "--target-error", "1%", "--hand-out", "passes", "--outfile", "s.exr", "--display",
                               "none"], cwd=self.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            for name in render(json.loads(process.stdout.readline())):
                process.stdin.write(name + "\n\n")
                process.stdin.flush()
            process.stdout.readline()
            process.terminate()
            said = process.stderr.read()
            self.assertEqual(process.wait(timeout=60), 5, said)
        self.assertIn("stopped by SIGTERM", said)
        self.assertTrue(re.search(r"4\.0 samples per pixel", said), said)
        self.assertTrue(os.path.exists(self.path("s.exr")))


if __name__ == "__main__":
    unittest.main()
