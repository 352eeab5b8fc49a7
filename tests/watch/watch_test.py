#!/usr/bin/env python3
"""The page of `whit watch` in Chromium: the picture changes when the scene is saved, errors appear and go, what is under the
cursor is right, sliders and checkboxes work, the camera flies and is written back; without a message in its console."""
import itertools
import os
import re
import subprocess
import sys

import numpy
import OpenImageIO as oiio

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "compare")]
from browser import Browser, chromium  # noqa: E402
from watcher import BODY, SCENE, WHIT, Watcher, write  # noqa: E402

PROBLEMS = []
NUMBERS = itertools.count()


def expect(what, value, expected):
    if value != expected:
        PROBLEMS.append("%s: %s, expected %s" % (what, value, expected))


class Page:
    def __init__(self, browser, watcher):
        self.browser, self.watcher, self.run = browser, watcher, browser.run

    def finished(self, reading=0):
        """Waits until the finished picture of that reading, or a later one, is shown."""
        self.browser.wait_for("""state && state.phase === "done" && !state.stale && state.reading >= %d && shown &&
            shown.info.done && shown.info.reading === state.reading && shown.info.number === state.picture.number && !fetching"""
                              % reading, 60)
        self.browser.settle()

    def bytes(self):
        """The colours on the screen's picture, height x width x 3."""
        data = self.run("[...shownNow().bytes]")
        width, height = self.run("[shownNow().width, shownNow().height]")
        return numpy.array(data).reshape(height, width, 4)[..., :3]

    def place(self, x, y):
        """Where the middle of a pixel is in the window."""
        return self.run("(() => { const b = stage.getBoundingClientRect(), p = toScreen(%f, %f); return [b.x + p[0], b.y + p[1]]; })()"
                        % (x + 0.5, y + 0.5))

    def reading(self):
        return self.run("state.reading")


def rendered(watcher):
    """The bytes that `whit render` shows."""
    # Another file each time: of one that has changed within a second, OpenImageIO may show what it was.
    out = watcher.path("rendered%d.png" % next(NUMBERS))
    subprocess.run([WHIT, "render", watcher.path("scene.pbrt"), "--quiet", "--outfile", out], check=True)
    return oiio.ImageBuf(out).get_pixels(oiio.UINT8)[..., :3].astype(int)


def expect_bytes(what, page):
    # Half floats have 11 bits: near white their rounding is less than half a byte, which can be one step of it.
    worst = int(numpy.abs(page.bytes() - rendered(page.watcher)).max())
    if worst > 1:
        PROBLEMS.append("%s: bytes differ by %d" % (what, worst))


def check_edit(page):
    page.finished()
    expect_bytes("the picture", page)
    before, reading = page.bytes(), page.reading()
    write(page.watcher.path("body.pbrt"), BODY.replace("0.5 0.25", "0.1 0.75"))
    page.finished(reading + 1)
    expect("the picture changes", bool((before != page.bytes()).any()), True)
    expect_bytes("the changed picture", page)


def check_error(page):
    before, reading = page.bytes(), page.reading()
    expect("no error", page.run("$('trouble').hidden"), True)
    write(page.watcher.path("body.pbrt"), BODY.replace("Shape", "Shpae"))
    page.browser.wait_for("!$('trouble').hidden")
    text = page.run("$('trouble').innerText")
    for part in ("body.pbrt:2", "Shpae", "Shape", "1 error"):
        expect("the error says " + part, part in text, True)
    expect("over the last good picture", bool((before == page.bytes()).all()), True)
    expect("which is dimmed", page.run("getComputedStyle(screen).filter !== 'none'"), True)
    page.run("window.copied = []; copy = (text) => { copied.push(text); }; 0")
    page.run("$('trouble').querySelector('.place').click(); 0")
    expect("its place is copied", page.run("copied.at(-1)"), page.watcher.path("body.pbrt") + ":2")
    # What is rendered past lies there too, until it is closed; the picture is as it should be.
    write(page.watcher.path("body.pbrt"), BODY.replace("radius", "raduis"))
    page.browser.wait_for("$('trouble').innerText.includes('raduis')")
    page.browser.wait_for("!state.stale && getComputedStyle(screen).filter === 'none'")
    page.run("$('trouble').querySelector('.close').click(); 0")
    expect("closed", page.run("$('trouble').hidden"), True)
    # Text of a scene is no markup.
    write(page.watcher.path("body.pbrt"), 'Shpae "<img src=x onerror=alert(1)>"\n')
    page.browser.wait_for("$('trouble').innerText.includes('onerror')")
    expect("no element of the scene's", page.run("document.querySelectorAll('#trouble img').length"), 0)
    write(page.watcher.path("body.pbrt"), BODY)
    page.finished(reading + 1)
    expect("the error goes", page.run("$('trouble').hidden"), True)


def check_cursor(page):
    page.browser.move(*page.place(32, 24))
    page.browser.wait_for("spot && spot.hit && spot.x === 32 && spot.y === 24")
    page.browser.settle()
    expect("place", page.run("$('where').textContent"), "x 32, y 24")
    text = page.run("$('spot').innerText")
    for part in ("sphere", "body.pbrt:2", "matte", "body.pbrt:1"):
        expect("under the cursor: " + part, part in text, True)
    shown = [float(v) for v in page.run("[...$('values').rows].slice(0, 3).map((r) => r.cells[1].textContent)")]
    pixel = page.watcher.pixels()[24, 32]
    expect("values", bool(numpy.allclose(shown, pixel, rtol=1e-4)), True)
    page.browser.click(*page.place(32, 24))
    page.browser.wait_for("copied.at(-1).endsWith('body.pbrt:2')")
    page.run("window.opened = ''; openAddress = (address) => { opened = address; }; $('click-opens').click(); 0")
    page.browser.click(*page.place(32, 24))
    page.browser.wait_for("opened !== ''")
    expect("in the editor", page.run("opened"), "vscode://file" + page.watcher.path("body.pbrt") + ":2:1")
    page.run("$('click-opens').click(); 0")
    page.browser.move(*page.place(1, 1))
    page.browser.wait_for("spot && !spot.hit")


def check_view(page):
    plain = page.bytes()
    page.run("$('exposure').value = 1; $('exposure').oninput(); 0")
    page.browser.wait_for("shown.toned === tonedBy() && !fetching")
    light = numpy.clip(page.watcher.pixels() * 2, 0, 1)
    curve = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    expect("exposure", bool(numpy.abs(page.bytes() - curve * 255).max() < 0.51), True)
    page.run("$('exposure').value = 0; $('exposure').oninput(); $('view').value = 'ACES SDR'; $('view').onchange(); 0")
    page.browser.wait_for("shown.toned === tonedBy() && !fetching")
    expect("another view", bool((page.bytes() != plain).any()), True)
    page.run("$('view').value = ''; $('view').onchange(); 0")
    page.browser.key("c")
    page.browser.wait_for("shown.toned === tonedBy() && !fetching")
    expect("a legend", page.run("$('scale').hidden"), False)
    # Luminance 1 is in the middle of the map: (log2 1 + 8) / 16, number 128 of its colours.
    sky = page.bytes()[1, 1].tolist()
    expect("false colour", sky, page.run("[...MAPS.magma.subarray(3 * 128, 3 * 128 + 3)]"))
    page.browser.key("p")
    page.browser.wait_for("shown.toned === tonedBy() && !fetching")
    expect("the picture again", bool((page.bytes() == plain).all()), True)


def check_effects(page):
    before = page.bytes()
    page.run("document.querySelector('[data-effect=environment-lights]').click(); 0")
    page.browser.wait_for("state.effects.some((e) => e.off) && state.phase === 'done'")
    page.finished()
    expect("without light", int(page.bytes().max()), 0)
    page.run("document.querySelector('[data-effect=environment-lights]').click(); 0")
    page.browser.wait_for("!state.effects.some((e) => e.off) && state.phase === 'done'")
    page.finished()
    expect("with it", bool((page.bytes() == before).all()), True)
    page.browser.wait_for("state.effects.every((e) => e.cost !== null)", 60)
    page.browser.settle()
    texts = page.run("[...document.querySelectorAll('.effect .cost')].map((e) => e.textContent)")
    expect("costs", all("%" in text for text in texts), True)


def check_camera(page):
    expect("nothing to write", page.run("$('write-camera').disabled"), True)
    expect("the file's", page.run("$('look-at').textContent").startswith("LookAt 0 0 -5"), True)
    page.browser.key("f")
    page.browser.wait_for("S.flying")
    before = page.bytes()
    x, y = page.place(32, 24)
    page.browser.drag(x, y, x + 40, y)
    page.browser.wait_for("state.camera.moved && state.phase === 'done' && state.picture.done && shown.info.number === state.picture.number")
    # To the right: +x, as the camera looks along +z with y up and x to the right.
    direction = page.run("state.camera.direction")
    expect("looks to the right", direction[0] > 0.05 and abs(direction[1]) < 1e-6, True)
    expect("another picture", bool((page.bytes() != before).any()), True)
    page.browser.drag(x, y, x, y + 20)
    page.browser.wait_for("state.camera.direction[1] < -0.02")
    page.browser.call("Input.dispatchKeyEvent", type="keyDown", key="w", text="w")
    page.browser.wait_for("state.camera.eye[2] > -4.9")
    page.browser.call("Input.dispatchKeyEvent", type="keyUp", key="w")
    page.browser.key("Escape")
    page.browser.wait_for("!S.flying && !sending && state.phase === 'done'")
    expect("can be written", page.run("$('write-camera').disabled"), False)
    camera = page.run("state.camera")
    page.run("$('copy-camera').click(); 0")
    expect("copied", page.run("copied.at(-1)"), camera["text"])
    reading = page.reading()
    page.run("$('write-camera').click(); 0")
    page.finished(reading + 1)
    with open(page.watcher.path("scene.pbrt"), encoding="utf-8") as f:
        text = f.read()
    expect("in the file", text.startswith(camera["text"] + "\nCamera"), True)
    numbers = [float(v) for v in camera["text"].split()[1:]]
    expect("to a millionth", bool(numpy.allclose(numbers[:3], camera["eye"], atol=1e-6)), True)
    expect_bytes("what was written", page)


def check_reference(page):
    out = page.watcher.path("reference.exr")
    subprocess.run([WHIT, "render", page.watcher.path("scene.pbrt"), "--quiet", "--display", "none", "--outfile", out], check=True)
    with open(out, "rb") as f:
        data = f.read()
    answer = page.watcher.request("POST", "/%s/reference?name=reference.exr" % page.watcher.token, data,
                                  Content_Type="application/octet-stream")
    expect("reference", [answer[0], answer[2]], [200, b'{"problem":""}'])
    page.browser.wait_for("reference && reference.toned")
    picture = page.bytes()
    page.browser.key("b")
    page.browser.wait_for("S.blink")
    expect("blink", int(numpy.abs(page.bytes() - picture).max()) <= 1, True)
    page.browser.key("b")
    report = page.watcher.get("report")
    expect("report", [report[0], b"reference.exr" in report[2]], [200, True])
    expect("on its own", "sandbox" in report[1]["Content-Security-Policy"], True)


def main():
    if not chromium():
        sys.exit(77)
    with Watcher() as watcher, Browser() as browser:
        # What it asks of its own server is no complaint.
        page = Page(browser, watcher)
        browser.open(watcher.address, 1280, 800)
        for check in (check_edit, check_error, check_cursor, check_view, check_effects, check_camera, check_reference):
            check(page)
        asked = "asks the network for " + watcher.address
        for line in browser.said:
            # The browser says when an answer is not 200, as for pictures that are not kept any more.
            if not line.startswith(asked) and not re.search("status of 404", line):
                PROBLEMS.append(line)
        expect("ends", watcher.end(), 0)
        browser.wait_for("$('lamp').className === 'gone'")
    for line in PROBLEMS:
        print(line)
    sys.exit(1 if PROBLEMS else 0)


if __name__ == "__main__":
    main()
