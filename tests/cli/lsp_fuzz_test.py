#!/usr/bin/env python3
"""Random edits of every scene in `whit lsp`: it must not crash, and what it says of the last text must be what `whit check`
says of that text."""
import collections
import glob
import json
import os
import random
import re
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from lsp_client import Client, position, uri_of  # noqa: E402

WHIT, SOURCE = os.environ["WHIT"], os.environ["WHIT_SOURCE_DIR"]
EDITS, EDITS_EACH_ELSEWHERE, LARGEST = 2000, 5, 200000
PIECES = ['"', "[", "]", "#", "\n", " ", "1", "-", "x", "Shape", "AttributeBegin\n", "AttributeEnd\n", "WorldEnd\n", '"float radius" ',
          '"rgb Kd" [ 1 2 3 ]', "\u00e9", "\U0001f600", "Include \"x.pbrt\"\n", '"texture Kd" "t"', "NamedMaterial \"m\"\n", "\r\n", "\\"]
ASKED = ["completion", "hover", "definition", "documentHighlight"]
ASKED_OF_ALL = ["documentSymbol", "foldingRange", "semanticTokens/full", "documentColor", "documentLink"]


SEVERITIES = {"error": 1, "warning": 2, "note": 3}


def comparable(found, folder):
    """How often it is said what of which line: without the name of the file, which one of the two does not know, and
    with names that start from the folder, as they do there."""
    out = collections.Counter()
    for line, severity, name, message in found:
        plain = re.sub(r"<stdin>|[\w.-]+\.pbrt(?=:\d)", "", message.replace(folder + "/", ""))
        out[(line, severity, name, plain)] += 1
    return out


def checked(folder, text):
    """What `whit check` says of a text that stands in a folder."""
    done = subprocess.run([WHIT, "check", "--json", "-"], input=text.encode(), capture_output=True, cwd=folder)
    assert done.returncode in (0, 1), (done.returncode, done.stderr[-500:])
    return comparable([(d.get("line") or 1, SEVERITIES[d["severity"]], d["name"], d["message"])
                       for d in json.loads(done.stdout)["diagnostics"]], folder)


def of_server(folder, diagnostics):
    # The first line is the message, what follows the remedy.
    return comparable([(d["range"]["start"]["line"] + 1, d["severity"], d["code"], d["message"].split("\n")[0])
                       for d in diagnostics], folder)


def random_edit(r, text):
    """A piece of the text in place of which another stands: its lines and characters, and that other."""
    begin = r.randrange(len(text) + 1)
    end = min(len(text), begin + r.choice((0, 0, 1, 1, 2, 5, 20, 80)))
    return begin, end, r.choice(PIECES) if r.random() < .6 else ""


def place(text, at):
    # Lines end at \n, \r\n and \r.
    before = text[:at]
    line = len(re.findall(r"\r\n|\r(?!\n)|\n", before))
    if before.endswith("\r") and text[at:at + 1] == "\n":
        line -= 1
        before = before[:-1]
    start = max(before.rfind("\n"), before.rfind("\r")) + 1
    return line, len(before[start:].encode("utf-16-le")) // 2


def fuzz(client, r, path, edits):
    folder = os.path.realpath(os.path.dirname(path))
    with open(path, encoding="utf-8", errors="replace", newline="") as f:
        text = original = f.read()
    uri = client.open(path, text)
    for i in range(edits):
        if r.random() < .15:
            text = original
            client.edit(uri, (text,))
        begin, end, by = random_edit(r, text)
        # Not between \r and \n, where no position is.
        if text[begin - 1:begin + 1] == "\r\n" or text[end - 1:end + 1] == "\r\n":
            continue
        change = (by, place(text, begin), place(text, end))
        text = text[:begin] + by + text[end:]
        client.edit(uri, change)
        if i % 4 == 0:
            at = place(text, min(len(text), begin + len(by)))
            client.ask("textDocument/" + r.choice(ASKED), {"textDocument": {"uri": uri}, "position": position(at)})
            client.ask("textDocument/" + r.choice(ASKED_OF_ALL), {"textDocument": {"uri": uri}})
    client.save(uri)
    expected = checked(folder, text)
    try:
        client.wait_diagnostics(uri, lambda diagnostics: of_server(folder, diagnostics) == expected, 30)
    except AssertionError:
        found = of_server(folder, client.diagnostics.get(uri, (0, 0, []))[2])
        with open(os.path.join(os.environ.get("WHIT_BINARY_DIR", "."), "lsp_fuzz_failure.pbrt"), "w", newline="") as f:
            f.write(text)
        raise AssertionError("%s: check alone says %s; the server alone %s" % (path, expected - found, found - expected))
    client.close(uri)


def scenes(pattern):
    """Whole scenes alone: a piece of one is judged as part of that. Not what includes itself, which the text on standard
    input does not do."""
    found = glob.glob(os.path.join(SOURCE, pattern), recursive=True)
    found = [f for f in found if os.path.getsize(f) < LARGEST]
    texts = {f: open(f, "rb").read() for f in found}
    return sorted(f for f, text in texts.items() if b"WorldEnd" in text and os.path.basename(f).encode() not in text)


def main():
    ours, others = scenes("scenes/**/*.pbrt"), scenes("tests/conformance/**/*.pbrt")
    # With sanitizers everything takes longer, and a part of it shows as much.
    share = 10 if os.environ.get("WHIT_SANITIZE") else 1
    r = random.Random(12)
    client = Client(root=SOURCE)
    for path in ours[::share]:
        fuzz(client, r, path, EDITS // len(ours) + 1)
    for path in others[::share]:
        fuzz(client, r, path, EDITS_EACH_ELSEWHERE)
    assert client.end() == 0
    with client.changed:
        internal = [a for a in client.answers.values() if "error" in a and a["error"]["code"] in (-32603, -32602)]
    assert not internal, internal[:3]


if __name__ == "__main__":
    main()
