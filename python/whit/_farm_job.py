"""A job: a scene with its files, the flags of its picture, and how the program renders a part of it."""
from __future__ import annotations

import contextlib
import ctypes
import hashlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from typing import Any, Sequence

from ._farm_plan import Part, TimeModel


class FarmError(Exception):
    """What a render ended with: `code` is the program's exit code."""

    def __init__(self, message: str, code: int = 4) -> None:
        super().__init__(message, code)
        self.message, self.code = message, code

    def __str__(self) -> str:
        return self.message


def program() -> str:
    """The program `whit`: $WHIT, the one that the package brings along, or the one on the path."""
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "whit")
    for path in (os.environ.get("WHIT"), here, shutil.which("whit")):
        if path and os.access(path, os.X_OK):
            return path
    raise FarmError("there is no program whit: install the wheel whit-render or the package, or set WHIT to its path")


class Running:
    """The program at work: `process` is it. `stdin` and `stderr` are those of subprocess.Popen."""

    def __init__(self, arguments: list[str], folder: str | None = None, stdin: int = subprocess.DEVNULL,
                 stderr: Any = subprocess.PIPE) -> None:
        # Dask's workers have glibc give memory back all the time, for Python's sake: a tenth of a render.
        environment = {k: v for k, v in os.environ.items() if k != "MALLOC_TRIM_THRESHOLD_"}
        self.process = subprocess.Popen([program(), *arguments], cwd=folder, stdin=stdin, stdout=subprocess.PIPE, stderr=stderr,
                                        text=True, env=environment, preexec_fn=_end_with_parent)

    def wait(self) -> tuple[str, str]:
        """Its standard output, and what it said beside; FarmError with its words where it fails."""
        out, said = self.process.communicate()
        if self.process.returncode != 0:
            raise FarmError(said.strip() or _ending(self.process.returncode), self.process.returncode)
        return out, said.strip()

    def kill(self) -> None:
        self.process.kill()

    def close(self) -> None:
        """After a kill, or an end: waits for it, and closes what leads to it."""
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            if stream:
                with contextlib.suppress(BrokenPipeError):
                    stream.close()


def run(arguments: list[str], folder: str | None = None) -> str:
    """Standard output of the program; FarmError with its words where it fails."""
    return Running(arguments, folder).wait()[0]


def _ending(code: int) -> str:
    """How a program ended that said nothing."""
    return f"whit was ended by {signal.Signals(-code).name}" if code < 0 else f"whit ended with {code}"


def _end_with_parent() -> None:
    """A worker that is killed takes its render along (prctl(PR_SET_PDEATHSIG), Linux)."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)


@dataclass(frozen=True)
class SceneFile:
    """A file that a scene reads: its place below the root of all of them, and the hash of its bytes (SHA-256)."""
    name: str
    digest: str


@dataclass(frozen=True)
class Job:
    """`scene` is an absolute path, `given` the scene as somebody named it. `files` are those that have to travel: none where
    workers see the same folders."""
    scene: str
    given: str
    flags: tuple[str, ...]
    root: str = ""
    files: tuple[SceneFile, ...] = field(default=())

    def with_files(self) -> "Job":
        """The same with its files, by what is in them."""
        names = [os.path.abspath(name) for name in json.loads(run(["check", "--files", "--json", self.scene]))["read"]]
        root = os.path.commonpath([os.path.dirname(name) for name in names])
        return Job(self.scene, self.given, self.flags, root, tuple(SceneFile(os.path.relpath(n, root), digest(n)) for n in names))

    def read(self, file: SceneFile) -> bytes:
        with open(os.path.join(self.root, file.name), "rb") as f:
            return f.read()


def digest(path: str) -> str:
    with open(path, "rb") as f:
        return hashlib.file_digest(f, "sha256").hexdigest() if hasattr(hashlib, "file_digest") else hashlib.sha256(
            f.read()).hexdigest()


def unpack(job: Job, contents: dict[str, bytes], folder: str) -> str:
    """Lays a job's files into a folder, each where the scene looks for it; the scene's path there."""
    for file in job.files:
        path = os.path.join(folder, file.name)
        if os.path.exists(path):
            continue
        os.makedirs(os.path.dirname(path), exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=os.path.dirname(path))
        with os.fdopen(handle, "wb") as f:
            f.write(contents[file.digest])
        os.replace(temporary, path)  # other tasks of this machine may be doing the same
    return os.path.join(folder, os.path.relpath(job.scene, job.root))


def folder_of(job: Job) -> str:
    """Where a machine keeps a job's files: by what is in them, so that they travel once."""
    key = hashlib.sha256("".join(f.name + f.digest for f in job.files).encode()).hexdigest()[:24]
    return os.path.join(os.environ.get("WHIT_FARM_CACHE") or os.path.join(tempfile.gettempdir(), f"whit-farm-{os.getuid()}"),
                        key)


def scene_of(job: Job, contents: dict[str, bytes]) -> str:
    """Where the scene is on this machine, once its files have been laid there if they travelled."""
    if not job.files:
        return job.scene
    folder = folder_of(job)
    os.makedirs(folder, mode=0o700, exist_ok=True)
    return unpack(job, contents, folder)


def given_back(state: str, keep: str) -> bytes:
    """The bytes of a file; none where it is put into the file `keep`."""
    if keep:
        shutil.move(state, keep + ".new")
        os.replace(keep + ".new", keep)
        return b""
    with open(state, "rb") as f:
        return f.read()


def render_share(job: Job, of_pass: bytes | str, share: str, threads: int, contents: dict[str, bytes],
                 keep: str = "") -> tuple[bytes, float]:
    """The part that a share of a pass is, as render_part() has it, and the seconds of it that were rendering. `of_pass` is the
    pass's file, or what is in it; `share` as --share has it. Runs on a worker."""
    scene = scene_of(job, contents)
    with tempfile.TemporaryDirectory(prefix="whit-share-") as work:
        state, stats, file = (os.path.join(work, name) for name in ("part", "stats.json", "pass"))
        if isinstance(of_pass, bytes):
            with open(file, "wb") as f:
                f.write(of_pass)
        run([scene, *job.flags, "--pass", of_pass if isinstance(of_pass, str) else file, "--share", share, "--nthreads", str(threads), "--checkpoint", state, "--every",
             "1h", "--quiet", "--stats=" + stats], folder=os.path.dirname(scene))
        with open(stats, encoding="utf-8") as f:
            return given_back(state, keep), json.load(f)["seconds"]["render"]


def render_part(job: Job, part: Part, threads: int, contents: dict[str, bytes], keep: str = "") -> bytes:
    """The bytes of a part, for `whit merge`; none where the worker sees the file `keep`, which they are put into. Runs on a
    worker."""
    scene = scene_of(job, contents)
    with tempfile.TemporaryDirectory(prefix="whit-part-") as work:
        state = os.path.join(work, "part")
        run([scene, *job.flags, *part.flags(), "--nthreads", str(threads), "--checkpoint", state, "--every", "1h", "--outfile",
             "none", "--quiet"], folder=os.path.dirname(scene))
        return given_back(state, keep)


def merge(job: Job, parts: list[str], outfile: str, flags: Sequence[str] = ()) -> str:
    """Joins the files of all parts to the picture; what there was to say of it."""
    return Running(["merge", *parts, "--scene", job.given, "--quiet", *(["--outfile", outfile] if outfile else []),
                    *flags]).wait()[1]


def figures_of(job: Job, part: Part | None, threads: int) -> dict[str, Any]:
    """The statistics of a part's render, as --stats has them; without a part those of one pixel with all samples. And
    "elapsed": the seconds of the process."""
    flags = part.flags() if part else ["--crop-pixels", "0", "1", "0", "1"]
    with tempfile.TemporaryDirectory(prefix="whit-probe-") as work:
        stats = os.path.join(work, "stats.json")
        start = time.monotonic()
        run([job.scene, *job.flags, *flags, "--nthreads", str(threads), "--checkpoint", os.path.join(work, "part"), "--every",
             "1h", "--outfile", "none", "--quiet", "--stats=" + stats])
        elapsed = time.monotonic() - start
        with open(stats, encoding="utf-8") as f:
            return {**json.load(f), "elapsed": elapsed}


def size_of(job: Job) -> tuple[int, int, int]:
    """Width, height and samples per pixel of the picture."""
    settings = figures_of(job, None, 1)["settings"]
    width, height = settings["resolution"]
    return width, height, round(settings["samples_per_pixel"])


def measure(job: Job, threads: int, size: tuple[int, int, int], seconds: float = 2) -> TimeModel:
    """The time model of a scene on this machine: of one sample of every pixel, and of as many as take some seconds."""
    width, height, samples = size
    count = 1
    while True:
        figures = figures_of(job, Part(0, width, 0, height, 0, count), threads)
        render = figures["seconds"]["render"]
        if render >= seconds / 2 or count == samples:
            return TimeModel(figures["elapsed"] - render, render / count)
        count = min(samples, max(2 * count, int(count * seconds / max(render, 1e-3))))
