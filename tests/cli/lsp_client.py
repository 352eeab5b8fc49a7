"""A client of `whit lsp` for tests: sends messages, keeps what comes back, and has the texts as an editor would."""
import json
import os
import subprocess
import threading
import time
from urllib.parse import quote


def uri_of(path):
    return "file://" + quote(os.path.realpath(path))


class Client:
    def __init__(self, capabilities=None, root=None, initialize=True):
        self.process = subprocess.Popen([os.environ["WHIT"], "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.answers, self.diagnostics, self.errors, self.published = {}, {}, [], 0
        self.changed = threading.Condition()
        self.ended = False
        self.next_id = 0
        self.versions = {}
        self.thread = threading.Thread(target=self._read, daemon=True)
        self.thread.start()
        if initialize:
            self.capabilities = self.request("initialize", {
                "processId": None, "rootUri": uri_of(root) if root else None, "capabilities": capabilities or {}})["capabilities"]
            self.notify("initialized", {})

    # ---- messages

    def send_bytes(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, message):
        body = json.dumps(message).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n" % len(body) + body)

    def notify(self, method, params):
        self.send({"jsonrpc": "2.0", "method": method, "params": params})

    def ask(self, method, params):
        """Sends a request without waiting; its id."""
        self.next_id += 1
        self.send({"jsonrpc": "2.0", "id": self.next_id, "method": method, "params": params})
        return self.next_id

    def wait(self, number, timeout=60):
        with self.changed:
            assert self.changed.wait_for(lambda: number in self.answers or self.ended, timeout), "no answer in time"
            assert number in self.answers, "the server ended without an answer"
            return self.answers.pop(number)

    def request(self, method, params, timeout=60):
        answer = self.wait(self.ask(method, params), timeout)
        assert "error" not in answer, (method, answer["error"])
        return answer["result"]

    def fails(self, method, params):
        """The error of a request that must fail."""
        answer = self.wait(self.ask(method, params))
        assert "error" in answer, (method, answer)
        return answer["error"]

    def _read(self):
        out = self.process.stdout
        while True:
            length = 0
            while True:
                line = out.readline()
                if not line:
                    with self.changed:
                        self.ended = True
                        self.changed.notify_all()
                    return
                if line == b"\r\n":
                    break
                if line.lower().startswith(b"content-length:"):
                    length = int(line.split(b":")[1])
            message = json.loads(out.read(length))
            with self.changed:
                if message.get("method") == "textDocument/publishDiagnostics":
                    params = message["params"]
                    self.diagnostics[params["uri"]] = (time.monotonic(), params.get("version"), params["diagnostics"])
                    self.published += 1
                elif "method" not in message:
                    if message["id"] is None:
                        self.errors.append(message["error"])
                    else:
                        self.answers[message["id"]] = message
                self.changed.notify_all()

    # ---- documents

    def open(self, path, text=None):
        if text is None:
            with open(path, encoding="utf-8", newline="") as f:
                text = f.read()
        uri = uri_of(path)
        self.versions[uri] = 1
        self.notify("textDocument/didOpen", {
            "textDocument": {"uri": uri, "languageId": "pbrt", "version": 1, "text": text}})
        return uri

    def edit(self, uri, *changes):
        """Each change is (text,) for all of it, or (text, (line, character), (line, character))."""
        self.versions[uri] += 1
        content = []
        for change in changes:
            one = {"text": change[0]}
            if len(change) > 1:
                one["range"] = {"start": position(change[1]), "end": position(change[2])}
            content.append(one)
        self.notify("textDocument/didChange", {
            "textDocument": {"uri": uri, "version": self.versions[uri]}, "contentChanges": content})

    def save(self, uri):
        self.notify("textDocument/didSave", {"textDocument": {"uri": uri}})

    def close(self, uri):
        self.notify("textDocument/didClose", {"textDocument": {"uri": uri}})

    def at(self, method, uri, place, **more):
        return self.request("textDocument/" + method, {"textDocument": {"uri": uri}, "position": position(place), **more})

    def whole(self, method, uri, **more):
        return self.request("textDocument/" + method, {"textDocument": {"uri": uri}, **more})

    def wait_diagnostics(self, uri, right, timeout=60):
        """The diagnostics of a file as soon as right(them) holds."""
        with self.changed:
            ok = self.changed.wait_for(lambda: self.ended or (uri in self.diagnostics and right(self.diagnostics[uri][2])), timeout)
            found = self.diagnostics.get(uri)
            assert ok and not self.ended, "diagnostics are %s" % (found and found[2])
            return found[2]

    def end(self):
        """Ends the session as the protocol says; the exit code."""
        self.request("shutdown", None)
        self.notify("exit", None)
        code = self.process.wait(60)
        self.thread.join(10)
        return code


def position(place):
    return {"line": place[0], "character": place[1]}


def apply_edits(text, edits):
    """A text with the edits of an answer; characters are counted in UTF-16."""
    lines = text.split("\n")

    def offset(p):
        line = lines[p["line"]] if p["line"] < len(lines) else ""
        units = line.encode("utf-16-le")[: 2 * p["character"]]
        return sum(len(l) + 1 for l in lines[: p["line"]]) + len(units.decode("utf-16-le"))

    for e in sorted(edits, key=lambda e: offset(e["range"]["start"]), reverse=True):
        text = text[: offset(e["range"]["start"])] + e["newText"] + text[offset(e["range"]["end"]):]
    return text
