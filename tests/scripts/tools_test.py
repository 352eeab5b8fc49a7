#!/usr/bin/env python3
"""The shell scripts in tools/: they parse, say what is wrong, and count right. Programs they call are made up here."""
import glob
import os
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def shell_scripts():
    for path in sorted(glob.glob(ROOT + "/tools/*") + [ROOT + "/.ci/run"]):
        if os.path.isfile(path):
            with open(path, "rb") as f:
                if f.readline().rstrip().endswith(b"bash"):
                    yield path


def run(*command, path=None, **environment):
    """Exit code and everything said; `path` is a folder of made-up programs that come first."""
    env = {**os.environ, **environment}
    if "WHIT_SKIP_DEPS" not in environment:
        env.pop("WHIT_SKIP_DEPS", None)  # What whoever runs the tests has set is not what is tested.
    if path:
        env["PATH"] = path + os.pathsep + env["PATH"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True,
                          env=env, check=False)
    return done.returncode, done.stdout


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)
    os.chmod(path, 0o755)


class Temporary(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit tools ")  # a path with spaces
        os.chmod(self.folder, 0o755)
        self.addCleanup(shutil.rmtree, self.folder)
        self.programs = os.path.join(self.folder, "bin")

    def program(self, name, script):
        write(os.path.join(self.programs, name), "#!/bin/bash\n" + script)

    def copy(self, name):
        path = os.path.join(self.folder, "repository", name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        shutil.copy(os.path.join(ROOT, name), path)
        return path


class Scripts(unittest.TestCase):
    def test_they_parse(self):
        scripts = list(shell_scripts())
        self.assertGreaterEqual(len(scripts), 6)
        for path in scripts:
            self.assertEqual(run("bash", "-n", path), (0, ""))
            self.assertTrue(os.access(path, os.X_OK), path)

    @unittest.skipUnless(shutil.which("shellcheck"), "shellcheck is not installed")
    def test_shellcheck(self):
        self.assertEqual(run("shellcheck", "--severity=warning", *shell_scripts()), (0, ""))


class InstallDeps(Temporary):
    def test_groups(self):
        code, said = run(ROOT + "/tools/install-deps", "--list", "build")
        self.assertEqual(code, 0)
        self.assertIn("libembree-dev", said.split())
        self.assertNotIn("libgtest-dev", said.split())
        code, said = run(ROOT + "/tools/install-deps", "nonsense")
        self.assertEqual(code, 1)
        self.assertIn("unknown group 'nonsense'", said)

    def test_silent_when_all_is_there(self):
        self.program("dpkg-query", 'for p in "$@"; do [[ $p == -* ]] || printf "installed:%s " "$p"; done\n')
        self.program("apt-get", "echo called; exit 1\n")
        self.assertEqual(run(ROOT + "/tools/install-deps", path=self.programs), (0, ""))

    def test_skipped_on_request(self):
        self.program("dpkg-query", "exit 1\n")
        self.assertEqual(run(ROOT + "/tools/install-deps", path=self.programs, WHIT_SKIP_DEPS="1"), (0, ""))

    @unittest.skipUnless(os.geteuid() == 0, "needs root")
    def test_installs_what_is_missing_only(self):
        self.program("dpkg-query", 'for p in "$@"; do [[ $p == -* || $p == cmake ]] || printf "installed:%s " "$p"; done\n')
        self.program("apt-get", 'echo "$DEBIAN_FRONTEND $*" >>"%s/calls"\n' % self.folder)
        code, said = run(ROOT + "/tools/install-deps", path=self.programs)
        self.assertEqual(code, 0)
        self.assertIn("installing cmake\n", said)
        with open(self.folder + "/calls", encoding="utf-8") as f:
            update, install = f.read().splitlines()
        self.assertTrue(update.startswith("noninteractive ") and update.endswith(" update"), update)
        self.assertTrue(install.endswith(" install --no-install-recommends cmake"), install)

    @unittest.skipUnless(os.geteuid() == 0, "needs root")
    def test_node_of_another_maker_is_enough(self):
        # As NodeSource's, with which Debian's npm conflicts: dpkg knows no package npm then, and perhaps no nodejs.
        self.program("node", "")
        self.program("npm", "")
        self.program("dpkg-query", 'for p in "$@"; do [[ $p == -* || $p == nodejs || $p == npm ]] || printf "installed:%s " "$p"; done\n')
        self.program("apt-get", "echo called; exit 1\n")
        self.assertEqual(run(ROOT + "/tools/install-deps", "dev", path=self.programs), (0, ""))
        # The list is that of a plain Debian.
        self.assertIn("npm", run(ROOT + "/tools/install-deps", "--list", "dev", path=self.programs)[1].split())

    @unittest.skipUnless(os.geteuid() == 0, "needs root")
    def test_apt_fails(self):
        self.program("dpkg-query", "exit 1\n")
        self.program("apt-get", '[[ $* != *update* ]] || { echo "cannot resolve the host"; exit 100; }\n')
        code, said = run(ROOT + "/tools/install-deps", path=self.programs)
        self.assertEqual(code, 1)
        self.assertIn("cannot resolve the host", said)
        self.assertIn("'apt-get update' failed", said)

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "needs root and setpriv")
    def test_neither_root_nor_sudo(self):
        script = self.copy("tools/install-deps")
        for name in ("bash", "env", "mktemp", "rm", "tail"):
            self.program(name, "exec %s \"$@\"\n" % shutil.which(name))
        self.program("dpkg-query", "exit 1\n")
        self.program("apt-get", "exit 1\n")
        nobody = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "env", "PATH=" + self.programs]
        code, said = run(*nobody, "/bin/bash", script, "build")
        self.assertEqual(code, 1)
        self.assertIn("neither root nor is there a sudo", said)
        self.assertIn("libembree-dev", said)
        self.program("sudo", "exit 1\n")
        code, said = run(*nobody, "/bin/bash", script, "build")
        self.assertEqual(code, 1)
        self.assertIn("sudo wants a password", said)


class Render(Temporary):
    def test_without_a_scene(self):
        code, said = run(ROOT + "/tools/render")
        self.assertEqual(code, 2)
        self.assertIn("tools/render SCENE.pbrt", said)

    def test_from_any_folder_with_any_name(self):
        script = self.copy("tools/render")
        write(self.folder + "/repository/tools/install-deps", "#!/bin/bash\n")
        write(self.folder + "/repository/tools/build-release", "#!/bin/bash\n")
        write(self.folder + "/repository/build/release/whit", '#!/bin/bash\nprintf "<%s>" "$PWD" "$@"\nexit 5\n')
        here = os.path.join(self.folder, "some where")
        os.mkdir(here)
        done = subprocess.run([script, "a scene.pbrt", "--spp", "4"], cwd=here, stdout=subprocess.PIPE, text=True,
                              check=False)
        self.assertEqual((done.returncode, done.stdout), (5, "<%s><a scene.pbrt><--spp><4>" % here))

    def test_nothing_is_rendered_when_the_build_fails(self):
        script = self.copy("tools/render")
        write(self.folder + "/repository/tools/install-deps", "#!/bin/bash\n")
        write(self.folder + "/repository/tools/build-release", "#!/bin/bash\necho broken; exit 1\n")
        write(self.folder + "/repository/build/release/whit", "#!/bin/bash\necho old program\n")
        self.assertEqual(run(script, "a.pbrt"), (1, "broken\n"))


class BuildRelease(Temporary):
    """tools/build-release with made-up cmake and ninja."""

    def build(self, dry, ninja):
        script = self.copy("tools/build-release")
        self.copy("CMakePresets.json")
        self.program("cmake", 'mkdir -p build/release; : >build/release/build.ninja\n'
                     'printf "CMAKE_HOME_DIRECTORY:INTERNAL=%s\\nWHIT_TESTS:BOOL=OFF\\n" "$PWD" '
                     '>build/release/CMakeCache.txt\n')
        self.program("nproc", "echo 2\n")
        self.program("ninja", 'for a in "$@"; do [[ $a != -n ]] || { %s exit 0; }; done\n%s' % (dry, ninja))
        return run(script, "whit", path=self.programs)

    def test_it_says_beforehand_how_long_it_may_take(self):
        code, said = self.build("echo '[190/190] Linking';", "echo '[190/190] Linking'\n")
        self.assertEqual(code, 0)
        # 190 steps of 3 s on 2 cores are 285 s.
        self.assertIn("190 steps, which may take about 5 minutes on 2 cores\n", said)
        self.assertRegex(said, r"built in \d+ s\n")  # seconds, on a machine that is busy

    def test_silent_when_nothing_is_to_do(self):
        nothing = "echo 'ninja: no work to do.'"
        self.build(nothing + ";", nothing + "\n")
        script = self.folder + "/repository/tools/build-release"
        self.assertEqual(run(script, "whit", path=self.programs), (0, ""))

    def test_a_failure_shows_the_compilers_words(self):
        code, said = self.build("echo '[9/9] x';", "echo '[1/9] Building a'; echo 'a.cpp:1: error: no'; exit 1\n")
        self.assertEqual(code, 1)
        self.assertIn("a.cpp:1: error: no\nthe build failed\n", said)
        self.assertNotIn("Building a", said)


class Summary(Temporary):
    """tools/test with made-up checks, build and ctest."""

    def result(self, *arguments, includes="", build="", junit='tests="5" failures="0" disabled="0" skipped="0"', log="", status=0):
        script = self.copy("tools/test")
        for name, body in {"install-deps": "", "check-includes": includes, "check-format": "",
                           "build-release": build}.items():
            write(self.folder + "/repository/tools/" + name, "#!/bin/bash\n" + body)
        self.program("ctest", """
while [[ $# -gt 0 ]]; do [[ $1 != --output-junit ]] || out=$2; shift; done
printf '<?xml version="1.0"?>\\n<testsuite name="x"\\n\\t%s\\n\\thostname="">\\n\\t<testcase name="failures=7"/>\\n' '{}' >"$out"
printf '%s' '{}'
exit {}
""".format(junit, log, status))
        code, said = run(script, *(arguments or ("-R", "some")), path=self.programs)
        return code, said, said.splitlines()[-1]

    def test_all_is_well(self):
        code, _, last = self.result()
        self.assertEqual((code, last), (0, "7 passed, 0 failed"))

    def test_the_quick_tests_run_again_with_sanitizers(self):
        code, said, last = self.result("", build='echo "built ${WHIT_PRESET-release}"\n')
        self.assertNotIn("built asan", said)  # An argument, though an empty one, asks for less.
        script = self.folder + "/repository/tools/test"
        code, said = run(script, path=self.programs)
        self.assertIn("built asan", said)
        self.assertEqual((code, said.splitlines()[-1]), (0, "12 passed, 0 failed"))
        self.program("ctest", """
while [[ $# -gt 0 ]]; do [[ $1 != --output-junit ]] || out=$2; [[ $1 != */asan ]] || asan=1; shift; done
printf '<testsuite name="x" tests="5" failures="%d" disabled="0" skipped="0"/>\n' "${asan-0}" >"$out"
[[ ${asan-0} == 0 ]] || { printf 'The following tests FAILED:\n\t  2 - two (Failed)\n'; exit 8; }
""")
        code, said = run(script, path=self.programs)
        self.assertEqual((code, said.splitlines()[-1]), (1, "11 passed, 1 failed"))
        self.assertIn("FAILED: asan: two\n", said)

    def test_a_check_fails(self):
        code, said, last = self.result(includes="echo the offence; exit 1\n")
        self.assertEqual((code, last), (1, "6 passed, 1 failed"))
        self.assertIn("the offence", said)
        self.assertIn("FAILED: check-includes", said)

    def test_tests_fail_or_are_skipped(self):
        code, said, last = self.result(
            junit='tests="5" failures="2" disabled="0" skipped="1"', status=8,
            log="    Start 1: one\n1/5 Test #1: one ....   Passed    0.1 sec\n2/5 Test #2: two ...***Failed\nits output\n\n"
                "The following tests FAILED:\n\t  2 - two (Failed)\n\t  3 - three (SEGFAULT)\nErrors\n")
        self.assertEqual((code, last), (1, "4 passed, 2 failed"))
        self.assertIn("its output", said)
        self.assertNotIn("one", said)
        self.assertIn("FAILED: two\nFAILED: three\n", said)
        self.assertIn("1 tests skipped", said)

    def test_the_build_fails(self):
        code, said, last = self.result(build="echo an error in a file; exit 1\n")
        self.assertEqual((code, last), (1, "2 passed, 1 failed"))
        self.assertIn("an error in a file", said)

    def test_ctest_itself_fails(self):
        code, _, last = self.result(junit="", status=1)
        self.assertEqual((code, last), (1, "2 passed, 1 failed"))
        code, _, last = self.result(status=9)
        self.assertEqual((code, last), (1, "7 passed, 1 failed"))


@unittest.skipUnless(shutil.which("clang-format-14") or shutil.which("clang-format"), "clang-format is not installed")
class CheckFormat(Temporary):
    def test_finds_and_fixes(self):
        shutil.copy(ROOT + "/.clang-format", self.folder)
        bad = os.path.join(self.folder, "bad file.cpp")
        write(bad, "int  f( ) {return 1;}\n")
        code, said = run(ROOT + "/tools/check-format", bad)
        self.assertEqual(code, 1)
        self.assertIn("run tools/check-format --fix", said)
        self.assertEqual(run(ROOT + "/tools/check-format", "--fix", bad), (0, ""))
        self.assertEqual(run(ROOT + "/tools/check-format", bad), (0, ""))
        with open(bad, encoding="utf-8") as f:
            self.assertEqual(f.read(), "int f() { return 1; }\n")


if __name__ == "__main__":
    unittest.main()
