#!/usr/bin/env python3
"""VS Code's own reader of grammars finds in tests/editors/scopes.pbrt what ours finds. Skipped where it is not installed."""
import os
import shutil
import subprocess
import sys

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
EXTENSION = os.path.join(ROOT, "tools", "editors", "vscode")
RUNNER = EXTENSION + "/node_modules/.bin/vscode-tmgrammar-test"

if not shutil.which("node") or not os.path.exists(RUNNER):
    print("install it by `npm ci --ignore-scripts` in tools/editors/vscode")
    sys.exit(77)
sys.exit(subprocess.run([RUNNER, "-g", EXTENSION + "/syntaxes/pbrt.tmLanguage.json",
                         ROOT + "/tests/editors/scopes.pbrt"], timeout=120, check=False).returncode)
