#!/usr/bin/env python3
"""docs/add-a-material.md, followed literally: its plugin compiles, its commands print what the page says, its scene has
the pixels the page derives, and the generic tests of materials pass with it. So do those of lobes with its lobe.

The plugin is compiled in a temporary folder with the flags of the other plugins and linked with the objects of the
build, so that neither the source tree nor the build changes; so is the lobe. $WHIT_BINARY_DIR is the build.
"""
import os
import re
import shlex
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from page_plugin import BUILD, ROOT, blocks_of, compile_command, link_command, must, run  # pylint: disable=wrong-import-position

PAGE = ROOT + "/docs/add-a-material.md"
PLUGIN = "plugins/materials/paper.cpp"


class AddAMaterial(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = cls.scratch.name
        cls.blocks = blocks_of(PAGE)
        os.makedirs(os.path.dirname(os.path.join(cls.folder, PLUGIN)))
        for mark, text in cls.blocks.items():
            if mark.startswith("file: "):
                with open(os.path.join(cls.folder, mark.removeprefix("file: ")), "w", encoding="utf-8") as f:
                    f.write(text)
        cls.object = os.path.join(cls.folder, "paper.o")
        command, directory = compile_command(os.path.join(cls.folder, PLUGIN), cls.object)
        must(command, cwd=directory)
        cls.whit = os.path.join(cls.folder, "build/release/whit")
        os.makedirs(os.path.dirname(cls.whit))
        must(link_command("whit", [cls.object], cls.whit), cwd=BUILD)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_the_page_names_a_plugin_that_is_not_there_yet(self):
        self.assertIn("file: " + PLUGIN, self.blocks)
        self.assertFalse(os.path.exists(os.path.join(ROOT, PLUGIN)), "the page must describe another material")

    def test_it_is_formatted_and_includes_what_plugins_may(self):
        # The tools see the page's file beside the repository's core/.
        for name in ("core", "parser", ".clang-format"):
            os.symlink(os.path.join(ROOT, name), os.path.join(self.folder, name))
        offences = run([sys.executable, ROOT + "/tools/check-includes", self.folder]).stdout.splitlines()
        self.assertEqual([o for o in offences if o.startswith(PLUGIN)], [])
        must([ROOT + "/tools/check-format", os.path.join(self.folder, PLUGIN)])

    def test_the_commands_print_what_the_page_says(self):
        ran = 0
        for mark, text in self.blocks.items():
            if not mark.startswith("run"):
                continue
            edits = re.findall(r"([\w. ]+) -> ([\w. ]+)", mark.partition(": ")[2])
            with open(os.path.join(self.folder, "paper.pbrt"), "w", encoding="utf-8") as f:
                scene = self.blocks["file: paper.pbrt"]
                for old, new in edits:
                    self.assertIn(old.strip(), scene)
                    scene = scene.replace(old.strip(), new.strip())
                f.write(scene)
            commands = re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", text, re.MULTILINE)
            for command, expected in commands:
                done = run(shlex.split(command), cwd=self.folder)
                self.assertEqual(done.stdout + done.stderr, expected, command)
                ran += 1
        self.assertGreaterEqual(ran, 2)

    def test_the_pixels_are_what_the_page_derives(self):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        with open(os.path.join(self.folder, "paper.pbrt"), "w", encoding="utf-8") as f:
            f.write(self.blocks["file: paper.pbrt"])
        said = must([self.whit, "paper.pbrt", "--quiet"], cwd=self.folder)
        self.assertEqual(said.stdout + said.stderr, "")
        with open(PAGE, encoding="utf-8") as f:
            derived = re.search(r"= \(([\d.]+), ([\d.]+), ([\d.]+)\)\.", f.read())
        # 0.5 (1 - 0.25) and 0.5 * 0.25: exact in half but for the rounding of pi and 1/pi.
        self.assertEqual([float(v) for v in derived.groups()], [0.375, 0.125, 0])
        image = oiio.ImageBuf(os.path.join(self.folder, "paper.exr"))
        names = list(image.spec().channelnames)
        pixels = image.get_pixels(oiio.FLOAT)[..., [names.index(c) for c in "RGB"]].reshape(-1, 3)
        self.assertEqual(len(pixels), 16 * 16)
        for channel, value in enumerate((0.375, 0.125, 0)):
            self.assertAlmostEqual(float(pixels[:, channel].min()), value, delta=value * 2**-11)
            self.assertAlmostEqual(float(pixels[:, channel].max()), value, delta=value * 2**-11)
        self.assertTrue(os.path.exists(os.path.join(self.folder, "paper.png")))

    def test_the_generic_tests_cover_it(self):
        if not os.path.exists(BUILD + "/tests/test_plugin"):
            self.skipTest("the tests are not built")
        program = os.path.join(self.folder, "test_plugin")
        must(link_command("test_plugin", [self.object], program), cwd=BUILD)
        said = must([program, "--gtest_filter=EveryMaterial.*"], cwd=self.folder).stdout
        self.assertRegex(said, r"\[  PASSED  \] [1-9]\d* tests")


class AddALobe(unittest.TestCase):
    """The page's lobe, in a tree that has the repository's files but for the list of lobes."""
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        os.makedirs(self.folder + "/core/lobe")
        for name in ("core", "core/lobe"):
            for entry in os.listdir(ROOT + "/" + name):
                if entry not in ("lobe", "lobe_types.inc"):
                    os.symlink("%s/%s/%s" % (ROOT, name, entry), "%s/%s/%s" % (self.folder, name, entry))
        os.symlink(ROOT + "/.clang-format", self.folder + "/.clang-format")
        page = blocks_of(PAGE)
        with open(ROOT + "/core/lobe/lobe_types.inc", encoding="utf-8") as f:
            self.list = f.read()
        self.line = page["lobe line: core/lobe/lobe_types.inc"]
        self.write_list(self.list + self.line)
        self.source = self.folder + "/core/lobe/dust.cpp"
        self.assertFalse(os.path.exists(ROOT + "/core/lobe/dust.cpp"), "the page must describe another lobe")
        with open(self.source, "w", encoding="utf-8") as f:
            f.write(page["lobe file: core/lobe/dust.cpp"])

    def write_list(self, text):
        with open(self.folder + "/core/lobe/lobe_types.inc", "w", encoding="utf-8") as f:
            f.write(text)

    def compile(self, name):
        """The object of a file of core/lobe/, and what the compiler said if there is none."""
        target = "%s/%s.o" % (self.folder, name)
        source = "%s/core/lobe/%s.cpp" % (self.folder, name)
        command, directory = compile_command(source, target, "core/lobe/lambert.cpp")
        first = next(k for k, word in enumerate(command) if word.startswith("-I"))
        done = run(command[:first] + ["-I" + self.folder] + command[first:], cwd=directory)
        return target, done.stdout + done.stderr

    def test_it_is_formatted_and_includes_what_lobes_may(self):
        must([sys.executable, ROOT + "/tools/check-includes", self.folder])
        must([ROOT + "/tools/check-format", self.source])

    def test_a_row_without_its_line_does_not_compile(self):
        self.write_list(self.list)
        self.assertIn("Dust", self.compile("dust")[1])

    def test_a_line_without_its_row_does_not_link(self):
        if not os.path.exists(BUILD + "/tests/test_lobe"):
            self.skipTest("the tests are not built")
        table, _ = self.compile("table")
        done = run(link_command("test_lobe", [table], self.folder + "/test_lobe"), cwd=BUILD)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("Dust", done.stdout + done.stderr)

    def test_the_generic_tests_cover_it(self):
        if not os.path.exists(BUILD + "/tests/test_lobe"):
            self.skipTest("the tests are not built")
        objects = []
        for name in ("dust", "table"):
            target, said = self.compile(name)
            self.assertEqual(said, "")
            objects.append(target)
        program = self.folder + "/test_lobe"
        must(link_command("test_lobe", objects, program), cwd=BUILD)
        # The names of all lobes are counted by one of the tests.
        said = must([program, "--gtest_filter=EveryLobe.*"], cwd=self.folder).stdout
        self.assertRegex(said, r"\[  PASSED  \] [1-9]\d* tests")
        self.assertIn("%d lobes" % (self.list.count("\nLOBE(") + 1), said)


if __name__ == "__main__":
    unittest.main()
