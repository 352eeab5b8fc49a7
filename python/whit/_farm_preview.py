"""The picture at a viewer while its parts come in: `whit merge --so-far` of what there is, now and then."""
from __future__ import annotations

import threading
import time
from typing import Callable

from ._farm_job import FarmError, Job, Running

# Times as long as the last look took, until the next begins: looks take a tenth of one core at most.
PAUSE = 10


class Preview:
    """Shows parts that are there, in a thread of its own. A viewer that fails is told of by `warn`, and not called again.
    `seconds` is how long it looked."""

    def __init__(self, job: Job, server: str, warn: Callable[[str], None]) -> None:
        self.seconds = 0.0
        self._job, self._server, self._warn = job, server, warn
        self._parts: list[str] = []
        self._is_new = self._ended = self._opened = self._failed = False
        self._changed = threading.Condition()
        self._running: Running | None = None
        self._thread = threading.Thread(target=self._work, daemon=True)
        if server:
            self._thread.start()

    def add(self, part: str) -> None:
        """A part is there, as a file."""
        with self._changed:
            self._parts.append(part)
            self._is_new = True
            self._changed.notify()

    def end(self) -> list[str]:
        """No more looks. The flags with which `whit merge` shows the whole."""
        with self._changed:
            self._ended = True
            self._changed.notify()
            if self._running:
                self._running.kill()
        if self._server:
            self._thread.join()
        return self.flags()

    def flags(self) -> list[str]:
        if not self._server or self._failed:
            return []
        return ["--display-server", self._server, *(["--shown"] if self._opened else [])]

    def note(self, said: str) -> None:
        """What a look said, of the viewer or of the scene."""
        problem = next((line for line in said.splitlines() if "display server" in line or "--display-server" in line), "")
        if problem:
            self._fail(problem.removeprefix("whit: "))

    def _fail(self, problem: str) -> None:
        if not self._failed:
            self._failed = True
            self._warn(problem)

    def __enter__(self) -> Preview:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def _work(self) -> None:
        while not self._failed:
            with self._changed:
                self._changed.wait_for(lambda: self._is_new or self._ended)
                if self._ended:
                    return
                parts, self._is_new = list(self._parts), False
                self._running = Running(["merge", "--so-far", *parts, "--scene", self._job.given, "--outfile", "none", "--quiet",
                                         *self.flags()])
            start = time.monotonic()
            try:
                _, said = self._running.wait()
                self._opened = True
                self.note(said)
            except FarmError as e:
                if not self._ended:
                    self._fail(f"warning: no preview: {e}")
            seconds = time.monotonic() - start
            self.seconds += seconds
            with self._changed:
                self._running = None
                self._changed.wait_for(lambda: self._ended, PAUSE * seconds)
