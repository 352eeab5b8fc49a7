#!/usr/bin/env python3
"""`cpack -G DEB`: the package's name, fields and files, that its program runs and makes the build's pictures, and that a
build for one machine alone is not packed."""
import gzip
import os
import re
import shutil
import subprocess
import unittest

import installed

NATIVE = os.environ.get("WHIT_BINARY_DIR") or os.path.join(installed.ROOT, "build", "release")


class Package(installed.Folder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        installed.run("cpack", "-G", "DEB", "--config", installed.PORTABLE + "/CPackConfig.cmake", "-B", cls.folder)
        cls.package = os.path.join(cls.folder, "whit_0.1.0_amd64.deb")
        cls.root = os.path.join(cls.folder, "root")
        installed.run("dpkg-deb", "-x", cls.package, cls.root)
        cls.usr = os.path.join(cls.root, "usr")

    def field(self, name):
        return installed.run("dpkg-deb", "-f", self.package, name).rstrip("\n")

    def test_fields(self):
        for name, value in (("Package", "whit"), ("Version", "0.1.0"), ("Architecture", "amd64"), ("Section", "graphics"),
                            ("Priority", "optional"), ("Homepage", "")):
            self.assertEqual(self.field(name), value)
        first, *rest = self.field("Description").split("\n")
        self.assertRegex(first, r"^[a-z].{20,60}[^.]$")  # As Debian's policy wants it.
        self.assertGreater(len(rest), 3)
        self.assertRegex(self.field("Maintainer"), r"^.+ <\S+@\S+>$")
        self.assertGreater(int(self.field("Installed-Size")), 5000)

    def test_dependencies_are_those_of_the_program_and_of_the_modules(self):
        depends = {entry.split()[0] for entry in self.field("Depends").split(",")}
        for file in [self.usr + "/bin/whit"] + [os.path.join(self.usr, module) for module in installed.MODULES]:
            needed = {line.split("[")[1].rstrip("]") for line in installed.run("readelf", "-d", file).split("\n")
                      if "(NEEDED)" in line and "ld-linux" not in line}
            # The loader's own answer, and whose files these are; a folder may be a link to another, /lib to /usr/lib.
            found = dict(re.findall(r"(\S+) => (\S+)", installed.run("ldd", file)))
            self.assertLessEqual(needed, set(found))
            names = [name for library in needed for name in {found[library], os.path.realpath(found[library])}]
            said = subprocess.run(["dpkg-query", "-S", *names, *("/usr" + name for name in names)], capture_output=True,
                                  text=True, check=False).stdout
            owner = {os.path.basename(path): package.split(":")[0] for package, path in re.findall(r"(\S+): (\S+)", said)}
            for library in needed:
                package = owner.get(library) or owner.get(os.path.basename(os.path.realpath(found[library])))
                self.assertIn(package, depends, "%s of %s" % (library, file))

    def test_files(self):
        # Compressed, or elsewhere, or of another form than what `cmake --install` puts there.
        texts = dict(installed.TEXTS)
        del texts["share/doc/whit/LICENSE"]
        with gzip.open(self.usr + "/share/man/man1/whit.1.gz", "rt", encoding="utf-8") as f:
            self.assertIn(texts.pop("share/man/man1/whit.1"), f.read())
        with gzip.open(self.usr + "/share/doc/whit/changelog.gz", "rt", encoding="utf-8") as f:
            self.assertTrue(f.readline().startswith("whit (0.1.0)"))
        texts["share/zsh/vendor-completions/_whit"] = texts.pop("share/zsh/site-functions/_whit")
        texts["share/doc/whit/copyright"] = "Apache-2.0"
        for name, words in texts.items():
            with open(os.path.join(self.usr, name), encoding="utf-8") as f:
                self.assertIn(words, f.read(), name)
        for where, folders, names in os.walk(self.root):
            for name in folders + names:
                mode = os.stat(os.path.join(where, name)).st_mode & 0o7777
                runs = name in folders or os.path.relpath(os.path.join(where, name), self.usr) == "bin/whit"
                self.assertEqual(mode, 0o755 if runs else 0o644, os.path.join(where, name))

    def test_it_runs(self):
        self.assertEqual(installed.run_paths(self.usr + "/bin/whit"), ["$ORIGIN/../lib/whit"])
        self.same_pictures(self.usr + "/bin/whit", self.usr + "/share/whit/scenes/cornell-box.pbrt")

    def test_a_build_for_one_machine_is_not_packed(self):
        with open(NATIVE + "/CMakeCache.txt", encoding="utf-8") as f:
            native = "WHIT_ARCH:STRING=native" in f.read()
        if not native or not os.path.exists(NATIVE + "/share/whit.1"):
            self.skipTest("%s is no native build with its texts" % NATIVE)
        done = subprocess.run(["cpack", "-G", "DEB", "--config", NATIVE + "/CPackConfig.cmake", "-B", self.path("native")],
                              capture_output=True, text=True, check=False, timeout=300)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("configure with `cmake --preset portable`", " ".join(done.stderr.split()))


if __name__ == "__main__":
    if not installed.BUILT or not all(shutil.which(program) for program in ("cpack", "dpkg-deb", "dpkg-shlibdeps", "file")):
        print("build/portable is not built, or there is no cpack, dpkg-dev or file")
        raise SystemExit(77)
    unittest.main()
