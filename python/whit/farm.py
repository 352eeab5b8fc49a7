"""whit-farm: one picture on many machines, bit by bit the picture of one.

The picture is cut into parts (`_farm_plan`), Dask hands them out, every worker renders its parts by the program `whit`
(`_farm_job`), and `whit merge` joins them. docs/farm.md has commands and figures.
"""
from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
import warnings
from dataclasses import asdict, dataclass
from typing import Any, Callable, Sequence

from . import _farm_clusters as clusters
from ._farm_job import FarmError, Job, measure, merge, program, render_part, size_of
from ._farm_plan import Part, TimeModel, cut, schedule, simulate
from ._farm_preview import Preview
from ._farm_slurm import slurm_script
from ._farm_target import TargetReport, is_asked_for, render_to_target

__all__ = ["FarmError", "Report", "TargetReport", "render", "main"]


@dataclass
class Report:
    """What a render on a farm came to: the parts in the order in which they were given out, the seconds that each took on its
    worker, those of the whole, what the time model had said, and the seconds that previews took beside."""
    parts: list[Part]
    part_seconds: list[float]
    seconds: float
    merge_seconds: float
    workers: int
    model: TimeModel
    predicted_seconds: float
    preview_seconds: float = 0

    def json(self) -> str:
        return json.dumps(asdict(self), indent=1)


def timed_part(job: Job, part: Part, threads: int, keep: str, digests: Sequence[str], *contents: bytes) -> tuple[bytes, float]:
    """A part and the seconds that it took; on a worker."""
    start = time.monotonic()
    return render_part(job, part, threads, dict(zip(digests, contents)), keep), time.monotonic() - start


def collect(client: Any, job: Job, parts: Sequence[Part], threads: int, files: Sequence[str], here: bool,
            progress: Callable[[float], None] | None, preview: Preview) -> list[float]:
    """Has all parts rendered, the first ones first, each to its file; the seconds that each took. `here`: workers see these
    files; elsewhere parts come as bytes."""
    digests, given = clusters.give_files(client, job)

    def submit(number: int, attempt: int) -> Any:
        return client.submit(timed_part, job, parts[number], threads, files[number] if here else "", digests, *given,
                             key=f"part-{number}-{attempt}-{os.getpid()}", priority=-number, pure=False)

    seconds = [0.0] * len(parts)
    work, done = sum(p.work() for p in parts), 0
    for number, (state, took) in clusters.results_of(client, len(parts), submit):
        seconds[number] = took
        if state:
            with open(files[number], "wb") as f:
                f.write(state)
        preview.add(files[number])
        done += parts[number].work()
        if progress:
            progress(done / work)
    return seconds


def render(scene: str, outfile: str = "", *, flags: Sequence[str] = (), workers: int = 0, threads: int = 1,
           scheduler: str = "", cluster: str = "local", cluster_options: str = "{}", shared: bool = False,
           model: TimeModel | None = None, parts_in: str = "", display_server: str = "",
           progress: Callable[[float], None] | None = None, warn: Callable[[str], None] = warnings.warn) -> Report | TargetReport:
    """Renders a scene on many workers to `outfile` (the scene's own name without it), with the bits of a single render.

    `flags` are those of `whit render` that a picture depends on. `threads` are those of a worker; `workers` 0 is as many as
    this machine's cores let run. `shared`: the workers see the scene's files where they are here; else they travel, once to
    each machine. `model`: the scene's time model, which is measured here for some seconds otherwise. `parts_in`: a folder in
    which the parts stay. `display_server`: host:port of a tev viewer that shows the picture while it is made; one that fails
    is told of by `warn`, and ends nothing. With --target-error among the flags the passes of the render are shared out, as
    many as it takes, and the report is another one. Raises FarmError with the program's words.
    """
    workers = workers or max(1, (os.cpu_count() or 1) // threads)
    job = Job(os.path.abspath(scene), scene, tuple(flags))
    if is_asked_for(flags):
        is_here = cluster == "local" and not scheduler
        with tempfile.TemporaryDirectory(prefix="whit-farm-") as temporary, clusters.client_of(
                scheduler, cluster, cluster_options, workers) as client:
            return render_to_target(client, job, job if is_here or shared else job.with_files(), workers, threads,
                                    os.path.abspath(parts_in) if parts_in else temporary, is_here, bool(parts_in), outfile,
                                    display_server, progress, warn)
    width, height, samples = size_of(job)
    model = model or measure(job, threads, (width, height, samples))
    parts = cut(width, height, samples, workers, model)
    is_here = cluster == "local" and not scheduler
    if not is_here and not shared:
        job = job.with_files()
    with tempfile.TemporaryDirectory(prefix="whit-farm-") as temporary:
        folder = parts_in or temporary
        os.makedirs(folder, exist_ok=True)
        files = [os.path.abspath(os.path.join(folder, f"{i}.part")) for i in range(len(parts))]
        with clusters.client_of(scheduler, cluster, cluster_options, workers) as client, Preview(
                job, display_server, warn) as preview:
            started = time.monotonic()
            seconds = collect(client, job, parts, threads, files, is_here, progress, preview)
            rendered = time.monotonic()
        preview.note(merge(job, files, outfile, preview.end()))
        merged = time.monotonic()
    return Report(parts, seconds, rendered - started, merged - rendered, workers, model,
                  simulate(parts, workers, model, width * height), preview.seconds)


# ---- The command ----

def arguments_of(words: Sequence[str]) -> tuple[argparse.Namespace, list[str]]:
    parser = argparse.ArgumentParser(
        prog="whit-farm", description="Renders a scene on many workers: bit by bit the picture of a single render.",
        epilog="Flags behind -- are those of whit render that the picture depends on: whit-farm a.pbrt -- --spp 256 --aov N")
    parser.add_argument("scene")
    parser.add_argument("-o", "--outfile", default="", help="picture file, instead of the scene's")
    parser.add_argument("--workers", type=int, default=0, help="how many (default: this machine's cores by --threads)")
    parser.add_argument("--threads", type=int, default=1, help="threads of each worker (1)")
    parser.add_argument("--scheduler", default="", metavar="ADDRESS", help="a Dask scheduler that is there: tcp://host:8786")
    parser.add_argument("--cluster", default="local", choices=["local", *clusters.QUEUES], help="where workers are started")
    parser.add_argument("--cluster-options", default="{}", metavar="JSON", help="arguments of the cluster's class in Dask")
    parser.add_argument("--shared", action="store_true", help="workers see the scene's files where they are here")
    parser.add_argument("--display-server", default="", metavar="HOST:PORT", help="show the picture while it is made: a tev viewer")
    parser.add_argument("--keep", default="", metavar="FOLDER", help="keep the parts there")
    parser.add_argument("--json", default="", metavar="FILE", help="what it came to; - is standard output")
    parser.add_argument("--simulate", type=int, default=0, metavar="N", help="render nothing: say how long N workers would take")
    parser.add_argument("--slurm-script", default="", metavar="FILE", help="render nothing: write a job array for sbatch")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    words = list(words)
    at = words.index("--") if "--" in words else len(words)
    return parser.parse_args(words[:at]), words[at + 1:]


def show_progress(share: float) -> None:
    print(f"\rwhit-farm: {100 * share:.0f} %", end="\n" if share >= 1 else "", file=sys.stderr, flush=True)


def show_warning(text: str) -> None:
    print(f"\nwhit-farm: {text}", file=sys.stderr, flush=True)


def say_schedule(job: Job, args: argparse.Namespace) -> None:
    """What the time model says of some workers, and of half and twice as many."""
    width, height, samples = size_of(job)
    model = measure(job, args.threads, (width, height, samples))
    print(f"a part takes {model.fixed:.3g} s, a sample of every pixel {model.per_sample:.3g} s ({args.threads} threads)")
    alone = model.fixed + samples * model.per_sample
    for n in (max(1, args.simulate // 2), args.simulate, 2 * args.simulate):
        parts = cut(width, height, samples, n, model)
        seconds = simulate(parts, n, model, width * height)
        print(f"{n:5d} workers: {len(parts)} parts, {seconds:.3g} s, {alone / seconds:.3g} times one worker, "
              f"{100 * alone / seconds / n:.0f} % of the workers' time")


def write_slurm_script(job: Job, args: argparse.Namespace) -> None:
    width, height, samples = size_of(job)
    parts = cut(width, height, samples, max(1, args.workers), measure(job, args.threads, (width, height, samples)))
    text = slurm_script(job, parts, args.threads, os.path.abspath(args.outfile) if args.outfile else "",
                        os.path.abspath(args.keep or args.slurm_script + ".parts"), program())
    with open(args.slurm_script, "w", encoding="utf-8") as f:
        f.write(text)
    print(f"whit-farm: {args.slurm_script}: {len(parts)} parts; sbatch {args.slurm_script}, and when all are done "
          f"bash {args.slurm_script} merge", file=sys.stderr)


def say_report(report: Report | TargetReport) -> None:
    if isinstance(report, TargetReport):
        print(f"whit-farm: {report.summary()}", file=sys.stderr)
        return
    replayed = schedule(report.part_seconds, report.workers)
    print(f"whit-farm: {len(report.parts)} parts on {report.workers} workers in {report.seconds:.3g} s (the time model: "
          f"{report.predicted_seconds:.3g} s; the parts' own times: {replayed:.3g} s), joined in {report.merge_seconds:.3g} s",
          file=sys.stderr)


def run_command(args: argparse.Namespace, flags: list[str]) -> int:
    """The exit code."""
    job = Job(os.path.abspath(args.scene), args.scene, tuple(flags))
    if is_asked_for(flags) and (args.simulate or args.slurm_script):
        raise FarmError("--target-error: how many samples it takes is decided while it renders, which neither a job array nor a "
                        "schedule can do; --spp says how many", 2)
    if args.simulate:
        say_schedule(job, args)
    elif args.slurm_script:
        write_slurm_script(job, args)
    else:
        report = render(args.scene, args.outfile, flags=flags, workers=args.workers, threads=args.threads,
                        scheduler=args.scheduler, cluster=args.cluster, cluster_options=args.cluster_options,
                        shared=args.shared, parts_in=args.keep, display_server=args.display_server,
                        progress=None if args.quiet else show_progress, warn=show_warning)
        if args.json:
            with open(1 if args.json == "-" else args.json, "w", encoding="utf-8", closefd=args.json != "-") as f:
                f.write(report.json() + "\n")
        if not args.quiet:
            say_report(report)
        if isinstance(report, TargetReport):
            return report.code
    return 0


def main(words: Sequence[str] | None = None) -> int:
    args, flags = arguments_of(sys.argv[1:] if words is None else words)
    try:
        return run_command(args, flags)
    except FarmError as e:
        print(f"whit-farm: {e}", file=sys.stderr)
        return e.code if e.code > 0 else 4
    except OSError as e:
        print(f"whit-farm: {e}", file=sys.stderr)
        return 4


if __name__ == "__main__":
    sys.exit(main())
