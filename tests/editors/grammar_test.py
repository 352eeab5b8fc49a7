#!/usr/bin/env python3
"""The grammars for editors are those of this program, and name every part of a scene file."""
import glob
import json
import os
import re
import subprocess
import sys
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
WHIT = os.environ.get("WHIT", os.path.join(ROOT, "build", "release", "whit"))
EXTENSION = os.path.join(ROOT, "tools", "editors", "vscode")
SCOPES = os.path.join(ROOT, "tests", "editors", "scopes.pbrt")


class Grammar:
    """Applies the rules of a TextMate grammar as far as ours uses them: matches with captures, and one level of regions."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as f:
            self.rules = json.load(f)["patterns"]
        for rule in self.rules:
            rule["regex"] = re.compile(rule.get("match", rule.get("begin")))
            if "end" in rule:
                rule["end_regex"] = re.compile(rule["end"])

    def scopes(self, line):
        """A set of scopes for each character of a line."""
        found = [set() for _ in line]

        def mark(start, end, names):
            for i in range(start, end):
                found[i].update(names.split())

        at = 0
        while at < len(line):
            # The rule that matches first, and of those at one place the one that stands first.
            matches = [(m.start(), i, m) for i, m in ((i, r["regex"].search(line, at)) for i, r in enumerate(self.rules))
                       if m]
            if not matches:
                break
            _, i, match = min(matches, key=lambda m: m[:2])
            rule = self.rules[i]
            end = match.end()
            if "end" in rule:
                while True:
                    closing = rule["end_regex"].search(line, end)
                    escape = re.compile(r"\\.").search(line, end)
                    if not escape or escape.start() > closing.start():
                        break
                    end = escape.end()
                end = closing.end()
            mark(match.start(), end, rule.get("name", ""))
            for group, scope in rule.get("captures", {}).items():
                if match.group(int(group)) is not None:
                    mark(*match.span(int(group)), scope["name"])
            at = max(end, at + 1)
        return found


class Grammars(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.grammar = Grammar(ROOT + "/tools/editors/vscode/syntaxes/pbrt.tmLanguage.json")

    def test_they_are_not_stale(self):
        done = subprocess.run([sys.executable, ROOT + "/tools/make-editors", "--check"], env={**os.environ, "WHIT": WHIT},
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_the_parts_of_a_file_have_their_names(self):
        # vscode-tmgrammar-test reads the same file: below a line, ^ under its characters, and the scope they have.
        line, scopes, checked = "", [], 0
        with open(SCOPES, encoding="utf-8") as f:
            for number, text in enumerate(f.read().splitlines(), 1):
                mark = re.match(r"#( *)(\^+) (\S+)$", text)
                if not mark:
                    line, scopes = text, self.grammar.scopes(text)
                    continue
                for i in range(mark.start(2), mark.end(2)):
                    self.assertIn(mark.group(3), scopes[i], "%s:%d: %r" % (SCOPES, number, line[i:mark.end(2)]))
                checked += 1
        self.assertGreater(checked, 40)

    def test_every_character_of_every_scene_is_something(self):
        files = sorted(glob.glob(ROOT + "/scenes/**/*.pbrt", recursive=True))
        self.assertGreater(len(files), 10)
        plugins = 0
        for path in files:
            with open(path, encoding="utf-8") as f:
                for number, line in enumerate(f.read().splitlines(), 1):
                    if len(line) > 2000:
                        continue  # Lists of numbers.
                    for i, names in enumerate(self.grammar.scopes(line)):
                        where = "%s:%d:%d: %s" % (path, number, i + 1, line)
                        self.assertTrue(names or line[i].isspace(), where)
                        self.assertFalse(any(n.startswith("invalid") for n in names), where)
                        plugins += "support.class.plugin.pbrt" in names
        self.assertGreater(plugins, 100)

    def test_all_words_of_the_program_are_known(self):
        known = json.loads(subprocess.run([WHIT, "help", "--json"], check=True, capture_output=True, text=True).stdout)
        for statement in known["statements"]:
            first = self.grammar.scopes(statement["name"])[0]
            self.assertTrue(first and not any(n.startswith("invalid") for n in first), statement["name"])
            for category in statement["plugins"] if statement["strings"] == 1 else []:
                if statement["name"].startswith("MakeNamed"):
                    continue
                for plugin in (p for p in known["plugins"] if p["category"] == category):
                    for name in filter(None, [plugin["name"]] + plugin["aliases"]):
                        line = '%s "%s"' % (statement["name"], name)
                        self.assertIn("support.class.plugin.pbrt", self.grammar.scopes(line)[-2], line)
        for kind in known["types"]:
            self.assertIn("storage.type.parameter.pbrt", self.grammar.scopes('"%s x"' % kind["name"])[1], kind)


class Extension(unittest.TestCase):
    """What can be said of the extension for VS Code without node."""

    def package(self):
        with open(EXTENSION + "/package.json", encoding="utf-8") as f:
            return json.load(f)

    def test_its_files_are_there(self):
        contributes = self.package()["contributes"]
        for path in [contributes["languages"][0]["configuration"], contributes["grammars"][0]["path"], "README.md",
                     "LICENSE", "package-lock.json"]:
            self.assertTrue(os.path.exists(os.path.join(EXTENSION, path)), path)
        with open(EXTENSION + "/language-configuration.json", encoding="utf-8") as f:
            self.assertEqual(json.load(f)["comments"]["lineComment"], "#")

    def test_the_problem_matcher_reads_what_check_prints(self):
        pattern = self.package()["contributes"]["problemMatchers"][0]["pattern"]
        match = re.match(pattern["regexp"], 'scenes/a:b.pbrt:8:13: warning: sphere has no parameter "raduis"')
        self.assertEqual([match.group(pattern[k]) for k in ("file", "line", "column", "severity", "message")],
                         ["scenes/a:b.pbrt", "8", "13", "warning", 'sphere has no parameter "raduis"'])

    def test_blocks_are_those_of_the_language(self):
        # Where files that are not made by tools/make-editors name them.
        known = json.loads(subprocess.run([WHIT, "help", "--json"], check=True, capture_output=True, text=True).stdout)
        blocks = {s["name"][:-len("Begin")] for s in known["statements"] if s["name"].endswith("Begin")}
        for path in (EXTENSION + "/language-configuration.json", ROOT + "/tools/editors/vim/ftplugin/pbrt.vim"):
            with open(path, encoding="utf-8") as f:
                named = re.findall(r"\((?:\?:)?((?:\w+\\?\|)+\w+)\\?\)\\*(?:Begin|End)", f.read())
            self.assertTrue(named, path)
            for names in named:
                self.assertEqual(set(re.split(r"\\?\|", names)), blocks, path)


if __name__ == "__main__":
    if not os.path.exists(WHIT):
        print("the program is not built")
        sys.exit(77)
    unittest.main()
