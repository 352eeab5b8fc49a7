#!/usr/bin/env python3
"""The server of `whit watch` answers its own page and nobody else: other hosts, other pages, other methods, other paths
and long bodies are refused, two servers do not share a port, and a signal ends it."""
import json
import os
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from watcher import WHIT, Watcher  # noqa: E402

PROBLEMS = []


def expect(what, value, expected):
    if value not in (expected if isinstance(expected, tuple) else (expected,)):
        PROBLEMS.append("%s: %s, expected %s" % (what, value, expected))


def status(watcher, method, path, body=None, **headers):
    return watcher.request(method, path, body, **headers)[0]


def check_answers(watcher):
    code, headers, page = watcher.get("")
    expect("page", code, 200)
    for name, value in {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer",
                        "X-Frame-Options": "DENY"}.items():
        expect(name, headers.get(name), value)
    policy = headers.get("Content-Security-Policy", "")
    for part in ("default-src 'none'", "frame-ancestors 'none'", "base-uri 'none'", "script-src 'nonce-"):
        expect("policy has " + part, part in policy, True)
    expect("no script of others", "unsafe" in policy, False)
    expect("no CORS", [n for n in headers if n.lower().startswith("access-control")], [])
    nonce = policy.split("script-src 'nonce-")[1].split("'")[0]
    expect("nonce in the page", nonce.encode() in page, True)
    expect("another nonce each time", watcher.get("")[1]["Content-Security-Policy"] == policy, False)
    expect("token has 128 bits", len(watcher.token), 32)
    expect("by localhost", watcher.get("", Host="localhost:%d" % watcher.port)[0], 200)


def check_refusals(watcher):
    page = "/%s/" % watcher.token
    for host in ("example.com", "example.com:%d" % watcher.port, "127.0.0.1", "127.0.0.1:1", "localhost",
                 "127.0.0.1.example.com:%d" % watcher.port, "", None, "[::1]:%d" % watcher.port):
        expect("host %s" % host, status(watcher, "GET", page, Host=host), (400, 403))
        expect("state by host %s" % host, status(watcher, "GET", page + "state", Host=host), (400, 403))
    wrong = ("0" if watcher.token[0] != "0" else "1") + watcher.token[1:]
    for path in ("/", "/index.html", "/state", "//", "/%s" % watcher.token, "/%s/" % wrong, "/%s/state" % wrong,
                 "/%s/" % watcher.token[:-1], "/%s0/" % watcher.token, "/%s/" % watcher.token.upper().replace("0", "O"),
                 "/../" + watcher.token, "/favicon.ico"):
        expect("path " + path, status(watcher, "GET", path), (400, 403, 404))
    for trick in ("scene.pbrt", "../scene.pbrt", "../../../../etc/passwd", "..%2f..%2f..%2fetc%2fpasswd", "%2e%2e/etc/passwd",
                  "/etc/passwd", "file:///etc/passwd", "picture/../state", "picture/-1", "picture/1e0", "picture/99999999",
                  "picture/", "state/", "events/x", "picture/18446744073709551616", "report"):
        expect("trick " + trick, watcher.get(trick)[0], (400, 404))
    for method in ("HEAD", "OPTIONS", "PUT", "DELETE", "PATCH", "TRACE", "CONNECT"):
        expect(method, status(watcher, method, page), (400, 405))
    expect("GET from another page", status(watcher, "GET", page + "state", Origin="http://example.com"), 403)
    for where in ("at", "at?x=1", "at?x=nan&y=1", "at?x=1e9&y=1", "at?x=;&y=1", "picture/1?view=none"):
        expect(where, watcher.get(where)[0], (400, 404))


def check_posts(watcher):
    path = "/%s/camera" % watcher.token
    good = json.dumps({"reset": True}).encode()
    expect("its own page", status(watcher, "POST", path, good), 200)
    for origin in (None, "null", "http://example.com", "https://" + watcher.host, "http://127.0.0.1",
                   "http://localhost:%d" % watcher.port):
        expect("POST from %s" % origin, status(watcher, "POST", path, good, Origin=origin), 403)
    for kind in (None, "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"):
        expect("POST of %s" % kind, status(watcher, "POST", path, good, Content_Type=kind), (400, 413, 415))
    for body in (b"", b"[]", b"{", b'{"eye": [1, 2]}', b'{"eye": [1,2,3], "direction": [0,0,0], "up": [0,1,0]}',
                 b'{"eye": [1e20,2,3], "direction": [0,0,1], "up": [0,1,0]}',
                 b'{"eye": [1,2,3], "direction": [0,1,0], "up": [0,-2,0]}',
                 b'{"eye": [1,2,3], "direction": [0,1e300,0], "up": [0,0,1]}',
                 b'{"eye": [1e999,2,3], "direction": [0,0,1], "up": [0,1,0]}', b"\xff\xfe", b"[" * 5000):
        expect("camera %r" % body[:30], status(watcher, "POST", path, body), 400)
    for body in (b'{"off": ["nonsense"]}', b'{"off": 1}', b'{"off": [1]}', b"{}"):
        expect("effects %r" % body, status(watcher, "POST", "/%s/effects" % watcher.token, body), 400)
    expect("long body", status(watcher, "POST", path, b" " * 20000), 413)
    expect("said to be long", status(watcher, "POST", path, b"", Content_Length="99999999999"), 413)
    expect("no length", status(watcher, "POST", path, None), 411)
    expect("in pieces", status(watcher, "POST", path, None, Transfer_Encoding="chunked"), 411)
    expect("body of a GET", status(watcher, "GET", "/%s/state" % watcher.token, b"x" * 100), 413)
    expect("POST to a page", status(watcher, "POST", "/%s/state" % watcher.token, good), 404)
    expect("no picture", "problem" in json.loads(watcher.request("POST", "/%s/reference?name=x.png" % watcher.token, b"no picture",
                                                                 Content_Type="application/octet-stream")[2]), True)


def check_before_the_body(watcher):
    """Who may not ask is refused by the head of the request: nothing of a body is waited for, which is 1 MB here."""
    good = {"Host": watcher.host, "Origin": "http://" + watcher.host, "Content-Type": "application/octet-stream"}
    wrong = "/%s/reference" % ("0" * 32)
    own = "/%s/reference" % watcher.token
    for path, changed, code in ((own, {"Host": "example.com"}, 403), (own, {"Origin": "http://example.com"}, 403),
                                (wrong, {}, 404), (own, {"Content-Type": "text/plain"}, 415)):
        head = "POST %s HTTP/1.1\r\nContent-Length: 1000000\r\n" % path
        head += "".join("%s: %s\r\n" % header for header in {**good, **changed}.items())
        with socket.create_connection(("127.0.0.1", watcher.port), 30) as stream:
            start = time.monotonic()
            stream.sendall(head.encode() + b"\r\n")
            answer = stream.recv(100).decode()
            expect("before the body, %s %s" % (path, changed), answer.split(" ")[1:2], [str(code)])
            expect("at once", time.monotonic() - start < 1.5, True)


def check_half_sent(watcher):
    """300 requests that are not ended hold up nobody, and are given up."""
    streams = [socket.create_connection(("127.0.0.1", watcher.port), 30) for _ in range(300)]
    for stream in streams:
        stream.sendall(b"GET / HTTP/1.1\r\n")
    start = time.monotonic()
    expect("beside 300 half-sent requests", watcher.get("state")[0], 200)
    expect("without waiting for them", time.monotonic() - start < 2, True)
    for stream in streams:
        stream.settimeout(30)
        try:
            while stream.recv(1000):
                pass
        except ConnectionResetError:
            pass
        stream.close()
    expect("they are given up", time.monotonic() - start < 10, True)


def check_port(watcher):
    expect("another address", [a for a in socket.gethostbyname_ex(socket.gethostname())[2] if not a.startswith("127.") and
                               socket.socket().connect_ex((a, watcher.port)) == 0], [])
    again = subprocess.run([WHIT, "watch", watcher.path("scene.pbrt"), "--port", str(watcher.port)], capture_output=True,
                           text=True, timeout=60)
    expect("port in use", again.returncode, 4)
    expect("says so", "port %d of 127.0.0.1 is taken" % watcher.port in again.stderr, True)
    with Watcher(folder=watcher.folder) as other:
        expect("another token", other.token == watcher.token, False)
        expect("its token is of no use here", status(watcher, "GET", "/%s/" % other.token), 404)
        expect("two watchers", other.done()["phase"], "done")


def check_events(watcher):
    with socket.create_connection(("127.0.0.1", watcher.port), 30) as stream:
        stream.sendall(b"GET /%s/events HTTP/1.1\r\nHost: %s\r\n\r\n" % (watcher.token.encode(), watcher.host.encode()))
        data, until = b"", time.monotonic() + 30
        while b"\ndata: {" not in data and time.monotonic() < until:
            data += stream.recv(65536)
        expect("events", b"text/event-stream" in data and b"\ndata: {" in data, True)
        # A page that stays open does not hold it up.
        start = time.monotonic()
        expect("SIGTERM", watcher.end(signal.SIGTERM), 0)
        expect("ends within five seconds", time.monotonic() - start < 5, True)


def main():
    with Watcher() as watcher:
        watcher.done()
        check_answers(watcher)
        check_refusals(watcher)
        check_posts(watcher)
        check_before_the_body(watcher)
        check_half_sent(watcher)
        check_port(watcher)
        check_events(watcher)
    # As soon as there is an address, whatever the threads are about.
    for _ in range(10):
        with Watcher() as watcher:
            expect("SIGINT at once", watcher.end(signal.SIGINT), 0)
    for line in PROBLEMS:
        print(line)
    sys.exit(1 if PROBLEMS else 0)


if __name__ == "__main__":
    main()
