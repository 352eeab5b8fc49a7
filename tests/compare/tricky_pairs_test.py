#!/usr/bin/env python3
"""Whether `whit diff` says what a person would of the pairs of tricky_pairs.py; docs/diff.md has the table of them.

    tests/compare/tricky_pairs_test.py --write    writes the table into docs/diff.md, from a run of $WHIT or build/release/whit
"""
import os
import re
import subprocess
import sys
import tempfile

import tricky_pairs

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
WHIT = os.environ.get("WHIT") or os.path.join(ROOT, "build", "release", "whit")
PAGE = os.path.join(ROOT, "docs", "diff.md")
BEGIN, END = "<!-- pairs: made by tests/compare/tricky_pairs_test.py --write -->\n", "<!-- end of pairs -->\n"
ANSWERS = {0: "same", 1: "differs", 4: "cannot compare"}


def ask(pair):
    done = subprocess.run([WHIT, "diff", pair.a, pair.b, *pair.flags.split()], stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def row(number, pair, code, folder):
    flags = " `%s`" % pair.flags if pair.flags else ""
    return "| %d | %s%s | %s | %s |\n" % (number, pair.name, flags, ANSWERS.get(code, "exit %d" % code), pair.why)


def main():
    rows, problems = [], []
    with tempfile.TemporaryDirectory() as folder:
        pairs = tricky_pairs.pairs(WHIT, folder)
        for number, pair in enumerate(pairs, 1):
            code, said = ask(pair)
            rows.append(row(number, pair, code, folder))
            if code != pair.expected or not re.search(pair.names, said):
                problems.append("%d, %s: exit %d where %d and \"%s\" are expected:\n%s" %
                                (number, pair.name, code, pair.expected, pair.names, said))
    if len(pairs) < 40:
        problems.append("%d pairs are not 40" % len(pairs))
    table = "| | A is B with | answer | why |\n|--:|---|---|---|\n" + "".join(rows)
    with open(PAGE, encoding="utf-8") as f:
        page = f.read()
    before, rest = page.split(BEGIN)
    after = rest.split(END)[1]
    if sys.argv[1:] == ["--write"]:
        with open(PAGE, "w", encoding="utf-8") as f:
            f.write(before + BEGIN + table + END + after)
    elif page != before + BEGIN + table + END + after:
        problems.append("the table in docs/diff.md is of another run: tests/compare/tricky_pairs_test.py --write")
    print("\n".join(problems) or "%d pairs" % len(pairs))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
