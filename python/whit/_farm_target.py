"""A render to an accuracy on many workers. One program has the sums and decides (`whit --hand-out`); workers take shares of
its passes, and whatever they are, the picture is that of one machine."""
from __future__ import annotations

import json
import os
import subprocess
import tempfile
import time
from dataclasses import asdict, dataclass, field
from typing import Any, Callable, Sequence

from . import _farm_clusters as clusters
from ._farm_job import FarmError, Job, Running, render_share
from ._farm_plan import ShareCost, count_of_shares


@dataclass
class Pass:
    """Samples over all pixels, the error that was known before (none: not yet), the seconds of each share on its worker, and
    those from the first to the last."""
    samples: float
    error: float | None
    share_seconds: list[float] = field(default_factory=list)
    seconds: float = 0


@dataclass
class TargetReport:
    """What a render to an accuracy came to: its passes, and how it ended, as --json of `whit render` has it. `code` is the
    program's: 0, or 5 where the target was not met. The picture is there either way."""
    passes: list[Pass]
    seconds: float
    workers: int
    outcome: dict[str, Any]
    code: int

    def json(self) -> str:
        return json.dumps(asdict(self), indent=1)

    def summary(self) -> str:
        shares = sum(len(p.share_seconds) for p in self.passes)
        return (f"{self.outcome['end']}: error {100 * (self.outcome['achieved']['value'] or float('inf')):.3g} %; "
                f"{len(self.passes)} passes in {shares} shares on {self.workers} workers in {self.seconds:.3g} s")


def is_asked_for(flags: Sequence[str]) -> bool:
    """Raises FarmError where flags want what only one machine can do."""
    names = {flag.partition("=")[0] for flag in flags}
    if "--time-limit" in names:
        raise FarmError("--time-limit is of one machine's clock, and many have no common one; --target-error or --spp say how "
                        "far to render", 2)
    return "--target-error" in names


class Decider:
    """The program that decides, at work."""

    def __init__(self, job: Job, folder: str, outfile: str, display_server: str) -> None:
        self._outcome = os.path.join(folder, "outcome.json")
        more = (["--outfile", outfile] if outfile else []) + (["--display-server", display_server] if display_server else [])
        # What it says goes to a file: nobody reads it while it works.
        self._said = tempfile.TemporaryFile(mode="w+", dir=folder)
        self._running = Running([job.given, *job.flags, "--hand-out", os.path.join(folder, "passes"), "--json", self._outcome,
                                 "--quiet", *more], stdin=subprocess.PIPE, stderr=self._said)

    def passes(self) -> Any:
        """What it says of each pass, as they come."""
        for line in self._running.process.stdout:
            yield json.loads(line)

    def give(self, part: str) -> None:
        """The name of a part; "" when all of a pass are there."""
        try:
            self._running.process.stdin.write(part + "\n")
            self._running.process.stdin.flush()
        except BrokenPipeError:
            self.end()  # which says why
            raise FarmError("whit ended early") from None

    def end(self) -> tuple[dict[str, Any], int, str]:
        """How it ended: what it came to, the exit code, and what it said."""
        code = self._running.process.wait()
        self._said.seek(0)
        said = self._said.read().strip()
        if code not in (0, 5) or not os.path.exists(self._outcome):
            raise FarmError(said or f"whit ended with {code}", code if code > 0 else 4)
        with open(self._outcome, encoding="utf-8") as f:
            return json.load(f), code, said

    def __enter__(self) -> Decider:
        return self

    def __exit__(self, *_: object) -> None:
        self._running.kill()
        self._running.close()
        self._said.close()


def timed_share(job: Job, of_pass: bytes | str, share: str, threads: int, keep: str, digests: Sequence[str],
                *contents: bytes) -> tuple[bytes, float, float]:
    """A share of a pass (its file, or what is in it), the seconds that it took and those of them that it rendered; on a
    worker."""
    start = time.monotonic()
    state, rendering = render_share(job, of_pass, share, threads, dict(zip(digests, contents)), keep)
    return state, time.monotonic() - start, rendering


class Shares:
    """Hands the shares of passes to workers. `folder`: where the parts go; `here`: whether workers see it."""

    def __init__(self, client: Any, job: Job, workers: int, threads: int, folder: str, here: bool) -> None:
        self._client, self._job, self._workers, self._threads = client, job, workers, threads
        self._folder, self._here = folder, here
        self._digests, self._given = clusters.give_files(client, job)
        self._cost = ShareCost()
        os.makedirs(folder, exist_ok=True)

    def render(self, said: dict[str, Any], give: Callable[[str], None], progress: Callable[[float], None]) -> Pass:
        """All of a pass; `give` is told of parts as they come, `progress` of the share of it that there is."""
        number, start = said["pass"], time.monotonic()
        count = count_of_shares(said["samples"], said["tiles"], self._workers, self._cost)
        of_pass = said["file"] if self._here else clusters.give(self._client, _bytes_of(said["file"]))
        parts = [os.path.join(self._folder, f"{number}-{k + 1}.part") for k in range(count)]

        def submit(k: int, attempt: int) -> Any:
            return self._client.submit(timed_share, self._job, of_pass, f"{k + 1}/{count}", self._threads,
                                       parts[k] if self._here else "", self._digests, *self._given,
                                       key=f"share-{number}-{k}-{attempt}-{os.getpid()}", pure=False)

        done = Pass(said["samples"], said["error"])
        rendering = 0.0
        for k, (state, seconds, rendered) in clusters.results_of(self._client, count, submit):
            if state:
                with open(parts[k], "wb") as f:
                    f.write(state)
            give(parts[k])
            done.share_seconds.append(seconds)
            rendering += rendered
            progress(len(done.share_seconds) / count)
        give("")
        self._cost.note(said["samples"], count, sum(done.share_seconds), rendering)
        done.seconds = time.monotonic() - start
        return done


def render_to_target(client: Any, job: Job, sent: Job, workers: int, threads: int, folder: str, here: bool, keep: bool,
                     outfile: str, display_server: str, progress: Callable[[float], None] | None,
                     warn: Callable[[str], None]) -> TargetReport:
    """Renders `job` to `outfile`; `sent` is what workers are given of it, `folder` for what is on its way."""
    started, passes, tell = time.monotonic(), [], progress or (lambda _: None)
    shares = Shares(client, sent, workers, threads, folder, here)
    with tempfile.TemporaryDirectory(prefix="whit-farm-") as temporary, Decider(job, temporary, outfile, display_server) as decider:
        for said in decider.passes():
            if not keep:
                _empty(folder)  # of the pass before
            # How many samples there will be is a guess that grows: a pass is half of what seems to be left.
            before = said["share"]
            passes.append(shares.render(said, decider.give, lambda share: tell(min(before + share * (1 - before) / 2, 0.99))))
        outcome, code, said_of_it = decider.end()
    for line in said_of_it.splitlines():
        if "display server" in line or "--display-server" in line:
            warn(line.removeprefix("whit: "))
    tell(1)
    return TargetReport(passes, time.monotonic() - started, workers, outcome, code)


def _bytes_of(file: str) -> bytes:
    with open(file, "rb") as f:
        return f.read()


def _empty(folder: str) -> None:
    for name in os.listdir(folder):
        if name.endswith(".part"):
            os.remove(os.path.join(folder, name))
