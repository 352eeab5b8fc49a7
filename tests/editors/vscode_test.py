#!/usr/bin/env python3
"""The extension for VS Code, with a stand-in for VS Code: what it starts, and what it says when it cannot.

Also that the tree-sitter grammar uses no rule that is not there. Skipped without node.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
EXTENSION = os.path.join(ROOT, "tools", "editors", "vscode")
NODE = shutil.which("node")

# Stands for the program: takes down how it was called, and prints an address as `whit watch` does.
PROGRAM = """\
#!/bin/sh
echo "$@" >> "%(folder)s/calls"
case "$1" in
  watch) echo "watching"; echo "http://127.0.0.1:4567/abc/"; echo $$ > "%(folder)s/pid"; exec sleep 60 ;;
esac
"""


def package():
    with open(EXTENSION + "/package.json", encoding="utf-8") as f:
        return json.load(f)


class Activation(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.program = self.write("whit", PROGRAM % {"folder": self.folder})
        os.chmod(self.program, 0o755)
        self.scene = self.write("a scene.pbrt", "WorldBegin\nWorldEnd\n")

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
        return path

    def run_extension(self, *steps, path=None, language="pbrt", **settings):
        asked = {"steps": steps, "settings": {"path": path or self.program, **settings}, "file": self.scene,
                 "language": language}
        done = subprocess.run([NODE, ROOT + "/tests/editors/vscode_stub.js", json.dumps(asked)], capture_output=True,
                              text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def calls(self):
        with open(os.path.join(self.folder, "calls"), encoding="utf-8") as f:
            return f.read().splitlines()

    def test_it_starts_the_server(self):
        did = self.run_extension()
        self.assertEqual(did["errors"], [])
        self.assertEqual(did["commands"], sorted(c["command"] for c in package()["contributes"]["commands"]))
        (client,) = did["clients"]
        self.assertEqual((client["command"], client["args"], client["started"], client["stopped"]),
                         (self.program, ["lsp"], True, True))
        self.assertIn({"scheme": "file", "language": "pbrt"}, client["languages"])

    def test_it_says_that_the_program_is_not_there(self):
        did = self.run_extension(path="/nonexistent/whit")
        self.assertEqual(did["clients"], [])
        self.assertIn('"/nonexistent/whit": there is no such program', did["errors"][0])
        self.assertEqual(did["executed"], [["workbench.action.openSettings", "whit.path"]])

    def test_another_path_starts_it_anew(self):
        did = self.run_extension({"set": {"path": self.program}}, path="/nonexistent/whit")
        self.assertEqual([c["command"] for c in did["clients"]], [self.program])

    def test_the_preview_is_beside_the_text(self):
        did = self.run_extension({"command": "whit.preview"}, {"command": "whit.preview"},
                                 previewArguments=["--spp", "4"])
        self.assertEqual(did["errors"], [])
        self.assertTrue(did["saved"])
        # Once started, the second time only shown again.
        self.assertEqual([c for c in self.calls() if c.startswith("watch")],
                         ["watch %s --spp 4" % self.scene])
        opened = ["simpleBrowser.api.open", {"text": "http://127.0.0.1:4567/abc/"},
                  {"viewColumn": -2, "preserveFocus": True}]
        self.assertEqual(did["executed"], [opened, opened])
        # It ends with VS Code.
        with open(os.path.join(self.folder, "pid"), encoding="utf-8") as f:
            pid = int(f.read())
        for _ in range(100):
            if not os.path.exists("/proc/%d" % pid):
                break
            time.sleep(0.05)
        self.assertFalse(os.path.exists("/proc/%d" % pid))

    def test_a_preview_that_fails_is_said(self):
        self.write("whit", '#!/bin/sh\n[ "$1" != watch ] || { echo "no such scene" >&2; exit 4; }\n')
        did = self.run_extension({"command": "whit.preview"})
        self.assertIn("it ended with exit code 4", did["errors"][0])
        self.assertIn("no such scene", did["output"])
        did = self.run_extension({"command": "whit.preview"}, language="plaintext")
        self.assertIn("open a .pbrt file first", did["errors"][0])

    def test_check_is_a_task(self):
        did = self.run_extension({"command": "whit.check"})
        (task,) = did["tasks"]
        self.assertEqual((task["execution"], task["matchers"]),
                         ({"program": self.program, "args": ["check", self.scene]}, "$whit"))


class TreeSitter(unittest.TestCase):
    def test_every_rule_that_is_used_is_there(self):
        # The functions of tree-sitter's language, as far as they tell which rules a rule uses.
        script = """
          const used = new Set();
          const all = (...parts) => parts;
          Object.assign(global, {seq: all, choice: all, repeat: all, repeat1: all, optional: all, token: all,
            field: (name, rule) => rule, alias: (rule, name) => rule, prec: Object.assign(all, {right: all, left: all}),
            grammar: (g) => g});
          const g = require(process.argv[1]);
          const $ = new Proxy({}, {get: (_, name) => { used.add(name); return name; }});
          for (const rule of Object.values(g.rules)) rule($);
          g.word($); g.extras($);
          console.log(JSON.stringify({rules: Object.keys(g.rules), used: [...used]}));
        """
        done = subprocess.run([NODE, "-e", script, ROOT + "/tools/editors/tree-sitter/grammar.js"], capture_output=True,
                              text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        told = json.loads(done.stdout)
        # Those that are only names of a place in the tree.
        names = {"block_keyword", "plugin_directive", "transform_directive", "name_directive"}
        self.assertEqual(set(told["used"]) - set(told["rules"]), names)
        with open(ROOT + "/tools/editors/tree-sitter/queries/highlights.scm", encoding="utf-8") as f:
            queried = set(re.findall(r"\((\w+)", f.read()))
        self.assertEqual(queried - set(told["rules"]) - names, set())


if __name__ == "__main__":
    if not NODE:
        print("there is no node")
        sys.exit(77)
    unittest.main()
