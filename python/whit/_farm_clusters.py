"""Workers by Dask: of this machine, of a scheduler that is there, or of a queue that people have."""
from __future__ import annotations

import contextlib
import json
from typing import Any, Iterator

from ._farm_job import FarmError

# The classes of dask-jobqueue and dask-kubernetes, and what to install for each.
QUEUES = {"slurm": ("dask_jobqueue", "SLURMCluster", "dask-jobqueue"), "pbs": ("dask_jobqueue", "PBSCluster", "dask-jobqueue"),
          "lsf": ("dask_jobqueue", "LSFCluster", "dask-jobqueue"), "sge": ("dask_jobqueue", "SGECluster", "dask-jobqueue"),
          "kubernetes": ("dask_kubernetes.operator", "KubeCluster", "dask-kubernetes")}


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


def send_to_all(client: Any, things: list[bytes]) -> list[Any]:
    """Futures of them, which all workers have: the only one that had them may be lost. Waits for a first worker, which may be
    in a queue."""
    if not things:
        return []
    client.wait_for_workers(1)
    return client.scatter(things, hash=True, broadcast=True)
