#!/usr/bin/env python3
"""docs/install.md, followed literally: its commands run one after the other in a folder that looks like the source tree, and
leave what the page says."""
import os
import re
import shutil
import unittest

import installed


class Page(installed.Folder):
    def test_its_commands(self):
        with open(installed.ROOT + "/docs/install.md", encoding="utf-8") as f:
            page = f.read()
        # A link for every file and folder, so that nothing is written into the tree.
        for name in ("build", "scenes"):
            os.symlink(os.path.join(installed.ROOT, name), self.path(name))
        blocks = re.findall(r"^<!-- run -->\n```sh\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
        self.assertEqual(len(blocks), 4)
        said = "".join(installed.run("bash", "-euc", block, cwd=self.folder) for block in blocks)
        # Unpacked, and installed, as the page shows it above.
        version = re.search(r"^\$ whit --version\n(whit \d.*)$", page, re.MULTILINE)[1]
        self.assertEqual(said.split("\n").count(version), 2, said)
        for name in ("cornell-box.exr", "cornell-box.png"):
            self.assertTrue(os.path.exists(self.path(name)), name)

    def test_what_is_in_the_prefix(self):
        with open(installed.ROOT + "/docs/install.md", encoding="utf-8") as f:
            rows = re.findall(r"^\| (`[^|]*`) \|", f.read(), re.MULTILINE)
        named = [name for row in rows for name in re.findall(r"`(.*?)`", row)]
        self.assertIn("bin/whit", named)
        prefix = self.path("prefix")
        installed.run("cmake", "--install", installed.PORTABLE, "--prefix", prefix)
        files = [os.path.relpath(os.path.join(where, name), prefix) for where, _, names in os.walk(prefix) for name in names]
        for name in named:
            self.assertTrue(os.path.exists(os.path.join(prefix, name)), name)
        for file in files:
            self.assertTrue(any(file == name or file.startswith(name + "/") for name in named), file)


if __name__ == "__main__":
    if not installed.BUILT or not all(shutil.which(program) for program in ("cmake", "cpack", "dpkg-deb", "dpkg-shlibdeps")):
        print("build/portable is not built, or there is no cmake, cpack or dpkg-dev")
        raise SystemExit(77)
    unittest.main()
