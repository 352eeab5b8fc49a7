#!/usr/bin/env python3
"""`whit diff` of folders: the table, the exit code, policies, JUnit, JSON, --update and what it never touches."""
import json
import os
import pty
import shutil
import stat
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import numpy
import OpenImageIO as oiio

WHIT = os.environ.get("WHIT")


def write_picture(path, value, size=(16, 16), channels=("R", "G", "B"), at=None, corner=(0, 0), full=None):
    """A picture of one value, and `at` maps (x, y) to the value of that pixel, or (x, y, channel) to that number. With
    `full` it is the part at `corner` of a picture of that size."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    pixels = numpy.full((size[1], size[0], len(channels)), value, dtype=numpy.float32)
    for (x, y, *channel), other in (at or {}).items():
        pixels[y, x, [channels.index(c) for c in channel] or slice(None)] = other
    spec = oiio.ImageSpec(size[0], size[1], len(channels), oiio.FLOAT)
    spec.channelnames = channels
    spec.x, spec.y = corner
    spec.full_width, spec.full_height = full or size
    out = oiio.ImageOutput.create(path)
    if not out or not out.open(path, spec) or not out.write_image(pixels) or not out.close():
        raise RuntimeError(oiio.geterror())


@unittest.skipUnless(WHIT, "the program is not built")
class Folders(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="whit diff ")
        self.addCleanup(shutil.rmtree, self.folder)
        os.makedirs(self.path("out"))
        os.makedirs(self.path("refs"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def both(self, name, out, ref, **how):
        write_picture(self.path("out/" + name), out, **how)
        write_picture(self.path("refs/" + name), ref, **how)

    def bytes_of(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as f:
            f.write(text)

    def policy(self, *rules):
        self.write("policy.json", json.dumps({"rules": rules}))

    def diff(self, *arguments, code, a="out", b="refs"):
        """stdout and stderr of a run that must end with that code."""
        done = subprocess.run([WHIT, "diff", a, b, *arguments], input="", capture_output=True, text=True, cwd=self.folder,
                              timeout=120, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout, done.stderr

    def three(self):
        """Same, differing and not comparable."""
        self.both("sub/same.exr", 0.5, 0.5)
        self.both("differs.exr", 0.75, 0.5)
        write_picture(self.path("out/size.exr"), 0.5)
        write_picture(self.path("refs/size.exr"), 0.5, size=(8, 8))

    # --- the table and the exit code

    def test_all_the_same(self):
        self.both("a.exr", 0.5, 0.5)
        self.both("sub/b.exr", 0.25, 0.25)
        out, _ = self.diff(code=0)
        self.assertEqual(out, "2 same, 0 differ, 0 cannot be compared, 0 missing, 0 extra\n")

    def test_worst_first_and_exit_by_the_worst(self):
        self.both("a.exr", 0.51, 0.5)
        self.both("b.exr", 0.9, 0.5)
        self.both("c.exr", 0.5, 0.5)
        out, _ = self.diff(code=1)
        lines = out.splitlines()
        self.assertTrue(lines[0].startswith("differs  b.exr  "), out)
        self.assertTrue(lines[1].startswith("differs  a.exr  "), out)
        self.assertIn("ratio", out.replace("the mean is off", "ratio"))
        self.assertEqual(lines[2], "1 same, 2 differ, 0 cannot be compared, 0 missing, 0 extra")
        self.three()
        out, _ = self.diff(code=4)
        self.assertTrue(out.startswith("cannot   size.exr"), out)
        self.assertIn("1 cannot be compared", out)

    def test_verbose_has_a_row_for_each_and_aligned_columns(self):
        self.three()
        out, _ = self.diff("--verbose", code=4)
        lines = out.splitlines()
        self.assertIn("relmse_robust", lines[0])
        self.assertEqual(len(lines), 5)
        self.assertTrue(lines[3].startswith("same     sub/same.exr"), out)
        end = lines[0].index("relmse_robust") + len("relmse_robust")
        for line in lines[1:4]:
            self.assertNotEqual(line[end - 1], " ")
            self.assertEqual(line[end:end + 1].strip(), "")

    def test_missing_is_an_error_and_extra_is_named(self):
        self.both("a.exr", 0.5, 0.5)
        write_picture(self.path("out/new.exr"), 0.5)
        out, _ = self.diff(code=0)
        self.assertIn("extra    new.exr", out)
        write_picture(self.path("refs/gone.exr"), 0.5)
        out, _ = self.diff(code=4)
        self.assertIn("missing  gone.exr", out)
        self.assertIn("1 missing, 1 extra", out)

    def test_another_ending_is_named(self):
        write_picture(self.path("out/a.exr"), 0.5)
        write_picture(self.path("refs/a.png"), 0.5)
        out, _ = self.diff(code=4)
        self.assertIn("is a.exr meant?", out)

    def test_nothing_to_compare_is_no_success(self):
        _, err = self.diff(code=4)
        self.assertIn("no picture in \"refs\"", err)
        write_picture(self.path("out/a.exr"), 0.5)
        self.diff(code=4)
        _, err = self.diff(b="nowhere", code=4)
        self.assertIn("nowhere\": No such file", err)
        _, err = self.diff(b="out/a.exr", code=2)
        self.assertIn("is a folder", err)

    def test_pictures_that_cannot_be_read(self):
        self.both("a.exr", 0.5, 0.5)
        self.write("out/a.exr", "no picture")
        out, _ = self.diff(code=4)
        self.assertIn("cannot   a.exr", out)

    def test_names_cannot_command_the_terminal(self):
        self.both("\x1b[31mred.exr", 0.75, 0.5)
        out, _ = self.diff(code=1)
        self.assertNotIn("\x1b", out)

    # --- policies

    def test_policy_holds_limits_by_path(self):
        self.both("a.exr", 0.55, 0.5)
        self.both("soft/b.exr", 0.55, 0.5)
        loose = {"ratio": 0.2, "block": 0.2, "relmse_robust": 0.2}
        self.policy({"match": "soft/**", "fail_above": loose})
        out, err = self.diff("--policy", "policy.json", code=1)
        self.assertIn("differs  a.exr", out)
        self.assertIn("1 same, 1 differs", out)
        self.assertEqual(err, "")
        self.policy({"match": "**", "fail_above": loose})
        self.diff("--policy", "policy.json", code=0)
        out, _ = self.diff("--policy", "policy.json", "--fail-above", "ratio=0.01", code=1)
        self.assertIn("2 differ", out)
        self.policy({"match": "**", "fail_above": {"ratio": "off", "block": "off", "relmse_robust": "off"},
                     "fail_below": {"psnr": "off"}})
        self.diff("--policy", "policy.json", code=0)

    def test_policy_skips_with_a_reason(self):
        self.both("a.exr", 0.5, 0.5)
        self.both("b.exr", 0.9, 0.5)
        write_picture(self.path("refs/later.exr"), 0.5)
        self.policy({"match": "b.exr", "skip": "waits for the new lamp"}, {"match": "later.exr", "skip": "not yet"})
        out, _ = self.diff("--policy", "policy.json", "--junit", "junit.xml", code=0)
        self.assertIn("1 same, 0 differ, 0 cannot be compared, 0 missing, 0 extra, 2 skipped", out)
        suite = ElementTree.parse(self.path("junit.xml")).getroot().find("testsuite")
        self.assertEqual(suite.find("testcase[@name='b.exr']/skipped").get("message"), "waits for the new lamp")

    def test_policy_mistakes_end_it(self):
        self.both("a.exr", 0.5, 0.5)
        self.policy({"match": "**", "fail_abov": {}})
        _, err = self.diff("--policy", "policy.json", code=2)
        self.assertIn("policy.json: /rules/0/fail_abov: ", err)
        self.assertIn("did you mean \"fail_above\"?", err)
        self.diff("--policy", "none.json", code=2)

    def test_rules_that_match_nothing_are_named(self):
        self.both("sub/a.exr", 0.5, 0.5)
        self.policy({"match": "a.exr", "exact": True})
        _, err = self.diff("--policy", "policy.json", code=0)
        self.assertIn("/rules/0/match: no picture matches \"a.exr\"; did you mean \"**/a.exr\"?", err)

    def test_policy_of_one_picture(self):
        self.both("soft/b.exr", 0.55, 0.5)
        shutil.move(self.path("refs"), self.path("kept"))
        self.write("kept/policy.json", json.dumps({"rules": [{"match": "soft/b.exr", "fail_above": {
            "ratio": 1, "block": 1, "relmse_robust": 1}}]}))
        self.diff("--policy", "kept/policy.json", a="out/soft/b.exr", b="kept/soft/b.exr", code=0)
        self.diff(a="out/soft/b.exr", b="kept/soft/b.exr", code=1)

    def test_policy_skips_one_picture_as_it_does_among_others(self):
        self.both("a.exr", 0.75, 0.5)
        self.policy({"match": "**", "skip": "waits"})
        pair = {"a": "out/a.exr", "b": "refs/a.exr"}
        for report in ("page.html", "junit.xml"):
            self.write(report, "an old one: differs")
        reports = ("--policy", "policy.json", "--html", "page.html", "--junit", "junit.xml")
        out, _ = self.diff(*reports, "--json", code=0, **pair)
        self.assertEqual(json.loads(out), {"same": True, **pair, "skipped": "waits"})
        suite = ElementTree.parse(self.path("junit.xml")).getroot().find("testsuite")
        self.assertEqual(suite.find("testcase/skipped").get("message"), "waits")
        self.assertTrue(self.bytes_of("page.html").startswith(b"<!DOCTYPE html>"))
        out, _ = self.diff(*reports, code=0, **pair)
        self.assertEqual(out, "skipped by the policy: waits\n")
        _, err = self.diff("--policy", "policy.json", "--heatmap", "map.png", code=0, **pair)
        self.assertIn("map.png is not written", err)
        # A name that is wrong is no reason to pass.
        _, err = self.diff(*reports, a="out/a.exr", b="refs/typo.exr", code=4)
        self.assertIn("refs/typo.exr", err)

    def test_rules_that_miss_one_picture_are_named(self):
        self.both("a.exr", 0.5, 0.5)
        os.makedirs(self.path("rules"))
        for match, said in (("refs/a.exr", "\"refs/a.exr\" is not for this picture, whose name is \"a.exr\""),
                            ("other.exr", "no rule is for \"a.exr\""), ("a.exr", "")):
            self.write("rules/policy.json", json.dumps({"rules": [{"match": match, "hard_fail": 0}]}))
            _, err = self.diff("--policy", "rules/policy.json", a="out/a.exr", b="refs/a.exr", code=0)
            self.assertIn(said, err)
            self.assertEqual("warning" in err, bool(said))

    # --- what is written

    def test_json_has_a_pair_for_each(self):
        self.three()
        write_picture(self.path("refs/gone.exr"), 0.5)
        write_picture(self.path("out/new.exr"), 0.5)
        out, _ = self.diff("--json", code=4)
        found = json.loads(out)
        self.assertEqual([p["name"] for p in found["pairs"]], ["differs.exr", "size.exr", "sub/same.exr"])
        self.assertIs(found["same"], False)  # As of two files, and as the exit code says.
        self.assertEqual(found["counts"], {"same": 1, "differ": 1, "cannot": 1})
        self.assertEqual((found["missing"], found["extra"], found["updated"]), (["gone.exr"], ["new.exr"], []))
        alone, _ = self.diff("--json", a="out/differs.exr", b="refs/differs.exr", code=1)
        pair = found["pairs"][0]
        del pair["name"]
        self.assertEqual(pair, json.loads(alone))

    def test_what_is_compared_with_itself_is_named(self):
        self.both("a.exr", 0.5, 0.5)
        self.both("b.exr", 0.5, 0.5)
        _, err = self.diff(code=0)
        self.assertEqual(err, "")
        os.remove(self.path("out/a.exr"))
        os.symlink("../refs/a.exr", self.path("out/a.exr"))
        for names, said in (({}, "compared with themselves: a.exr\n"), ({"b": "out"}, "are one folder"),
                            ({"b": "./refs/../out"}, "are one folder"),
                            ({"a": "out/a.exr", "b": "refs/a.exr"}, "are one file"),
                            ({"a": "out/b.exr", "b": "out/b.exr"}, "are one file")):
            _, err = self.diff(code=0, **names)
            self.assertIn("warning: ", err)
            self.assertIn(said, err)

    def test_junit_has_a_case_for_each(self):
        self.three()
        write_picture(self.path("refs/gone.exr"), 0.5)
        write_picture(self.path("out/new.exr"), 0.5)
        self.diff("--junit", "junit.xml", code=4)
        suite = ElementTree.parse(self.path("junit.xml")).getroot().find("testsuite")
        self.assertEqual([suite.get(n) for n in ("tests", "failures", "errors", "skipped")], ["5", "1", "2", "1"])
        kinds = {case.get("name"): [child.tag for child in case] for case in suite.iter("testcase")}
        self.assertEqual(kinds, {"differs.exr": ["failure"], "gone.exr": ["error"], "new.exr": ["skipped"],
                                 "size.exr": ["error"], "sub/same.exr": []})

    def test_outputs_never_overwrite_what_is_read(self):
        self.both("a.exr", 0.75, 0.5)
        write_picture(self.path("refs/gone.exr"), 0.5)
        self.policy({"match": "**"})
        os.symlink("refs/a.exr", self.path("link"))
        kept = {name: self.bytes_of(name) for name in ("out/a.exr", "refs/a.exr", "refs/gone.exr", "policy.json")}
        for name in (*kept, "link"):
            for flag in ("--html", "--junit"):
                _, err = self.diff("--policy", "policy.json", flag, name, code=2)
                self.assertIn("would overwrite", err)
        for name in ("out/a.exr", "refs/a.exr"):
            for flag in ("--html", "--junit", "--heatmap"):
                self.diff(flag, name, a="out/a.exr", b="refs/a.exr", code=2)
        self.assertEqual(kept, {name: self.bytes_of(name) for name in kept})
        self.diff("--html", "same", "--junit", "./same", code=2)
        self.diff("--junit", "nowhere/junit.xml", code=4)

    # --- --update

    def test_update_replaces_what_failed_and_nothing_else(self):
        self.three()
        self.both("near.exr", 0.5001, 0.5)
        before = {name: os.stat(self.path(name)).st_mtime_ns for name in ("refs/near.exr", "refs/sub/same.exr")}
        near = self.bytes_of("refs/near.exr")
        os.chmod(self.path("refs/differs.exr"), 0o640)
        out, _ = self.diff("--update", "--yes", code=0)
        for name in ("differs.exr", "size.exr"):
            self.assertIn(f"replaced  refs/{name}\n", out)
            self.assertEqual(self.bytes_of("refs/" + name), self.bytes_of("out/" + name))
        self.assertEqual(stat.S_IMODE(os.stat(self.path("refs/differs.exr")).st_mode), 0o640)
        self.assertEqual(self.bytes_of("refs/near.exr"), near)
        self.assertEqual(before, {name: os.stat(self.path(name)).st_mtime_ns for name in before})
        self.diff(code=0)

    def test_update_leaves_missing_ones(self):
        self.both("a.exr", 0.75, 0.5)
        write_picture(self.path("refs/gone.exr"), 0.5)
        out, _ = self.diff("--update", "--yes", "--json", code=4)
        self.assertEqual(json.loads(out)["updated"], ["a.exr"])
        self.assertTrue(os.path.exists(self.path("refs/gone.exr")))

    def test_update_refuses_broken_pictures(self):
        self.both("nan.exr", 0.5, 0.5)
        write_picture(self.path("out/nan.exr"), 0.5, at={(3, 5): numpy.nan})
        self.both("inf.exr", 0.5, 0.5)
        write_picture(self.path("out/inf.exr"), 0.5, size=(8, 8), at={(1, 2): numpy.inf})
        self.both("torn.exr", 0.5, 0.5)
        with open(self.path("out/torn.exr"), "r+b") as f:
            f.truncate(200)
        kept = {name: self.bytes_of("refs/" + name) for name in ("nan.exr", "inf.exr", "torn.exr")}
        out, _ = self.diff("--update", "--yes", code=4)
        self.assertRegex(out, r"stays     refs/nan.exr: its [RGB] is nan at \(3, 5\)")
        self.assertRegex(out, r"stays     refs/inf.exr: its [RGB] is inf at \(1, 2\)")
        self.assertIn("stays     refs/torn.exr", out)
        self.assertIn("no reference was replaced", out)
        self.assertEqual(kept, {name: self.bytes_of("refs/" + name) for name in kept})
        self.diff("--update", "--yes", "--allow-nonfinite", code=4)
        self.assertEqual(self.bytes_of("refs/inf.exr"), self.bytes_of("out/inf.exr"))

    def test_update_loses_no_pixels(self):
        whole = {"size": (16, 16)}
        part = {"size": (8, 8), "corner": (4, 4), "full": (16, 16)}
        for name, out, ref, lost in (
                ("crop.exr", part, whole, True),
                ("other crop.exr", {**part, "corner": (5, 4)}, part, True),
                ("crop at another size.exr", {**part, "full": (32, 32)}, whole, True),
                ("same crop.exr", part, part, False),
                ("more.exr", whole, part, False),
                ("beyond the edge.exr", {"size": (18, 18), "corner": (-1, -1), "full": (16, 16)}, whole, False),
                ("another size.exr", {"size": (32, 32)}, whole, False)):
            write_picture(self.path("out/a.exr"), 0.75, **out)
            write_picture(self.path("refs/a.exr"), 0.5, **ref)
            kept = self.bytes_of("refs/a.exr")
            for names in ({}, {"a": "out/a.exr", "b": "refs/a.exr"}):
                with open(self.path("refs/a.exr"), "wb") as f:
                    f.write(kept)  # Written anew it would have another date.
                done = subprocess.run([WHIT, "diff", names.get("a", "out"), names.get("b", "refs"), "--update", "--yes"],
                                      capture_output=True, text=True, cwd=self.folder, timeout=120, check=False)
                self.assertEqual(done.returncode == 0, not lost, name + done.stdout)
                self.assertEqual("its picture is a crop" in done.stdout, lost, name + done.stdout)
                self.assertEqual(self.bytes_of("refs/a.exr"), kept if lost else self.bytes_of("out/a.exr"), name)

    def test_update_loses_no_channels(self):
        rgbn = ("R", "G", "B", "N.X", "N.Y", "N.Z")
        write_picture(self.path("out/a.exr"), 0.75)
        write_picture(self.path("refs/a.exr"), 0.5, channels=rgbn)
        kept = self.bytes_of("refs/a.exr")
        out, _ = self.diff("--update", "--yes", "--channels", "R,G,B", code=1)
        self.assertIn("stays     refs/a.exr: its picture lacks N.X, N.Y, N.Z, which the reference has", out)
        self.assertEqual(self.bytes_of("refs/a.exr"), kept)
        write_picture(self.path("out/a.exr"), 0.75, channels=rgbn + ("Z",))
        self.diff("--update", "--yes", "--channels", "R,G,B", code=0)
        self.assertEqual(self.bytes_of("refs/a.exr"), self.bytes_of("out/a.exr"))

    def test_update_refuses_broken_numbers_in_what_is_not_compared(self):
        rgb_variance = ("R", "G", "B", "variance.R")
        write_picture(self.path("out/a.exr"), 0.75, channels=rgb_variance, at={(2, 3, "G"): numpy.nan})
        write_picture(self.path("refs/a.exr"), 0.5, channels=rgb_variance)
        out, _ = self.diff("--update", "--yes", "--channels", "R", code=1)
        self.assertIn("stays     refs/a.exr: its G is nan at (2, 3)", out)
        # A variance may be infinite, for it is not known; it cannot be NaN.
        write_picture(self.path("out/a.exr"), 0.75, channels=rgb_variance, at={(2, 3, "variance.R"): numpy.nan})
        self.diff("--update", "--yes", code=1)
        write_picture(self.path("out/a.exr"), 0.75, channels=rgb_variance, at={(2, 3, "variance.R"): numpy.inf})
        self.diff("--update", "--yes", code=0)

    def test_update_without_a_terminal_changes_nothing(self):
        self.three()
        kept = self.bytes_of("refs/differs.exr")
        for names in ({}, {"a": "out/differs.exr", "b": "refs/differs.exr"}):
            _, err = self.diff("--update", code=2, **names)
            self.assertIn("no terminal", err)
            self.assertIn("--yes", err)
        self.assertEqual(self.bytes_of("refs/differs.exr"), kept)

    def answer(self, text, *arguments):
        """Exit code of a run on a terminal where somebody types this."""
        master, slave = pty.openpty()
        done = subprocess.Popen([WHIT, "diff", *arguments, "--update"], stdin=slave, stderr=slave,
                                stdout=subprocess.DEVNULL, cwd=self.folder)
        os.close(slave)
        os.write(master, text)
        code = done.wait(timeout=120)
        os.close(master)
        return code

    def test_update_asks_on_a_terminal(self):
        self.both("a.exr", 0.75, 0.5)
        kept = self.bytes_of("refs/a.exr")
        for no in (b"n\n", b"\n", b"x\n", b"\x04"):
            self.assertEqual(self.answer(no, "out", "refs"), 1)
            self.assertEqual(self.bytes_of("refs/a.exr"), kept)
        self.assertEqual(self.answer(b"y\n", "out", "refs"), 0)
        self.assertEqual(self.bytes_of("refs/a.exr"), self.bytes_of("out/a.exr"))

    def test_update_of_two_files(self):
        self.both("a.exr", 0.75, 0.5)
        write_picture(self.path("refs/a.png"), 0.2)
        png = self.bytes_of("refs/a.png")
        kept, pair = self.bytes_of("refs/a.exr"), {"a": "out/a.exr", "b": "refs/a.exr"}
        self.diff("--update", "--yes", code=0, **pair)
        self.assertEqual(self.bytes_of("refs/a.exr"), self.bytes_of("out/a.exr"))
        with open(self.path("refs/a.exr"), "wb") as f:
            f.write(kept)
        # The JSON is of what was done, as that of folders.
        found = json.loads(self.diff("--update", "--yes", "--json", code=0, **pair)[0])
        self.assertEqual((found["same"], found["updated"], len(found["failed"]) > 0), (True, ["refs/a.exr"], True))
        found = json.loads(self.diff("--update", "--yes", "--json", code=0, **pair)[0])
        self.assertEqual((found["same"], found["updated"]), (True, []))
        out, _ = self.diff("--update", "--yes", "--channels", "R,G,B", a="out/a.exr", b="refs/a.png", code=1)
        self.assertIn("cannot stand in the place of", out)
        self.assertEqual(self.bytes_of("refs/a.png"), png)

    def test_update_follows_links_and_spares_what_others_share(self):
        self.both("a.exr", 0.75, 0.5)
        self.both("passes.exr", 0.5, 0.5)
        write_picture(self.path("out/shares.exr"), 0.75)
        os.symlink("passes.exr", self.path("refs/shares.exr"))
        os.rename(self.path("refs/a.exr"), self.path("stored.exr"))
        os.symlink("../stored.exr", self.path("refs/a.exr"))
        passes = self.bytes_of("refs/passes.exr")
        out, _ = self.diff("--update", "--yes", code=1)
        self.assertIn("refs/shares.exr: its reference is that of passes.exr, too", out)
        self.assertEqual(self.bytes_of("refs/passes.exr"), passes)
        self.assertTrue(os.path.islink(self.path("refs/a.exr")))
        self.assertEqual(self.bytes_of("stored.exr"), self.bytes_of("out/a.exr"))

    def test_update_spares_what_is_write_protected(self):
        self.both("a.exr", 0.75, 0.5)
        os.chmod(self.path("refs/a.exr"), 0o444)
        out, _ = self.diff("--update", "--yes", code=1)
        self.assertIn("write-protected", out)

    def test_yes_goes_with_update(self):
        self.both("a.exr", 0.75, 0.5)
        _, err = self.diff("--yes", code=2)
        self.assertIn("--update", err)


if __name__ == "__main__":
    unittest.main()
