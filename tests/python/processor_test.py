#!/usr/bin/env python3
"""On a processor without what the extension module is compiled for the import is an ImportError that says what lacks and
what to do, and no illegal instruction.

GLIBC_TUNABLES makes the C library, which is asked, answer as if the processor had less."""
import os
import re
import subprocess
import sys
import unittest

from package import whit

FOLDER = os.path.dirname(os.path.dirname(whit.__file__))


def run(code, *without):
    tunables = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=" + ",".join("-" + name for name in without)} if without else {}
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=100,
                          env={**os.environ, "PYTHONPATH": FOLDER, **tunables})


class Processor(unittest.TestCase):
    def test_what_lacks_is_named(self):
        for without, names in ((["AVX2"], "AVX2"), (["AVX2", "FMA", "MOVBE"], "FMA, AVX2, MOVBE")):
            done = run("import whit", *without)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertRegex(done.stderr.splitlines()[-1],
                             r"^ImportError: whit: this processor has no %s, which this module is compiled for "
                             r"\((native|x86-64\S*)\); build it on this machine \(docs/python\.md\)$" % names)

    def test_it_comes_before_the_module(self):
        code = "import sys\ntry:\n  import whit\nexcept ImportError:\n  print('whit._whit' in sys.modules)"
        self.assertEqual(run(code, "AVX2").stdout, "False\n")

    def test_nothing_lacks_here(self):
        self.assertEqual(run("import whit, whit._processor as p; print(p.lacks())").stdout, "[]\n")

    def test_the_check_has_no_newer_instructions(self):
        """Those that work with registers of 256 bits, and those of BMI and of fused multiply-add."""
        import whit._processor as processor  # pylint: disable=import-outside-toplevel
        listed = subprocess.run(["objdump", "-d", "--no-show-raw-insn", processor.__file__], capture_output=True, text=True,
                                check=True).stdout
        newer = re.findall(r"%[yz]mm\d|\bv(?:mov|xor|pxor|fmadd)\w*|\b(?:shlx|sarx|shrx|andn|bextr|blsr|tzcnt|lzcnt)\b", listed)
        self.assertEqual(newer, [])


if __name__ == "__main__":
    unittest.main()
