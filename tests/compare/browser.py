"""Drives Debian's Chromium without a window, through the DevTools protocol over two pipes: JSON texts, each ended by NUL.

    with Browser() as browser:
        browser.open("/tmp/page.html", 1200, 800)
        browser.run("document.title")

Also a program that takes pictures of pages:  browser.py PAGE.html OUT.png [WIDTH HEIGHT [light|dark [SCRIPT...]]]
"""
import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time


def chromium():
    """The program, or None where it is not installed."""
    return shutil.which("chromium") or shutil.which("chromium-browser")


def raised(fd):
    """The same file under a number from 10."""
    other = fcntl.fcntl(fd, fcntl.F_DUPFD, 10)
    os.close(fd)
    return other


class Browser:
    def __init__(self):
        self.number, self.rest, self.session, self.said = 0, b"", None, []
        self.folder = tempfile.TemporaryDirectory()
        # The browser reads commands from its file 3 and writes answers to its file 4.
        theirs_in, self.commands = os.pipe()
        self.answers, theirs_out = os.pipe()
        # Neither of its ends may be 3 or 4 already, where one would be put over the other.
        theirs_in, theirs_out = raised(theirs_in), raised(theirs_out)
        self.process = subprocess.Popen(
            ["bash", "-c", 'exec 3<&%d 4>&%d; exec "$@"' % (theirs_in, theirs_out), "_", chromium(), "--headless=new",
             "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe", "--no-first-run",
             "--force-color-profile=srgb", "--user-data-dir=" + os.path.join(self.folder.name, "profile"), "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            pass_fds=(theirs_in, theirs_out))
        os.close(theirs_in)
        os.close(theirs_out)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.commands)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.answers)
        self.folder.cleanup()

    def call(self, method, **parameters):
        """Sends a command and returns its result."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive(60)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError("%s: %s" % (method, answer["error"]["message"]))
                return answer["result"]

    def receive(self, seconds):
        """The next message; what the page complains of is kept in `said`, the addresses that it asks for too."""
        until = time.monotonic() + seconds
        while b"\0" not in self.rest:
            ready, _, _ = select.select([self.answers], [], [], max(0, until - time.monotonic()))
            if not ready:
                raise TimeoutError("the browser says nothing")
            piece = os.read(self.answers, 1 << 20)
            if not piece:
                raise RuntimeError("the browser has ended")
            self.rest += piece
        text, self.rest = self.rest.split(b"\0", 1)
        message = json.loads(text)
        self.listen(message.get("method"), message.get("params"))
        return message

    def listen(self, method, parameters):
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.said.append("exception: %s" % details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled":
            self.said.append("console: %s" % [a.get("value", a.get("description")) for a in parameters["args"]])
        elif method == "Log.entryAdded":
            self.said.append("log: " + parameters["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            url = parameters["request"]["url"]
            if not url.startswith(("file:", "data:", "blob:", "about:")):
                self.said.append("asks the network for " + url)

    def open(self, page, width, height, scheme="light", ratio=1, touch=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio, mobile=touch)
        self.call("Emulation.setTouchEmulationEnabled", enabled=touch)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=page if ":" in page else "file://" + os.path.abspath(page))
        self.wait_for("document.readyState === 'complete' && location.href !== 'about:blank'")

    def run(self, script):
        """What a script comes to; of a promise what it is resolved with."""
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError("%s: %s" % (script, result["exceptionDetails"].get("exception", {}).get("description")))
        return result["result"].get("value")

    def wait_for(self, condition, seconds=20):
        until = time.monotonic() + seconds
        while not self.run(condition):
            if time.monotonic() > until:
                raise TimeoutError("never: " + condition)
            time.sleep(0.02)

    def settle(self):
        """Waits until what was asked for is drawn."""
        self.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(0))))")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def move(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.settle()

    def click(self, x, y, count=1):
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=count)
        self.mouse("mouseReleased", x, y, button="left", clickCount=count)
        self.settle()

    def drag(self, x0, y0, x1, y1):
        self.mouse("mouseMoved", x0, y0)
        self.mouse("mousePressed", x0, y0, button="left", buttons=1, clickCount=1)
        for t in (0.3, 0.7, 1):
            self.mouse("mouseMoved", x0 + t * (x1 - x0), y0 + t * (y1 - y0), button="left", buttons=1)
        self.mouse("mouseReleased", x1, y1, button="left", clickCount=1)
        self.settle()

    def wheel(self, x, y, by):
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=by)
        self.settle()

    def key(self, key):
        # Named keys have codes and no text; letters have text.
        codes = {"Escape": 27, "ArrowLeft": 37, "ArrowRight": 39}
        text = {} if key in codes else {"text": key}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, windowsVirtualKeyCode=codes.get(key, 0), **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, windowsVirtualKeyCode=codes.get(key, 0))
        self.settle()

    def touch(self, kind, *points):
        self.call("Input.dispatchTouchEvent", type=kind,
                  touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])
        self.settle()

    def picture(self, path, whole=False):
        """Writes what is on the screen, or the whole page, as a PNG."""
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        with open(path, "wb") as f:
            f.write(base64.b64decode(data))


def main():
    page, out = sys.argv[1:3]
    width, height = [int(v) for v in sys.argv[3:5]] or (1440, 900)
    scheme, scripts = (sys.argv[5:6] or ["light"])[0], sys.argv[6:]
    with Browser() as browser:
        browser.open(page, width, height, scheme)
        time.sleep(0.5)
        for script in scripts:
            browser.run(script)
            time.sleep(0.4)
        browser.picture(out)
        for line in browser.said:
            print(line)


if __name__ == "__main__":
    main()
