"""Workers by Dask: of this machine, of a scheduler that is there, or of a queue that people have."""
from __future__ import annotations

import concurrent.futures
import contextlib
import hashlib
import json
import warnings
from typing import Any, Callable, Iterator

from ._farm_job import FarmError, Job

# The classes of dask-jobqueue and dask-kubernetes, and what to install for each.
QUEUES = {"slurm": ("dask_jobqueue", "SLURMCluster", "dask-jobqueue"), "pbs": ("dask_jobqueue", "PBSCluster", "dask-jobqueue"),
          "lsf": ("dask_jobqueue", "LSFCluster", "dask-jobqueue"), "sge": ("dask_jobqueue", "SGECluster", "dask-jobqueue"),
          "kubernetes": ("dask_kubernetes.operator", "KubeCluster", "dask-kubernetes")}

# What a scheduler holds of one file.
MOST_BYTES = 1 << 30
# So often is handed out what somebody kills: the system, perhaps, where memory is short.
ATTEMPTS = 3


def distributed_module() -> Any:
    try:
        import dask
        import distributed
    except ImportError as e:
        raise FarmError("whit-farm needs Dask: pip install 'whit-render[farm]'", 2) from e
    # A part whose worker is lost runs again, however often; by default three lost workers make a part a suspect. And workers
    # that wait for a render need not look at themselves a hundred times a second.
    dask.config.set({"distributed.scheduler.allowed-failures": 1000, "distributed.worker.profile.interval": "10s",
                     "distributed.worker.profile.cycle": "100s", "distributed.admin.tick.interval": "1s",
                     "distributed.admin.system-monitor.interval": "10s"})
    return distributed


def queue_class(name: str) -> Any:
    module, cls, package = QUEUES[name]
    try:
        return getattr(__import__(module, fromlist=[cls]), cls)
    except ImportError as e:
        raise FarmError(f"--cluster {name} needs {package}: pip install {package}", 2) from e


def options_of(text: str) -> dict[str, Any]:
    """Arguments of a cluster's class, as JSON."""
    try:
        options = json.loads(text)
    except ValueError as e:
        raise FarmError(f"--cluster-options: {e}; write JSON like {{\"queue\": \"long\", \"cores\": 8}}", 2) from e
    if not isinstance(options, dict):
        raise FarmError("--cluster-options: write a JSON object", 2)
    return options


@contextlib.contextmanager
def client_of(scheduler: str, cluster: str, options: str, workers: int) -> Iterator[Any]:
    """A Dask client with that many workers, each of which runs one part at a time; they end with the context, but those of a
    scheduler that was there before."""
    distributed, asked = distributed_module(), options_of(options)
    if scheduler:
        with distributed.Client(scheduler, timeout="10s") as client:
            yield client
        return
    if cluster == "local":
        made = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None,
                                        memory_limit=0, silence_logs="CRITICAL")
    else:
        made = queue_class(cluster)(**asked)
        made.scale(workers)
    with made, distributed.Client(made) as client:
        yield client


def give(client: Any, thing: bytes) -> Any:
    """A future of it, for workers. The scheduler holds it and gives it again where the only worker that had it is lost."""
    if len(thing) > MOST_BYTES:
        raise FarmError(f"a file of {len(thing) >> 20} MiB is too large to travel: put it where all workers see it, and use --shared", 2)
    with warnings.catch_warnings():
        # Dask would have large things scattered, which are lost with their workers.
        warnings.simplefilter("ignore")
        return client.submit(bytes, thing, key="whit-" + hashlib.sha256(thing).hexdigest(), priority=1)


def give_files(client: Any, job: Job) -> tuple[list[str], list[Any]]:
    """What of a job has to travel: the hashes of its files, and their futures."""
    by_digest = {f.digest: f for f in job.files}
    digests = sorted(by_digest)
    return digests, [give(client, job.read(by_digest[d])) for d in digests]


def results_of(client: Any, count: int, submit: Callable[[int, int], Any]) -> Iterator[tuple[int, Any]]:
    """What comes of so many calls as they end, each with its number. `submit(number, attempt)` hands one out and returns its
    future. One that is lost, or whose program somebody killed, is handed out again; the first that fails ends all."""
    attempts = [1] * count
    numbers = {submit(n, 1): n for n in range(count)}
    ended = distributed_module().as_completed(numbers)
    for future in ended:
        number = numbers.pop(future)
        try:
            # A result that was lost with its worker since then is waited for.
            result = future.result()
        except (FarmError, concurrent.futures.CancelledError) as e:
            if (isinstance(e, FarmError) and e.code >= 0) or attempts[number] == ATTEMPTS:
                client.cancel(list(numbers))
                raise e if isinstance(e, FarmError) else FarmError("the workers lost it again and again") from e
            attempts[number] += 1
            again = submit(number, attempts[number])
            numbers[again] = number
            ended.add(again)
            continue
        except BaseException:
            client.cancel(list(numbers))
            raise
        future.release()
        yield number, result
