"""Starts `whit watch` on a scene and asks its server, as its page does."""
import http.client
import json
import os
import select
import signal
import subprocess
import tempfile
import time

WHIT = os.environ.get("WHIT", "build/release/whit")

SCENE = """LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "image" "integer xresolution" 64 "integer yresolution" 48
Sampler "sobol" "integer pixelsamples" 4
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Include "body.pbrt"
WorldEnd
"""
BODY = """Material "matte" "rgb Kd" [0.5 0.25 0.125]
Shape "sphere" "float radius" 1
"""


def write(path, text):
    """As editors do: a new file in the place of the old one."""
    with open(path + ".new", "w", encoding="utf-8") as f:
        f.write(text)
    os.replace(path + ".new", path)


class Watcher:
    """`whit watch` on scene.pbrt in a folder of its own, which has body.pbrt too."""

    def __init__(self, *flags, scene=SCENE, body=BODY, folder=None):
        self.own = None if folder else tempfile.TemporaryDirectory()
        self.folder = folder or self.own.name
        if not folder:
            write(self.path("scene.pbrt"), scene)
            write(self.path("body.pbrt"), body)
        self.process = subprocess.Popen([WHIT, "watch", self.path("scene.pbrt"), *flags], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        ready, _, _ = select.select([self.process.stdout], [], [], 60)
        self.address = self.process.stdout.readline().strip() if ready else ""
        if not self.address:
            self.process.kill()
            raise RuntimeError("no address: " + self.process.stderr.read())
        self.host = self.address.split("/")[2]
        self.port = int(self.host.split(":")[1])
        self.token = self.address.split("/")[3]

    def path(self, name):
        return os.path.join(self.folder, name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.end()
        self.process.stdout.close()
        self.process.stderr.close()
        if self.own:
            self.own.cleanup()

    def end(self, number=signal.SIGTERM):
        """Returns the exit code."""
        self.process.send_signal(number)
        try:
            return self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()

    def request(self, method, path, body=None, **headers):
        """Status, headers and body. A header that is None is not sent, '_' stands for '-'."""
        sent = {"Host": self.host}
        if method == "POST":
            sent.update({"Origin": "http://" + self.host, "Content-Type": "application/json"})
        sent.update({name.replace("_", "-"): value for name, value in headers.items()})
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        if body is not None and "Content-Length" not in sent:
            connection.putheader("Content-Length", str(len(body)))
        for name, value in sent.items():
            if value is not None:
                connection.putheader(name, value)
        try:
            connection.endheaders(body)
        except (BrokenPipeError, ConnectionResetError):
            pass  # A body that is too long is not read.
        answer = connection.getresponse()
        data = answer.read() if answer.getheader("Content-Type") != "text/event-stream" else b""
        connection.close()
        return answer.status, dict(answer.getheaders()), data

    def get(self, what, **headers):
        return self.request("GET", "/%s/%s" % (self.token, what), **headers)

    def post(self, what, value):
        status, _, data = self.request("POST", "/%s/%s" % (self.token, what), json.dumps(value).encode())
        assert status == 200, (what, status, data)
        return json.loads(data)

    def state(self):
        return json.loads(self.get("state")[2])

    def wait_for(self, what, seconds=60):
        """The first state of which it is true."""
        until = time.monotonic() + seconds
        while True:
            state = self.state()
            if what(state):
                return state
            if time.monotonic() > until:
                raise TimeoutError(json.dumps(state, indent=1))
            time.sleep(0.02)

    def done(self, reading=0):
        """The state when a picture of that reading, or a later one, is finished."""
        return self.wait_for(lambda s: s["phase"] == "done" and s["reading"] >= reading and not s["stale"] and
                             s["picture"] and s["picture"]["done"] and s["picture"]["reading"] == s["reading"])

    def pixels(self, state=None):
        """Linear numbers of the newest picture, height x width x 3."""
        import numpy
        picture = (state or self.done())["picture"]
        status, _, data = self.get("picture/%d" % picture["number"])
        assert status == 200, status
        return numpy.frombuffer(data, dtype="<f2").astype(float).reshape(picture["height"], picture["width"], 3)
