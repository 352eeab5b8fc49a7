#!/usr/bin/env python3
"""A processor without what the program is compiled for: one sentence and exit code 2 instead of an illegal instruction.

GLIBC_TUNABLES makes the C library, which the program asks, answer as if the processor had less."""
import os
import re
import shutil
import subprocess
import unittest

import installed

WHIT = os.environ.get("WHIT")
# Of x86-64-v3, without those that GLIBC_TUNABLES does not know (SSE3 and F16C).
LEVEL_3 = ["SSSE3", "SSE4_1", "SSE4_2", "POPCNT", "AVX", "AVX2", "BMI1", "BMI2", "FMA", "LZCNT", "MOVBE"]


def say(program, *arguments, without=(), emulator=()):
    env = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=" + ",".join("-" + name for name in without)} if without else {}
    done = subprocess.run([*emulator, program, *arguments], capture_output=True, text=True, check=False, env=env, timeout=100)
    return done.returncode, done.stdout, done.stderr


def sentence(*lacks):
    return ("whit: this processor has no %s, which this program is compiled for (x86-64-v3); compile it on this machine "
            "(docs/install.md)\n" % ", ".join(lacks))


class Processor(unittest.TestCase):
    def test_the_version_says_what_runs(self):
        self.assertRegex(say(WHIT, "--version")[1],
                         r"^whit \d+\.\d+\.\d+, (x86-64\S* \(\S+\)|native \(\S+\), on a processor with \S+)\n$")

    @unittest.skipUnless(installed.BUILT, "build/portable is not built")
    def test_the_portable_version(self):
        code, out, err = say(installed.PORTABLE + "/whit", "--version")
        self.assertEqual((code, err), (0, ""))
        self.assertRegex(out, r"^whit \d+\.\d+\.\d+, x86-64-v3 \(AVX2\)\n$")

    @unittest.skipUnless(installed.BUILT, "build/portable is not built")
    def test_each_of_the_level_is_asked_for(self):
        for name in LEVEL_3:
            with self.subTest(name):
                self.assertEqual(say(installed.PORTABLE + "/whit", "--version", without=[name]),
                                 (2, "", sentence(name.replace("_", "."))))

    @unittest.skipUnless(installed.BUILT, "build/portable is not built")
    def test_all_that_is_missing_is_named(self):
        self.assertEqual(say(installed.PORTABLE + "/whit", "no-such.pbrt", without=["AVX2", "FMA", "MOVBE"]),
                         (2, "", sentence("FMA", "AVX2", "MOVBE")))

    @unittest.skipUnless(installed.BUILT, "build/portable is not built")
    def test_more_is_not_asked_for(self):
        self.assertEqual(say(installed.PORTABLE + "/whit", "--version", without=["AVX512F", "ERMS"])[0], 0)

    @unittest.skipIf(os.environ.get("WHIT_SANITIZE"), "sanitizers have constructors of their own")
    def test_it_is_the_first_of_the_programs_constructors(self):
        """All others may use any instruction set."""
        section = re.search(r" \.init_array +INIT_ARRAY +(\w+) \w+ (\w+)", installed.run("readelf", "-SW", WHIT))
        start, size = (int(group, 16) for group in section.groups())
        entries = [(int(at, 16), int(function, 16)) for at, function in re.findall(
            r"^(\w+) +\w+ +R_X86_64_RELATIVE +(\w+)$", installed.run("readelf", "-rW", WHIT), re.MULTILINE)]
        first = dict(entries)[start]
        self.assertGreater(sum(start <= at < start + size for at, _ in entries), 100)  # plugins register themselves
        names = re.findall(r"^%016x . (.*)$" % first, installed.run("nm", "-C", WHIT), re.MULTILINE)
        self.assertEqual(names, ["whit::(anonymous namespace)::refuse_a_processor_that_has_less()"])

    @unittest.skipUnless(installed.BUILT and shutil.which("qemu-x86_64"), "no qemu-x86_64 (Debian's qemu-user)")
    def test_an_old_processor(self):
        """Nehalem, of 2008, is the last of Intel's without AVX. An emulator of a processor refuses what that has not."""
        code, out, err = say(installed.PORTABLE + "/whit", "--version", emulator=["qemu-x86_64", "-cpu", "Nehalem"])
        self.assertEqual((code, out, err), (2, "", sentence("AVX", "F16C", "FMA", "AVX2", "BMI1", "BMI2", "LZCNT", "MOVBE")))


if __name__ == "__main__":
    if not WHIT:
        print("the program is not built")
        raise SystemExit(77)
    unittest.main()
