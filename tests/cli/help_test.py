#!/usr/bin/env python3
"""`whit help` finds what it is asked about by name alone, and what is misspelt is guessed: commands, plugins, statements."""
import json
import os
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")

SCENE = """\
Integrator "%s"
Camera "perspective"
WorldBegin
  LightSource "point"
  Shape "sphere"
WorldEnd
"""


@unittest.skipUnless(WHIT, "the program is not built")
class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def whit(self, *arguments):
        done = subprocess.run([WHIT, *arguments], input="", capture_output=True, text=True, cwd=self.folder, timeout=60,
                              check=False)
        return done.returncode, done.stdout, done.stderr

    def good(self, *arguments):
        code, out, err = self.whit(*arguments)
        self.assertEqual((code, err), (0, ""), arguments)
        return out

    def fails(self, code, message, *arguments):
        got, out, err = self.whit(*arguments)
        self.assertEqual((got, out), (code, ""), (arguments, err))
        self.assertIn(message, err, arguments)


class Help(Case):
    def test_a_name_alone_is_enough(self):
        # Every plugin of the name, in whatever category.
        both = self.good("help", "imagemap")
        self.assertIn('float texture "imagemap"', both)
        self.assertIn('spectrum texture "imagemap"', both)
        mix = self.good("help", "mix")
        for category in ("material", "float texture", "spectrum texture"):
            self.assertIn('%s "mix"' % category, mix)
        self.assertIn('"float radius"', self.good("help", "disk"))
        self.assertIn("LookAt eye_x eye_y", self.good("help", "LookAt"))
        self.assertIn("depth-of-field", self.good("help", "depth-of-field"))
        self.assertIn("albedo", self.good("help", "albedo"))

    def test_a_name_in_its_kind(self):
        self.assertEqual(self.good("help", "texture", "imagemap"), self.good("help", "imagemap"))
        self.assertNotIn("spectrum texture", self.good("help", "float", "texture", "imagemap"))
        self.assertEqual(self.good("help", "float texture imagemap"), self.good("help", "float", "texture", "imagemap"))
        sphere = self.good("help", "shape", "sphere")
        self.assertEqual(sphere, self.good("help", "Shape", "sphere"))  # as it stands in a file
        self.assertEqual(self.good("help", "LightSource", "point"), self.good("help", "light", "point"))
        self.assertEqual(self.good("help", "statement", "LookAt"), self.good("help", "LookAt"))
        # The integrator and the sampler have a plugin called random or path; with the kind it is one of them.
        self.assertTrue(self.good("help", "sampler", "random").startswith('sampler "random"'))

    def test_everything_there_is_answers(self):
        known = json.loads(self.good("help", "--json"))
        for plugin in known["plugins"]:
            for name in filter(None, [plugin["name"]] + plugin["aliases"]):
                self.assertIn('%s "%s"' % (plugin["category"], plugin["name"]), self.good("help", name))
        for statement in known["statements"]:
            self.assertIn((statement["name"] + " " + statement["arguments"]).strip() + "\n",
                          self.good("help", statement["name"]))
        for thing in known["effects"] + known["aovs"]:
            self.assertIn(thing["name"], self.good("help", thing["name"]))
        listed = self.good("check", "--list")
        self.assertIn("unused-texture", listed)
        for line in listed.splitlines():
            self.assertIn(line.split()[0] + "\n", self.good("help", line.split()[0]))

    def test_whole_kinds(self):
        for one, several, name in (("statement", "statements", "LookAt"), ("effect", "effects", "depth-of-field"),
                                   ("aov", "aovs", "albedo"), ("shape", "shapes", "trianglemesh"),
                                   ("area light", "area lights", "diffuse")):
            self.assertIn(name, self.good("help", one))
            # There is also an AOV called shape, which follows.
            self.assertTrue(self.good("help", one).startswith(self.good("help", several)), one)
        self.assertIn('spectrum texture "wrinkled"', self.good("help", "texture"))
        self.assertIn('float texture "wrinkled"', self.good("help", "texture"))

    def test_a_command_is_its_help(self):
        self.assertEqual(self.good("help", "fmt"), self.good("fmt", "--help"))
        self.assertEqual(self.good("help", "command", "check"), self.good("check", "--help"))
        self.assertEqual(self.good("help", "help"), self.good("help"))

    def test_the_case_of_letters_does_not_matter(self):
        self.assertEqual(self.good("help", "lookat"), self.good("help", "LookAt"))
        self.assertEqual(self.good("help", "IMAGEMAP"), self.good("help", "imagemap"))
        self.assertEqual(self.good("help", "shape", "Sphere"), self.good("help", "shape", "sphere"))
        # But what is written exactly comes first: a statement and a category.
        self.assertTrue(self.good("help", "Shape").startswith('Shape "plugin" parameters\n'))
        self.assertTrue(self.good("help", "shape").startswith('shape "'))

    def test_slips(self):
        for asked, meant in (("imagmap", "imagemap"), ("Lookta", "LookAt"), ("depth-of-feild", "depth-of-field"),
                             ("albdeo", "albedo"), ("explian", "explain"), ("materiel", "material")):
            self.fails(2, 'nothing called "%s"; did you mean "%s"?' % (asked, meant), "help", asked)
        self.fails(2, 'no shape "shpere"; did you mean "sphere"?', "help", "shape", "shpere")
        self.fails(2, 'no kind of things called "shaep"; did you mean "shape"?', "help", "shaep", "sphere")
        self.fails(2, 'no shape "matte", but material "matte"', "help", "shape", "matte")
        self.fails(2, '"zzzzzzzzz"; `whit help` lists what there is', "help", "zzzzzzzzz")


class Commands(Case):
    def test_version(self):
        for word in ("--version", "-V", "version"):
            self.assertRegex(self.good(word), r"^whit \d+\.\d+\.\d+, .+\n$")
        # A file of that name is a scene, as with any other word.
        with open(os.path.join(self.folder, "version"), "w", encoding="utf-8") as f:
            f.write("Nonsense\n")
        self.fails(3, "version:1:1: error: not a scene file", "version")

    def test_a_misspelt_command_is_said_to_be_one(self):
        slips = {"chekc": "check", "dif": "diff", "ftm": "fmt", "explian": "explain", "costs": "cost", "bensh": "bench",
                 "improt": "import", "rendr": "render", "hlep": "help", "CHECK": "check", "verison": "version"}
        for written, meant in slips.items():
            for more in ((), ("scene.pbrt",), ("scene.pbrt", "--json")):
                self.fails(2, 'no command "%s", and no file of that name to render; did you mean `whit %s`?'
                           % (written, meant), written, *more)

    def test_a_word_that_is_neither(self):
        self.fails(4, 'no such file, and there is no command of that name', "zzzzzzzzz", "scene.pbrt")
        self.fails(4, 'cannot open "zzzzzzzzz.pbrt": no such file', "zzzzzzzzz.pbrt")
        self.fails(4, 'cannot open "./chekc": no such file', "./chekc")

    def test_a_misspelt_integrator(self):
        scene = os.path.join(self.folder, "scene.pbrt")
        for written, meant in (("wited", "whitted"), ("Whitted", "whitted"), ("pth", "path"), ("bdtp", "bdpt")):
            with open(scene, "w", encoding="utf-8") as f:
                f.write(SCENE % written)
            code, _, err = self.whit("check", scene)
            self.assertEqual(code, 1)
            self.assertIn('did you mean "%s"?' % meant, err)
        self.fails(2, 'did you mean "whitted"?', scene, "--integrator", "wited")
        self.fails(2, 'did you mean "sobol"?', scene, "--sampler", "sobl")


if __name__ == "__main__":
    if not WHIT:
        raise SystemExit(77)
    unittest.main()
