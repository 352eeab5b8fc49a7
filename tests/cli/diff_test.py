#!/usr/bin/env python3
"""`whit diff` from the shell: what it says, its JSON, its exit codes, and the faults that it once had."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    import OpenImageIO as oiio
except ImportError:
    print("python3-numpy and python3-openimageio are needed (tools/install-deps test)")
    sys.exit(77)

WHIT = os.environ.get("WHIT")
RGB = ("R", "G", "B")


def write(path, pixels, names=RGB, kind="float"):
    pixels = np.ascontiguousarray(pixels, np.float32)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], len(names), kind)
    spec.channelnames = names
    out = oiio.ImageOutput.create(path)
    assert out and out.open(path, spec), oiio.geterror()
    assert out.write_image(pixels), out.geterror()
    out.close()


@unittest.skipUnless(WHIT, "the program is not built")
class Diff(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit diff ")
        self.addCleanup(shutil.rmtree, self.folder)
        x = np.arange(24) / 24
        self.rgb = np.stack(np.broadcast_arrays(0.2 + x[None, :], 0.3 + 0.5 * x[:16, None], np.float64(0.4)), -1)

    def file(self, name, pixels, names=RGB, kind="float"):
        path = os.path.join(self.folder, name)
        write(path, pixels, names, kind)
        return path

    def run_diff(self, *args, env=None):
        done = subprocess.run([WHIT, "diff", *args], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              env={**os.environ, **(env or {})}, check=False)
        return done.returncode, done.stdout, done.stderr

    def json(self, *args, code):
        found, out, err = self.run_diff(*args, "--json")
        self.assertEqual(found, code, out + err)
        return json.loads(out)

    # The faults that it once had.

    def test_exact_looks_at_all_channels(self):
        colours, ones = self.rgb, np.ones(self.rgb.shape[:2] + (3,))
        a = self.file("a.exr", np.dstack([colours, ones]), RGB + ("N.X", "N.Y", "N.Z"))
        b = self.file("b.exr", np.dstack([colours, -ones]), RGB + ("N.X", "N.Y", "N.Z"))
        self.assertEqual(self.run_diff(a, b, "--exact")[0], 1)
        self.assertEqual(self.run_diff(a, b)[0], 1)
        c = self.file("c.exr", np.dstack([colours, 0 * ones[..., :1]]), RGB + ("A",))
        d = self.file("d.exr", np.dstack([colours, ones[..., :1]]), RGB + ("A",))
        self.assertEqual(self.run_diff(c, d, "--exact")[0], 1)

    def test_channels_that_one_lacks_cannot_be_compared(self):
        a = self.file("a.exr", self.rgb)
        xyz = self.file("xyz.exr", self.rgb, ("X", "Y", "Z"))
        code, _, err = self.run_diff(a, xyz, "--exact")
        self.assertEqual(code, 4)
        self.assertIn("alone has X, Y, Z", err)
        grey = self.file("grey.exr", self.rgb[..., :1], ("Y",))
        self.assertEqual(self.run_diff(a, grey)[0], 4)
        smaller = self.file("smaller.exr", self.rgb[1:])
        code, _, err = self.run_diff(a, smaller)
        self.assertEqual(code, 4)
        self.assertIn("is 24 x 16", err)

    def test_a_few_pixels_do_not_decide(self):
        # 2 % of noise everywhere is relMSE 0.0004; two fireflies among 10^4 pixels are 2e-4 * 100^2 = 2 on top.
        noise = np.random.default_rng(1)
        base = np.full((100, 100, 3), 0.5)
        a, b = base * (1 + 0.02 * noise.standard_normal(base.shape)), base * (1 + 0.02 * noise.standard_normal(base.shape))
        a[3, 4] = 50
        found = self.json(self.file("a.exr", a), self.file("b.exr", b), code=1)
        self.assertGreater(found["measures"]["relmse"], 0.9)
        self.assertLess(found["measures"]["relmse_robust"], 0.001)
        self.assertNotIn("relmse_robust", [f["measure"] for f in found["failed"]])

    def test_the_text_says_which_limit_by_how_much_and_where(self):
        a = self.rgb.copy()
        a[10, 20] *= 30
        code, out, _ = self.run_diff(self.file("a.exr", a), self.file("b.exr", self.rgb))
        self.assertEqual(code, 1)
        self.assertRegex(out, r"^differs: .* is (above|off by) .*")
        self.assertIn("limits: relmse_robust 0.02 ratio 0.01 block 0.08 channel_block 0.16 shift 0.1 mismatch 0.02", out)
        code, out, _ = self.run_diff(self.file("a.exr", a), self.file("b.exr", self.rgb), "--hard-fail", "0.1")
        self.assertIn("off by", out)
        self.assertIn("(20, 10)", out)
        table = self.run_diff(self.file("a.exr", a), self.file("b.exr", self.rgb), "--verbose")[1]
        for measure in ("relmse_robust", "psnr", "mae", "max", "pixels"):
            self.assertRegex(table, r"(?m)^\(picture\) +%s +[\d.e-]+" % measure)

    def test_help_has_the_defaults(self):
        out = self.run_diff("--help")[1]
        self.assertIn("relmse_robust=0.02 ratio=0.01 block=0.08 channel_block=0.16 shift=0.1", out)

    def test_numbers_that_are_none(self):
        a = self.rgb.copy()
        a[2, 3, 1] = np.nan
        found = self.json(self.file("a.exr", a), self.file("b.exr", self.rgb), code=1)
        self.assertEqual([(n["channel"], n["x"], n["y"], n["value"]) for n in found["nonfinite"]], [("G", 3, 2, "nan")])
        self.assertEqual(found["failed"][0]["measure"], "nonfinite")
        self.assertEqual(found["measures"]["relmse"], 0)  # Of the others, and said to have failed.
        self.assertEqual(self.run_diff(self.file("a.exr", a), self.file("b.exr", self.rgb), "--allow-nonfinite")[0], 0)

    def test_limits_must_be_numbers(self):
        a = self.file("a.exr", self.rgb)
        for flags in (["--relmse", "nan"], ["--fail-above", "mse=nan"], ["--fail-above", "mse"], ["--fail-above", "psnr=3"],
                      ["--fail-above", "relms=3"], ["--fail-pixels", "200%"], ["--hard-fail", "-1"], ["--block", "-1"],
                      ["--crop", "5", "5", "0", "3"], ["--measure", "fip"], ["--yes"]):
            code, _, err = self.run_diff(a, a, *flags)
            self.assertEqual(code, 2, flags)
            self.assertIn("whit diff: ", err)

    def test_numbers_that_are_none_are_no_values_of_flags(self):
        a, png = self.file("a.exr", self.rgb), os.path.join(self.folder, "map.png")
        for flags in (["--noise", "--alpha", "nan"], ["--noise", "--alpha", "inf"], ["--noise", "--alpha", "0"],
                      *(["--heatmap", png, "--heat-scale", scale] for scale in ("0", "-1", "nan", "inf"))):
            code, _, err = self.run_diff(a, a, *flags)
            self.assertEqual(code, 2, flags)
            self.assertIn(flags[-2], err)
        self.assertFalse(os.path.exists(png))
        self.assertEqual(self.run_diff(a, a, "--heatmap", png, "--heat-scale", "0.5")[0], 0)

    def test_flags_without_effect_are_wrong_usage(self):
        a = self.file("a.exr", self.rgb)
        for flags, other in ((["--pixel-error", "0.1"], "--fail-pixels"), (["--alpha", "0.01"], "--noise"),
                             (["--signed"], "--heatmap"), (["--heat-scale", "1"], "--heatmap")):
            code, _, err = self.run_diff(a, a, *flags)
            self.assertEqual(code, 2, flags)
            self.assertIn("%s has no effect without %s" % (flags[0], other), err)
        # A policy may say the other half.
        policy = os.path.join(self.folder, "policy.json")
        for says, flags, code in (({"fail_pixels": 0}, ["--pixel-error", "0.1"], 0), ({"noise": True}, ["--alpha", "0.01"], 0),
                                  ({"noise": True}, ["--pixel-error", "0.1"], 2), ({"noise": False}, ["--alpha", "0.1"], 2)):
            with open(policy, "w", encoding="utf-8") as f:
                json.dump({"rules": [{"match": "other.exr"}, {"match": "**", **says}]}, f)
            self.assertEqual(self.run_diff(a, a, "--policy", policy, *flags)[0], code, (says, flags))

    def test_exact_says_what_it_makes_void(self):
        a = self.file("a.exr", self.rgb)
        void = ["--relmse", "1", "--ratio", "1", "--block", "10", "--hard-fail", "2", "--fail-above", "mae=1", "--fail-below",
                "ssim=0", "--fail-pixels", "1%", "--pixel-error", "1", "--noise", "--alpha", "0.1"]
        b = self.file("b.exr", self.rgb)
        code, out, err = self.run_diff(a, b, "--exact", *void, "--json")
        self.assertEqual(code, 0)
        self.assertEqual(json.loads(out)["limits"], {"exact": True})
        self.assertEqual(len(err.splitlines()), 1, err)
        for flag in (f for f in void if f.startswith("--")):
            self.assertIn(flag, err)
        self.assertEqual(self.run_diff(a, b, "--exact", "--allow-nonfinite")[2], "")

    def test_shares_of_pixels(self):
        # One pixel of 24 x 16 is off: 0.26 %.
        a = self.rgb.copy()
        a[3, 4] += 0.01
        a, b = self.file("a.exr", a), self.file("b.exr", self.rgb)
        for share, code in (("0", 1), ("0.0", 1), ("0%", 1), ("0.00%", 1), ("0.2%", 1), ("0.3%", 0), ("0.003", 0), ("100%", 0),
                            ("1", 2), ("1.0", 2), ("-0", 2), ("0x", 2), ("nan", 2), ("101%", 2)):
            found, _, err = self.run_diff(a, b, "--fail-pixels=" + share)
            self.assertEqual(found, code, share + err)
        self.assertIn("1%", self.run_diff(a, b, "--fail-pixels", "1")[2])

    def test_outputs_on_stdout_are_alone_there(self):
        a = self.file("a.exr", self.rgb)
        for flag in ("--html", "--junit"):
            code, out, err = self.run_diff(a, a, "--json", flag, "-")
            self.assertEqual((code, out), (2, ""))
            self.assertIn("--json", err)
            for names in ((a, a), (self.folder, self.folder)):
                code, out, err = self.run_diff(*names, flag, "-")
                self.assertEqual(code, 0)
                self.assertTrue(out.startswith("<"), out)
                self.assertIn("same", err)

    def test_heat_maps_are_png(self):
        a, b = self.file("a.exr", self.rgb), self.file("b.exr", 2 * self.rgb)
        for name in ("-", "map.exr", "map.jpg", "map", "png"):
            path = name if name == "-" else os.path.join(self.folder, name)
            code, out, err = self.run_diff(a, b, "--heatmap", path)
            self.assertEqual((code, out), (2, ""), name)
            self.assertIn("a heat map is a PNG", err)
            self.assertFalse(os.path.exists(path))
        self.assertEqual(self.run_diff(a, b, "--heatmap", os.path.join(self.folder, "map.PNG"))[0], 1)

    # What it says.

    def test_json_has_the_contract(self):
        a = self.rgb.copy()
        a[8:, 16:] *= 2
        found = self.json(self.file("a.exr", a), self.file("b.exr", self.rgb), "--noise", code=1)
        self.assertIs(found["same"], False)
        self.assertLessEqual({"measure", "value", "limit"}, set(found["failed"][0]))
        noise = found["noise"]
        self.assertIs(noise["same"], False)
        self.assertIs(noise["estimated"], True)
        self.assertLess(noise["p"], 0.001)
        self.assertLessEqual({"x0", "y0", "x1", "y1", "change"}, set(noise["regions"][0]))
        same = self.json(self.file("a.exr", a), self.file("a2.exr", a), code=0)
        self.assertEqual((same["same"], same["failed"], same["differing_pixels"]), (True, [], 0))
        self.assertIsNone(same["measures"]["psnr"])  # Infinite.

    def test_json_of_what_cannot_be_compared(self):
        a = self.file("a.exr", self.rgb)
        found = self.json(a, self.file("b.exr", self.rgb[1:]), code=4)
        self.assertIs(found["same"], False)
        self.assertIn("different sizes", found["cannot"])
        self.assertEqual(self.run_diff(a, self.folder + "/none.exr")[0], 4)

    def test_encodings_are_made_alike(self):
        linear = np.clip(self.rgb, 0, 1)
        png = self.file("a.png", np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055), kind="uint8")
        code, out, _ = self.run_diff(png, self.file("b.exr", linear))
        self.assertEqual(code, 0, out)
        self.assertIn("from sRGB to linear light", out)
        raw = self.file("raw.png", linear, kind="uint8")
        self.assertEqual(self.run_diff(raw, self.file("b.exr", linear))[0], 1)
        self.assertEqual(self.run_diff(raw, self.file("b.exr", linear), "--colorspace", "linear")[0], 0)
        code, _, err = self.run_diff(raw, self.file("b.exr", linear), "--colorspace", "nonsense")
        self.assertEqual(code, 2)
        self.assertIn("there are linear, sRGB", err)

    def test_older_flags(self):
        # All is 5 % brighter: relMSE about 0.0025 b^2 / (b^2 + e), the mean by 0.05, blocks by less than that.
        a, b = self.file("a.exr", 1.05 * self.rgb), self.file("b.exr", self.rgb)
        self.assertEqual(self.run_diff(a, b)[0], 1)
        self.assertEqual(self.run_diff(a, b, "--ratio", "0.06")[0], 0)
        self.assertEqual(self.run_diff(a, b, "--ratio", "0.06", "--block", "0.03")[0], 1)
        self.assertEqual(self.run_diff(a, b, "--ratio", "0.06", "--relmse", "0.001")[0], 1)
        self.assertEqual(self.run_diff(a, b, "--exact", "--ratio", "0.06")[0], 1)

    def test_crop(self):
        a = self.rgb.copy()
        a[:4, :4] += 1
        a, b = self.file("a.exr", a), self.file("b.exr", self.rgb)
        self.assertEqual(self.run_diff(a, b)[0], 1)
        code, out, _ = self.run_diff(a, b, "--exact", "--crop", "4", "24", "0", "16")
        self.assertEqual(code, 0, out)
        self.assertIn("compared only x 4 to 23, y 0 to 15", out)

    def test_names_of_channels_cannot_command_the_terminal(self):
        names = RGB + ("bad\x1b[31m.R", "two\nlines", "gr\u00fcn")
        a = self.file("a.exr", np.dstack([self.rgb, 2 * self.rgb]), names)
        b = self.file("b.exr", np.dstack([self.rgb, self.rgb]), names)
        for flags in ([], ["--verbose"], ["--noise"], ["--exact"]):
            code, out, err = self.run_diff(a, b, *flags)
            self.assertEqual(code, 1)
            self.assertNotIn("\x1b", out + err)
            self.assertNotRegex(out, "(?m)^lines")
            self.assertIn("gr\u00fcn", out)
        c = self.file("c.exr", self.rgb)
        self.assertNotIn("\x1b", "".join(self.run_diff(a, c)[1:]))

    def test_limits_that_are_off_are_left_out(self):
        a, b = self.file("a.exr", self.rgb), self.file("b.exr", self.rgb)
        names = ("relmse_robust", "ratio", "block", "channel_block", "shift", "mismatch")
        off = [part for name in names for part in ("--fail-above", name + "=inf")]
        off += ["--fail-below", "ssim=-inf", "--hard-fail", "inf", "--fail-pixels", "100%"]
        self.assertIn("limits: none\n", self.run_diff(a, b, *off)[1])
        self.assertEqual(self.json(a, b, *off, code=0)["limits"], {})
        some = ["--noise", "--alpha", "0.01", "--hard-fail", "0.5", "--fail-pixels", "2%", "--pixel-error", "0.1"]
        self.assertIn("limits: mismatch 0.02 hard-fail 0.5 fail-pixels 2 % noise alpha 0.01\n", self.run_diff(a, b, *some)[1])
        self.assertEqual(self.json(a, b, *some, code=0)["limits"], {
            "mismatch": 0.02, "hard-fail": 0.5, "fail-pixels": 0.02, "pixel-error": 0.1, "noise": True, "alpha": 0.01})

    def test_colour_on_a_terminal_only(self):
        a = self.file("a.exr", self.rgb)
        self.assertNotIn("\x1b", self.run_diff(a, a)[1])
        command = "'%s' diff '%s' '%s'" % (WHIT, a, a)
        for env, coloured in (({}, True), ({"NO_COLOR": "1"}, False)):
            done = subprocess.run(["script", "-qec", command, "/dev/null"], stdin=subprocess.DEVNULL, capture_output=True,
                                  env={**{k: v for k, v in os.environ.items() if k != "NO_COLOR"}, **env}, text=True, check=False)
            self.assertEqual("\x1b[1;32msame" in done.stdout, coloured, done.stdout)

    def test_dear_measures_when_asked(self):
        a, b = self.file("a.exr", 1.2 * self.rgb), self.file("b.exr", self.rgb)
        self.assertNotIn("flip", self.json(a, b, code=1)["measures"])
        self.assertLess(self.json(a, b, "--measure", "all", code=1)["measures"]["ssim"], 1)
        self.assertGreater(self.json(a, b, "--measure", "flip", code=1)["measures"]["flip"], 0)
        failed = self.json(a, b, "--fail-below", "ssim=1", "--ratio", "inf", "--block", "inf", "--relmse", "inf", code=1)["failed"]
        self.assertEqual([f["measure"] for f in failed], ["ssim"])


if __name__ == "__main__":
    unittest.main()
