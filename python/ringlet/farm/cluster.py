"""Runs tasks on workers of dask.distributed: local processes, or a cluster."""

from __future__ import annotations

import logging
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ringlet.data.errors import UserError
from ringlet.farm.grid import Task
from ringlet.farm.task import Result, TaskOptions, run_task, write_result

if TYPE_CHECKING:
    from distributed import Client, LocalCluster

TOPIC = "ringlet-wedge"
PATIENCE = "20s"  # timeout of the connection to a scheduler

Progress = Callable[[str, int, int], None]


def run_on_workers(
    tasks: Sequence[Task],
    options: TaskOptions,
    *,
    scheduler: str | None,
    workers: int | None,
    retries: int,
    progress: Progress,
) -> list[Result]:
    """Runs tasks, each on one worker at a time, and returns their results in the same order.

    The task of a worker that dies moves to another worker and resumes from its checkpoints. A task that fails is
    retried. Other tasks are unaffected.

    scheduler: address such as ``tcp://farm:8786``, with workers that see the same folders; None for local workers
    workers:   number of local worker processes
    retries:   number of times that a task may fail, or lose its worker
    progress:  called with (name of a task, frames done, their number)
    """
    with _client(scheduler, workers, retries) as client:
        from distributed import as_completed

        client.subscribe_topic(TOPIC, lambda event: progress(*event[1]))
        run = uuid.uuid4().hex[:8]
        futures = {
            client.submit(_in_worker, task, options, key=f"{task.name}-{run}", retries=retries, pure=False): k
            for k, task in enumerate(tasks)
        }
        results: dict[int, Result] = {}
        for future in as_completed(futures, loop=client.loop, raise_errors=False):
            k = futures[future]
            results[k] = future.result() if future.status == "finished" else _failed(tasks[k], future.exception())
    return [results[k] for k in range(len(tasks))]


def _in_worker(task: Task, options: TaskOptions) -> Result:
    """Runs a task on a worker and reports its progress to the client."""
    from distributed import get_worker

    worker = get_worker()
    return run_task(task, options, lambda done, total: worker.log_event(TOPIC, (task.name, done, total)))


def _failed(task: Task, error: Any) -> Result:
    """Writes and returns the result of a task that failed for good."""
    reason = " ".join(str(error).split())
    message = f"{type(error).__name__}: {reason}; {task.folder / 'log.txt'} tells more"
    result = Result(task.settings, "failed", message, order=task.order)
    task.folder.mkdir(parents=True, exist_ok=True)
    write_result(task.folder, result)
    return result


@contextmanager
def _client(scheduler: str | None, workers: int | None, retries: int) -> Iterator[Client]:
    """Connects to a scheduler, or starts a local cluster that ends with the block.

    Raises UserError without dask.distributed, for a scheduler that does not answer and for workers that do not start.
    """
    try:
        from dask import config
        from distributed import Client, LocalCluster
    except ImportError:
        raise UserError(
            "wedge: dask.distributed is not installed; pip install 'ringlet[farm]', or run the tasks one after the "
            "other with --here"
        ) from None
    if scheduler is not None:
        try:
            with Client(scheduler, timeout=PATIENCE, set_as_default=False) as client:
                yield client
        except (OSError, ValueError) as error:
            raise UserError(
                f"wedge: no scheduler answers at {scheduler} ({' '.join(str(error).split())[:120]}); start one with: "
                "dask scheduler"
            ) from None
        return
    settings = {"distributed.logging.distributed": "critical", "distributed.scheduler.allowed-failures": retries}
    with (
        config.set(settings),
        _local_cluster(LocalCluster, workers) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        yield client


def _local_cluster(make: Callable[..., LocalCluster], workers: int | None) -> LocalCluster:
    """Starts local worker processes; raises UserError when one of them ends while it starts."""
    try:
        return make(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            dashboard_address="127.0.0.1:0",  # metrics need a port: any free one on loopback
            scheduler_kwargs={"dashboard": False},
            silence_logs=logging.CRITICAL,
        )
    except (OSError, RuntimeError, TimeoutError) as error:
        count = f"one of {workers} workers" if workers and workers > 1 else "a worker"
        raise UserError(
            f"wedge: {count} ended while it started ({' '.join(str(error).split())[:120]}): it was killed, or memory "
            "ran out; ask for fewer --workers, or run the tasks one after the other with --here"
        ) from None
