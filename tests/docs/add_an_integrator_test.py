#!/usr/bin/env python3
"""docs/add-an-integrator.md, followed literally: its plugin compiles, its scene has the pixels the page derives, also in a
closed box, and it passes what every integrator must.
"""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from page_plugin import BUILD, ROOT, blocks_of, compile_command, link_command, must, run  # pylint: disable=wrong-import-position

PAGE = ROOT + "/docs/add-an-integrator.md"
PLUGIN = "plugins/integrators/dome.cpp"


class AddAnIntegrator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = cls.scratch.name
        cls.blocks = blocks_of(PAGE)
        source = os.path.join(cls.folder, PLUGIN)
        os.makedirs(os.path.dirname(source))
        with open(source, "w", encoding="utf-8") as f:
            f.write(cls.blocks["file: " + PLUGIN])
        cls.object = os.path.join(cls.folder, "dome.o")
        command, directory = compile_command(source, cls.object, "plugins/integrators/whitted.cpp")
        must(command, cwd=directory)
        cls.whit = os.path.join(cls.folder, "whit")
        must(link_command("whit", [cls.object], cls.whit), cwd=BUILD)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def render(self, text):
        import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
        with tempfile.TemporaryDirectory() as folder:
            with open(folder + "/dome.pbrt", "w", encoding="utf-8") as f:
                f.write(text)
            said = must([self.whit, "render", "dome.pbrt", "--quiet"], cwd=folder)
            self.assertEqual(said.stdout + said.stderr, "")
            return oiio.ImageBuf(folder + "/dome.exr").get_pixels(oiio.FLOAT)

    def test_the_page_names_a_plugin_that_is_not_there_yet(self):
        self.assertFalse(os.path.exists(os.path.join(ROOT, PLUGIN)), "the page must describe another integrator")

    def test_it_is_formatted_and_includes_what_plugins_may(self):
        for name in ("core", "parser", ".clang-format"):
            os.symlink(os.path.join(ROOT, name), os.path.join(self.folder, name))
        offences = run([sys.executable, ROOT + "/tools/check-includes", self.folder]).stdout.splitlines()
        self.assertEqual([o for o in offences if o.startswith(PLUGIN)], [])
        must([ROOT + "/tools/check-format", os.path.join(self.folder, PLUGIN)])

    def test_the_pixels_are_what_the_page_derives(self):
        pixels = self.render(self.blocks["file: dome.pbrt"]).reshape(-1, 3)
        self.assertEqual(len(pixels), 32 * 32)
        for channel, value in enumerate((0.5, 0.4, 0.3)):
            # A half's rounding, and those of pi and 1 / pi.
            self.assertLess(abs(pixels[:, channel] - value).max(), value * 2**-10)

    def test_a_closed_box_is_black(self):
        text = self.blocks["file: dome.pbrt"].replace("WorldEnd", 'Shape "sphere" "float radius" [30]\nWorldEnd')
        self.assertEqual(self.render(text).max(), 0)

    def test_it_passes_what_every_integrator_must(self):
        run_tests = [sys.executable, ROOT + "/tests/integrators/integrators_test.py", "Every"]
        done = run(run_tests, env={**os.environ, "WHIT": self.whit})
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
