#!/usr/bin/env python3
"""The page of compared pictures does in Chromium what it promises: every way of looking, zoom down to single pixels and
the values under the cursor, exposure, places, layers; without a network and without a message in its console."""
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, chromium  # noqa: E402

PROBLEMS = []


def expect(what, value, expected):
    if value != expected:
        PROBLEMS.append("%s: %s, expected %s" % (what, value, expected))


def expect_near(what, value, expected, tolerance):
    pairs = list(zip(value, expected)) if isinstance(value, list) else [(value, expected)]
    if not all(abs(a - b) <= tolerance for a, b in pairs):
        PROBLEMS.append("%s: %s, expected %s" % (what, value, expected))


def srgb(v):
    """The byte that an sRGB display shows light as: IEC 61966-2-1."""
    v = min(max(v, 0), 1)
    return int(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055) + 0.5)


# The pictures that report_page_test.cpp writes: R is 0.01 x, G 0.01 y, B 0.25, and in A the patch from (40, 20) to
# (55, 31) has 0.1 more in R, (7, 5) 0.5 more in each. (45, 25) is in the patch.
A_45_25, B_45_25 = [0.55, 0.25, 0.25], [0.45, 0.25, 0.25]
BERLIN_LEAST, BERLIN_MIDDLE, BERLIN_MOST = [158, 176, 255], [25, 12, 9], [255, 173, 173]
MAGMA_LEAST, MAGMA_MOST = [0, 0, 4], [252, 253, 191]


class Page:
    """What is asked of a page in a browser."""

    def __init__(self, browser):
        self.browser, self.run = browser, browser.run

    def open(self, path, width, height, **more):
        self.browser.open(path, width, height, **more)
        self.run("S.boxes = false; 0")  # Outlines would be in the way of colours.

    def ready(self):
        self.browser.wait_for("layer !== null")
        self.browser.settle()

    def place(self, x, y, pane=0):
        """Where the middle of a pixel is in the window, by what zoom and centre mean."""
        s = self.run("({x: S.x, y: S.y, zoom: S.zoom, pane: panes()[%d], box: stage.getBoundingClientRect().toJSON()})" % pane)
        p, box = s["pane"], s["box"]
        return (box["x"] + p["x"] + p["w"] / 2 + (x + 0.5 - s["x"]) * s["zoom"],
                box["y"] + p["y"] + p["h"] / 2 + (y + 0.5 - s["y"]) * s["zoom"])

    def colour(self, x, y, pane=0):
        """On the screen, in the middle of a pixel."""
        self.browser.settle()
        px, py = self.place(x, y, pane)
        # Through a canvas of the test's own: the browser complains of canvases that are read often.
        return self.run("""(() => {
            const box = stage.getBoundingClientRect(), r = devicePixelRatio;
            window.probe ||= new OffscreenCanvas(1, 1).getContext("2d", {willReadFrequently: true});
            probe.clearRect(0, 0, 1, 1);
            probe.drawImage(screen, Math.floor((%f - box.x) * r), Math.floor((%f - box.y) * r), 1, 1, 0, 0, 1, 1);
            return [...probe.getImageData(0, 0, 1, 1).data].slice(0, 3); })()""" % (px, py))

    def values(self):
        """The table under the cursor, as texts."""
        return self.run("[...$('values').rows].slice(1).map((line) => [...line.cells].map((cell) => cell.textContent))")


def check_swipe(page):
    browser = page.browser
    expect("mode at first", page.run("S.mode"), "swipe")
    middle = page.run("stage.getBoundingClientRect().x + S.divider * stage.clientWidth")
    y = page.run("stage.getBoundingClientRect().y + stage.clientHeight / 2")
    left, right = page.place(0, 0)[0], page.place(95, 0)[0]
    browser.drag(middle, y, right, y)  # Nearly all is A ...
    expect_near("swiped to A", page.colour(45, 25), [srgb(v) for v in A_45_25], 1)
    browser.drag(right, y, left, y)  # ... and B.
    expect_near("swiped to B", page.colour(45, 25), [srgb(v) for v in B_45_25], 1)
    expect("swiping moves nothing", page.run("S.fitted"), True)
    browser.drag(left, y, middle, y)


def check_side_by_side(page):
    page.browser.key("s")
    for pane, expected in ((0, A_45_25), (1, B_45_25)):
        expect_near("pane %d" % pane, page.colour(45, 25, pane), [srgb(v) for v in expected], 1)
    # The cursor over one pane reads both pictures, and so over the other.
    for pane in (0, 1):
        page.browser.move(*page.place(45, 25, pane))
        expect("values in pane %d" % pane, page.values()[0], ["R", "0.55", "0.45", "0.1"])


def check_blink(page):
    page.browser.key("b")
    seen, until = set(), time.monotonic() + 4
    while len(seen) < 2 and time.monotonic() < until:
        seen.add(tuple(page.colour(45, 25)))
    expected = [[srgb(v) for v in colour] for colour in (A_45_25, B_45_25)]
    expect("pictures that take turns", len(seen), 2)
    for found, wanted in zip(sorted(map(list, seen)), sorted(expected)):
        expect_near("blinks between", found, wanted, 1)
    page.browser.key(" ")
    before = page.run("S.blinkB")
    time.sleep(0.7)  # More than a turn at two a second.
    expect("held", page.run("S.blinkB"), before)
    page.browser.key(" ")
    expect("flipped by hand", page.run("S.blinkB"), not before)
    page.browser.key(".")
    expect("twice as fast", page.run("S.rate"), 4)


def check_zoom(page):
    """The wheel zooms about the cursor: the same pixel stays under it, down to its numbers."""
    page.browser.key("a")
    at = page.place(45, 25)
    for _ in range(30):
        page.browser.wheel(*at, -120)
        if page.run("S.zoom") >= 64:
            break
    expect("zoom", 64 <= page.run("S.zoom") <= 256, True)
    page.browser.move(*at)
    expect("cursor", page.run("S.cursor"), [45, 25])
    expect("where", page.run("$('where').textContent"), "x 45, y 25")
    expect("values", page.values()[:3],
           [["R", "0.55", "0.45", "0.1"], ["G", "0.25", "0.25", "0"], ["B", "0.25", "0.25", "0"]])
    expect("numbers in the pixel", page.run("numbersIn('a', 25 * 96 + 45)"), ["0.55", "0.25", "0.25"])
    # The pixel beside, one screen pixel across the border: 0.56.
    page.browser.move(at[0] + page.run("S.zoom"), at[1])
    expect("the pixel beside", page.values()[0][1], "0.56")
    before = page.run("S.x")
    page.browser.drag(at[0], at[1], at[0] - 80, at[1])
    expect_near("dragged", page.run("S.x") - before, 80 / page.run("S.zoom"), 1e-6)
    page.browser.key("1")
    expect("one to one", page.run("S.zoom"), 1)
    page.browser.key("0")
    expect("fitted", page.run("[S.x, S.y, S.fitted]"), [48, 32, True])


def check_exposure(page):
    for key, stops in (("+", 1), ("-", 0), ("-", -1)):
        page.browser.key(key)
        page.browser.key(key)
        expect("exposure", page.run("S.exposure"), stops)
        expect_near("exposed by %d" % stops, page.colour(45, 25), [srgb(v * 2 ** stops) for v in A_45_25], 1)
    page.browser.key("e")
    page.browser.key("c")  # 0.55, 0.25, 0.25: luminance 0.2126 * 0.55 + 0.7874 * 0.25 = 0.314, -1.67 stops: (8 - 1.67) / 16.
    expect("false colour", page.colour(45, 25), page.run("[...MAPS.magma.subarray(3 * 101, 3 * 102)]"))
    page.browser.key("c")


def check_difference(page):
    """The mean over channels is 0.1 / 3 in the patch, which is also what all but one in a thousand are within: 192 pixels
    of 6144 have it, one has more."""
    page.browser.key("d")
    expect_near("scale", page.run("differenceScale()"), 0.1 / 3, 1e-6)
    expect("ends of the bar", page.run("[$('scale-low').textContent, $('scale-high').textContent]"), ["−0.0333", "+0.0333"])
    expect("A is brighter", page.colour(45, 25), BERLIN_MOST)
    expect("no difference", page.colour(80, 50), BERLIN_MIDDLE)
    page.run("$('scale-slider').value = -1; $('scale-slider').dispatchEvent(new Event('input'))")
    # Twice the scale: 0.75 of the map, which is 191.25.
    expect("half of the scale", page.colour(45, 25), page.run("[...MAPS.berlin.subarray(3 * 191, 3 * 192)]"))
    page.run("$('scale-slider').value = 0; $('scale-slider').dispatchEvent(new Event('input'))")
    page.browser.key("d")
    expect("absolute", page.colour(45, 25), MAGMA_MOST)
    expect("absolute, no difference", page.colour(80, 50), MAGMA_LEAST)
    page.browser.key("d")


def check_small_things_from_afar(page):
    """One pixel of 6144 is still there when eight stand for one: pooled by the largest."""
    page.run("S.zoom = 0.125; S.x = 48; S.y = 32; S.fitted = false; redraw()")
    page.browser.settle()
    colours = page.run("(() => { const s = source('difference'); return [s.width, s.height, [...s.bytes.slice(0, 3)]]; })()")
    expect("from afar", colours, [12, 8, BERLIN_MOST])
    page.browser.key("0")


def check_flip(page):
    page.browser.key("f")
    byte = page.run("flipMap[5 * 96 + 7]")
    expect("FLIP sees the bright pixel", byte > 60, True)
    expect("FLIP's colour", page.colour(7, 5), page.run("[...MAPS.magma.subarray(3 * %d, 3 * %d)]" % (byte, byte + 1)))
    expect("FLIP far from it", page.colour(90, 60), MAGMA_LEAST)
    page.browser.move(*page.place(7, 5))
    expect("FLIP under the cursor", page.values()[-1], ["FLIP", "%.3f" % (byte / 255)])


def check_places(page):
    """A click goes to the place, and its layer, and frames it."""
    titles = page.run("[...$('regions').querySelectorAll('b')].map((b) => b.textContent)")
    expect("places", titles, ["+10.0 % in R", "block", "largest difference"])
    # The box of the noise is (40, 20) to (55, 31), that of the block eight wide, and the largest is one pixel.
    for i, centre in enumerate(([48, 26], [44, 28], [7.5, 5.5])):
        page.run("$('regions').querySelectorAll('button')[%d].click()" % i)
        page.browser.wait_for("Math.abs(S.x - %f) < 1e-9 && Math.abs(S.y - %f) < 1e-9" % tuple(centre))
        expect("chosen", page.run("S.region"), i)
    expect("zoom at a pixel", page.run("S.zoom") >= 32, True)
    page.browser.key("n")  # Around to the first again.
    page.browser.wait_for("S.x === 48 && S.y === 26")
    page.run("S.region = -1; 0")
    page.browser.key("0")


def check_layers(page):
    expect("layers", page.run("[...$('layer').options].map((o) => o.textContent)"), ["colour", "N", "shape"])
    page.browser.key("a")
    page.run("$('layer').value = 1; $('layer').dispatchEvent(new Event('change'))")
    page.browser.wait_for("layer.name === 'N'")
    # From [-1, 1] to bytes: -0.5 is 63.75, 0.5 is 191.25, 0.25 is 159.375.
    expect("normals", page.colour(60, 30), [64, 191, 159])
    page.browser.move(*page.place(60, 30))
    expect("their values", page.values()[:3],
           [["X", "-0.5", "-0.5", "0"], ["Y", "0.5", "0.5", "0"], ["Z", "0.25", "0.75", "-0.5"]])
    page.browser.key("l")
    page.browser.wait_for("layer.name === 'shape'")
    page.browser.move(*page.place(21, 30))
    expect("ids", page.values()[0], ["id", "4", "3", "differs"])
    expect("two ids, two colours", page.colour(10, 30) != page.colour(21, 30), True)
    page.browser.key("d")
    expect("ids that differ", [page.colour(21, 30), page.colour(60, 30)], [BERLIN_MOST, BERLIN_MIDDLE])
    page.browser.key("l")
    page.browser.wait_for("layer.name === ''")


def check_address(page, path):
    """What is looked at is in the address, and found again by it."""
    page.run("Object.assign(S, {x: 20, y: 10, zoom: 24, fitted: false}); chooseMode('flip')")
    page.browser.wait_for("location.hash.includes('zoom=24')")
    address = "file://" + path + page.run("location.hash")
    page.open(address, 1200, 800)
    page.ready()
    expect("found again", page.run("[S.mode, S.x, S.y, S.zoom]"), ["flip", 20, 10, 24])


def check_one(browser, folder):
    page = Page(browser)
    page.open(os.path.join(folder, "one.html"), 1200, 800)
    page.ready()
    expect("no table of one row", page.run("document.querySelectorAll('#pictures').length"), 0)
    for check in (check_swipe, check_side_by_side, check_blink, check_zoom, check_exposure, check_difference,
                  check_small_things_from_afar, check_flip, check_places, check_layers):
        check(page)
    check_address(page, os.path.join(folder, "one.html"))
    browser.key("?")
    expect("help", page.run("$('help').open"), True)
    browser.key("Escape")
    expect("help is closed", page.run("$('help').open"), False)


def check_touch(browser, folder):
    """Two fingers zoom, one moves; a narrow window has nothing beyond its edge."""
    page = Page(browser)
    page.open(os.path.join(folder, "one.html"), 390, 800, ratio=2, touch=True)
    page.ready()
    page.run("$('viewer').scrollIntoView(); chooseMode('a')")
    x, y = page.place(48, 32)
    before = page.run("S.zoom")
    browser.touch("touchStart", (x - 30, y), (x + 30, y))
    for apart in (45, 60, 90):
        browser.touch("touchMove", (x - apart, y), (x + apart, y))
    browser.touch("touchEnd")
    expect_near("pinched", page.run("S.zoom") / before, 3, 0.05)
    expect("values where it was touched", page.run("$('where').textContent") != "", True)
    expect_near("colours on a fine screen", page.colour(48, 32), [srgb(v) for v in (0.48, 0.32, 0.25)], 1)
    expect("nothing beyond the edge", page.run("document.documentElement.scrollWidth <= innerWidth"), True)


def check_display(page):
    """Numbers for a display are shown as they are; an exposure is one of the light they stand for. Their window begins at
    (100, 50)."""
    page.browser.move(*page.place(45, 25))
    expect("where in the display window", page.run("$('where').textContent"), "x 145, y 75")
    numbers = [0.45, 0.25, 0.25]
    expect_near("display values", page.colour(45, 25), [255 * v for v in numbers], 1)
    page.browser.key("+")
    page.browser.key("+")
    light = [((v + 0.055) / 1.055) ** 2.4 for v in numbers]
    expect_near("exposed display values", page.colour(45, 25), [srgb(2 * v) for v in light], 1)
    page.browser.key("e")


def check_folder(browser, folder):
    page = Page(browser)
    page.open(os.path.join(folder, "folder.html"), 1200, 800)
    names = page.run("[...document.querySelectorAll('.open')].map((b) => b.textContent)")
    expect("worst first", names, ["sized.exr", "</script><b>&\"'? .exr", "made.exr", "deep/down/same.exr"])
    expect("no viewer yet", page.run("$('viewer').hidden"), True)
    page.run("document.querySelectorAll('.count')[1].click()")
    expect("chosen rows", page.run("shownRows()"), [1, 2, 3])
    page.run("document.querySelectorAll('.count')[1].click()")
    box = page.run("document.querySelectorAll('.row')[1].getBoundingClientRect().toJSON()")
    browser.click(box["x"] + 200, box["y"] + 20)
    page.ready()
    expect("opened", page.run("$('name').textContent"), "</script><b>&\"'? .exr")
    page.browser.key("a")
    browser.move(*page.place(3, 4))
    expect("NaN under the cursor", page.values()[0], ["R", "NaN", "3000000", "NaN"])
    expect("NaN is marked", page.colour(3, 4), [0, 255, 64])
    browser.move(*page.place(5, 6))
    expect("infinity", page.values()[0], ["R", "0.5", "+inf", "-inf"])
    browser.key("ArrowLeft")
    browser.wait_for("S.row === 0")
    browser.settle()
    expect("no layer", page.run("layer"), None)
    expect("why not", page.run("$('message').textContent").endswith("A is 64 x 64, B 32 x 32 pixels"), True)
    browser.key("ArrowLeft")  # From the first to the last.
    browser.wait_for("S.row === 3 && layer !== null")
    check_display(page)
    browser.key("Escape")
    expect("closed", page.run("$('viewer').hidden"), True)


def main():
    if not chromium():
        print("Chromium is not installed")
        sys.exit(77)
    program = os.path.join(os.environ["WHIT_BINARY_DIR"], "tests", "test_compare")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "--gtest_filter=ReportPage.WritesPages"], env={**os.environ, "WHIT_DIFF_PAGES": folder},
                       stdout=subprocess.DEVNULL, check=True)
        with Browser() as browser:
            check_one(browser, folder)
            check_touch(browser, folder)
            check_folder(browser, folder)
            PROBLEMS.extend(browser.said)
    for problem in PROBLEMS:
        print(problem)
    sys.exit(1 if PROBLEMS else 0)


if __name__ == "__main__":
    main()
