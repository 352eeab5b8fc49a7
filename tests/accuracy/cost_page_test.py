#!/usr/bin/env python3
"""The report's page is well-formed, and Chromium, where it is installed, opens it without a message in its console."""
import html.parser
import os
import shutil
import subprocess
import sys
import tempfile

VOID = {"meta", "link", "img", "br"}


class Nesting(html.parser.HTMLParser):
    """Every element is closed by its own end tag, and every address is the page's own."""

    def __init__(self):
        super().__init__()
        self.open, self.problems = [], []

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("src", "href") and not value.startswith("data:"):
                self.problems.append("%s refers to %s" % (tag, value))
        if tag == "script":
            self.problems.append("a script")
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.problems.append("</%s> at line %d closes nothing" % (tag, self.getpos()[0]))


def check_nesting(page):
    nesting = Nesting()
    with open(page, encoding="utf-8") as f:  # Bytes of a scene that are no text would end it here.
        nesting.feed(f.read())
    nesting.close()
    return nesting.problems + ["<%s> stays open" % tag for tag in nesting.open]


def check_console(chromium, page, folder):
    run = subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--v=0",
                          "--user-data-dir=" + os.path.join(folder, "profile"), "--dump-dom", "file://" + page],
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, check=False)
    said = [line for line in run.stderr.decode(errors="replace").splitlines() if "CONSOLE" in line]
    if run.returncode or b"What accuracy costs in time" not in run.stdout:
        said.append("it shows nothing: exit code %d" % run.returncode)
    return said


def main():
    program = os.path.join(os.environ["WHIT_BINARY_DIR"], "tests", "test_accuracy")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "--gtest_filter=CostHtml.WritesPages"], env={**os.environ, "WHIT_COST_PAGES": folder},
                       stdout=subprocess.DEVNULL, check=True)
        pages = sorted(os.path.join(folder, name) for name in os.listdir(folder) if name.endswith(".html"))
        problems = [] if pages else ["no page was written"]
        for page in pages:
            found = check_nesting(page) + (check_console(chromium, page, folder) if chromium else [])
            problems += ["%s: %s" % (os.path.basename(page), problem) for problem in found]
    for problem in problems:
        print(problem)
    if problems:
        sys.exit(1)
    if not chromium:
        print("Chromium is not installed: pages are well-formed, their console was not looked at")
        sys.exit(77)


if __name__ == "__main__":
    main()
