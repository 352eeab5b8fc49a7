#!/usr/bin/env python3
"""What of a glTF model is shown is chosen as the command chooses it: pictures have the command's bits."""
import contextlib
import importlib.util
import os
import unittest

from package import ROOT, SCENE, whit
from render_test import Folder

spec = importlib.util.spec_from_file_location("make_models", os.path.join(ROOT, "tests", "gltf", "make_models.py"))
make_models = importlib.util.module_from_spec(spec)
spec.loader.exec_module(make_models)


class Models(Folder):
    def setUp(self):
        super().setUp()
        make_models.write(self.folder, ["animation", "variants", "two_scenes"])

    def test_pictures_are_those_of_the_command(self):
        with contextlib.chdir(self.folder):
            plain = {name: whit.render(name + ".glb", quick=True).pixels for name in ("animation", "variants", "two_scenes")}
            for name, flags, arguments in (
                    ("animation", ["--time", "0.5"], {"model_time": 0.5}),
                    ("variants", ["--variant", "sea"], {"model_variant": "sea"}),
                    ("variants", ["--variant", "1"], {"model_variant": 1}),
                    ("two_scenes", ["--scene", "square"], {"model_scene": "square"}),
                    ("two_scenes", ["--camera", "0"], {"model_camera": 0})):
                with self.subTest(arguments):
                    picture = whit.render(name + ".glb", quick=True, **arguments)
                    self.assertEqual(self.saved(picture), self.command(name + ".glb", "--quick", *flags))
                    kept = whit.Scene(name + ".glb", quick=True, **arguments)
                    self.assertEqual((kept.render().pixels != picture.pixels).sum(), 0)
                    if "model_camera" not in arguments:
                        self.assertNotEqual((picture.pixels != plain[name]).sum(), 0)

    def test_what_a_model_has_not(self):
        with contextlib.chdir(self.folder):
            for function in (whit.render, whit.explain, lambda model, **more: whit.cost(model, seconds=1, **more)):
                with self.assertRaisesRegex(whit.UsageError, 'no variant "earth"'):
                    function("variants.glb", model_variant="earth")
            found = whit.check("variants.glb", model_variant="earth")
            self.assertIn('no variant "earth"', " ".join(d.message for d in found))

    def test_other_scenes_say_it_themselves(self):
        for function in (whit.render, whit.Scene, whit.explain, whit.check, whit.cost):
            for scene in (SCENE, self.scene):
                with self.assertRaisesRegex(whit.UsageError, "model_camera is of glTF models, and .* is none"):
                    function(scene, model_camera="front")

    def test_arguments_that_make_no_sense(self):
        for argument, value in (("model_scene", 1.5), ("model_camera", -1), ("model_variant", True), ("model_scene", ""),
                                ("model_time", float("nan")), ("model_time", "soon")):
            with self.subTest(argument=argument, value=value), self.assertRaisesRegex(whit.UsageError, argument):
                whit.render("variants.glb", **{argument: value})


if __name__ == "__main__":
    unittest.main()
