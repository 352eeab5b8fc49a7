#!/usr/bin/env python3
"""JUnit files are valid by the schema of Jenkins' xUnit plugin (junit-10.xsd), and other programs read the names back."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

PROGRAM = os.path.join(os.environ.get("WHIT_BINARY_DIR", "build/release"), "tests", "test_compare")
SCHEMA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "junit-10.xsd")
XMLLINT = shutil.which("xmllint")


class JUnitFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="whit-junit-")
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        subprocess.run([PROGRAM, "--gtest_filter=JUnit.WritesFilesForTheSchemaTest"], check=True, timeout=60,
                       stdout=subprocess.DEVNULL, env={**os.environ, "WHIT_JUNIT_FILES": cls.folder})

    def lint(self, path):
        return subprocess.run([XMLLINT, "--noout", "--nonet", "--schema", SCHEMA, path], capture_output=True, text=True,
                              timeout=60, check=False)

    def test_are_valid(self):
        for name in ("all.xml", "none.xml"):
            done = self.lint(os.path.join(self.folder, name))
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_schema_is_asked(self):
        path = os.path.join(self.folder, "broken.xml")
        with open(os.path.join(self.folder, "all.xml"), encoding="utf-8") as whole, \
                open(path, "w", encoding="utf-8") as broken:
            broken.write(whole.read().replace(' failures="', ' failed="'))
        self.assertNotEqual(self.lint(path).returncode, 0)

    def test_names_and_outcomes_are_read_back(self):
        suite = ElementTree.parse(os.path.join(self.folder, "all.xml")).getroot().find("testsuite")
        self.assertEqual(suite.get("name"), "refs <&> \\x07")
        cases = suite.findall("testcase")
        outcomes = {case.get("name"): [child.tag for child in case] for case in cases}
        self.assertEqual(len(cases), int(suite.get("tests")))
        for tag, counter in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
            self.assertEqual([tag] in outcomes.values(), True)
            self.assertEqual(sum(found == [tag] for found in outcomes.values()), int(suite.get(counter)))
        self.assertEqual(outcomes["same.exr"], [])
        self.assertEqual(outcomes["<&>\"' .exr"], ["failure"])
        self.assertEqual(outcomes["tab\tline\nreturn\r.exr"], ["failure"])
        self.assertEqual(outcomes["control\\x00\\x01\\x1b[31m\x7f.exr"], ["failure"])
        self.assertEqual(outcomes["bytes\\xff\\xc3(\\xe2\\x82.exr"], ["failure"])
        self.assertEqual(outcomes["letters\u00e4\u20ac\U0001f600\\xef\\xbf\\xbe.exr"], ["failure"])
        odd = suite.find("testcase[@name='tab\tline\nreturn\r.exr']/failure")
        self.assertEqual((odd.get("message"), odd.text), ("a\tb\nc\rd", "a\tb\nc\rd"))
        self.assertIn("same.exr\nrelmse 0\nblock 0", suite.find("system-out").text)


if __name__ == "__main__":
    if XMLLINT is None or not os.path.exists(PROGRAM):
        print("skipped: xmllint (libxml2-utils) is not installed, or test_compare is not built")
        sys.exit(77)
    unittest.main()
