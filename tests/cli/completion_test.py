#!/usr/bin/env python3
"""Shell completion and the manual page: what bash offers, and that all are well-formed where programs that tell are there."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")


def run(*arguments, **more):
    return subprocess.run(arguments, capture_output=True, text=True, timeout=60, check=False, **more)


@unittest.skipUnless(WHIT, "the program is not built")
class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def whit(self, *arguments):
        done = run(WHIT, *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""), arguments)
        return done.stdout

    def file(self, name, text=""):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
        return path

    def script(self, shell):
        return self.file("completion." + shell, self.whit("help", "--completion", shell))


@unittest.skipUnless(shutil.which("bash"), "there is no bash")
class Bash(Case):
    def setUp(self):
        super().setUp()
        self.completion = self.script("bash")
        for name in ("here/scene.pbrt", "here/a model.glb", "here/picture.exr", "here/notes.txt", "here/sub/more.pbrt"):
            self.file(name)

    def offered(self, line):
        """What bash offers for the last word of a line, as readline splits it: also at each '='."""
        words = [w for w in re.split(r"\s|(=)", line) if w]
        if line.endswith(" "):
            words.append("")
        program = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _whit; printf "%s\\n" "${COMPREPLY[@]}"'
        done = run("bash", "--norc", "-c", program, "bash", self.completion, *words, cwd=self.folder + "/here")
        self.assertEqual((done.returncode, done.stderr), (0, ""), line)
        return sorted(filter(None, done.stdout.split("\n")))

    def test_commands(self):
        self.assertEqual(self.offered("whit che"), ["check"])
        self.assertEqual(self.offered("whit ver"), ["version"])
        # At the first place scenes too, which need no command.
        self.assertEqual(self.offered("whit s"), ["scene.pbrt", "sub"])
        self.assertTrue({"render", "check", "diff", "help"} <= set(self.offered("whit ")))

    def test_flags_are_those_of_the_command(self):
        self.assertEqual(self.offered("whit fmt --in"), ["--in-place"])
        self.assertEqual(self.offered("whit scene.pbrt --outf"), ["--outfile"])
        self.assertEqual(self.offered("whit --outf"), ["--outfile"])
        self.assertEqual(self.offered("whit render --keep"), ["--keep-going"])
        self.assertEqual(self.offered("whit fmt --keep"), [])
        self.assertIn("--help", self.offered("whit cost --"))
        # All of them: what --help lists.
        for command in ("render", "check", "fmt", "explain", "cost", "import", "diff", "bench", "help"):
            lines = [line.split() for line in self.whit(command, "--help").splitlines() if line.startswith("  -")]
            listed = {flag for words in lines for flag in words[0].split(",") if flag.startswith("--")}
            self.assertGreater(len(listed), 1, command)
            self.assertEqual(listed - set(self.offered("whit %s --" % command)), set(), command)

    def test_values(self):
        effects = {e["name"] for e in json.loads(self.whit("help", "--json"))["effects"]}
        self.assertEqual(set(self.offered("whit scene.pbrt --without ")), effects)
        self.assertEqual(self.offered("whit scene.pbrt --without depth"), ["depth-of-field"])
        self.assertEqual(self.offered("whit scene.pbrt --without=depth"), ["depth-of-field"])
        self.assertEqual(set(self.offered("whit scene.pbrt --without=")), effects)
        self.assertEqual(self.offered("whit scene.pbrt --only shadows,bum"), ["shadows,bump"])
        self.assertEqual(self.offered("whit scene.pbrt --aov N,albe"), ["N,albedo"])
        self.assertEqual(self.offered("whit scene.pbrt --traversal "), ["fast", "robust"])
        self.assertEqual(self.offered("whit scene.pbrt --integrator whi"), ["whitted"])
        self.assertEqual(self.offered("whit explain scene.pbrt --sampler sob"), ["sobol"])
        self.assertEqual(self.offered("whit scene.pbrt --spp "), [])
        self.assertEqual(self.offered("whit bench --only cor"), ["cornell"])
        self.assertEqual(self.offered("whit help image"), ["image", "imagemap"])
        self.assertEqual(self.offered("whit help texture image"), ["image", "imagemap"])
        self.assertEqual(self.offered("whit help --completion z"), ["zsh"])

    def test_files(self):
        self.assertEqual(self.offered("whit check "), ["a model.glb", "scene.pbrt", "sub"])
        self.assertEqual(self.offered("whit check sub/"), ["sub/more.pbrt"])
        self.assertEqual(self.offered("whit scene.pbrt -o "), ["picture.exr", "sub"])
        self.assertEqual(self.offered("whit import "), ["a model.glb", "sub"])
        self.assertEqual(self.offered("whit diff "), ["a model.glb", "notes.txt", "picture.exr", "scene.pbrt", "sub"])
        self.assertEqual(self.offered("whit scene.pbrt --logdir "), ["sub"])

    def test_it_is_well_formed(self):
        self.assertEqual(run("bash", "-n", self.completion).stderr, "")
        if shutil.which("shellcheck"):
            done = run("shellcheck", "-s", "bash", "-e", "SC2207", self.completion)
            self.assertEqual(done.stdout, "")


class OtherShells(Case):
    def test_zsh(self):
        if not shutil.which("zsh"):
            self.skipTest("there is no zsh")
        done = run("zsh", "-n", self.script("zsh"))
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_fish(self):
        if not shutil.which("fish"):
            self.skipTest("there is no fish")
        script = self.script("fish")
        done = run("fish", "--no-execute", script)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for line, wanted in (("whit che", "check"), ("whit s.pbrt --without depth", "depth-of-field"),
                             ("whit fmt --in", "--in-place"), ("whit s.pbrt --aov N,albe", "N,albedo")):
            done = run("fish", "--no-config", "-c", "source $argv[1]; complete -C $argv[2]", script, line)
            self.assertIn(wanted, [w.split("\t")[0] for w in done.stdout.splitlines()], line)

    def test_an_unknown_shell(self):
        done = run(WHIT, "help", "--completion", "tcsh")
        self.assertEqual(done.returncode, 2)
        self.assertIn("bash", done.stderr)


class Manual(Case):
    def test_it_has_every_command_and_flag(self):
        page = self.whit("help", "--man")
        text = page.replace("\\-", "-")
        known = json.loads(self.whit("help", "--json"))
        for thing in known["effects"] + known["aovs"]:
            self.assertIn("\\fB%s\\fR\n" % thing["name"], text)
        for command in ("render", "check", "fmt", "explain", "cost", "import", "diff", "bench", "help"):
            self.assertIn('.SS "whit %s' % ("[render]" if command == "render" else command), text)
        for flag in ("--outfile", "--keep-going", "--in-place", "--html", "--completion"):
            self.assertIn("\\fB%s\\fR" % flag, text)

    def test_it_is_well_formed(self):
        page = self.file("whit.1", self.whit("help", "--man"))
        looked = False
        if shutil.which("groff"):
            done = run("groff", "-man", "-ww", "-Tutf8", "-z", page)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            looked = True
        if shutil.which("mandoc"):
            done = run("mandoc", "-T", "lint", "-W", "warning", page)
            self.assertEqual([line for line in done.stdout.splitlines() if "missing date" not in line], [])
            looked = True
        if shutil.which("man"):
            done = run("man", "--warnings", "-l", page, env={**os.environ, "MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("EXIT STATUS", done.stdout)
            looked = True
        if not looked:
            self.skipTest("there is neither groff nor mandoc nor man")


if __name__ == "__main__":
    if not WHIT:
        raise SystemExit(77)
    unittest.main()
