"""Tasks on the workers of dask.distributed: processes of this machine, or a cluster."""

from __future__ import annotations

import logging
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ringlet.data.errors import UserError
from ringlet.farm.grid import Task
from ringlet.farm.task import Result, Wanted, run_task, write_result

if TYPE_CHECKING:
    from distributed import Client

TOPIC = "ringlet-wedge"
PATIENCE = "20s"  # with a scheduler that does not answer

Told = Callable[[str, int, int], None]


def run_on_workers(
    tasks: Sequence[Task],
    wanted: Wanted,
    *,
    scheduler: str | None,
    workers: int | None,
    retries: int,
    told: Told,
) -> list[Result]:
    """Runs tasks, each by one worker at a time, and returns their results in the same order.

    A task whose worker dies is given to another, where it goes on from its checkpoints; one that breaks off is tried
    again. Neither costs the others anything.

    scheduler: the address of one, such as ``tcp://farm:8786``, whose workers see the same folders; else workers here
    workers:   how many processes here
    retries:   how often a task may break off, or lose its worker, before it is given up
    told:      called as told(name of a task, frames that are done, their number)
    """
    with _client(scheduler, workers, retries) as client:
        from distributed import as_completed

        client.subscribe_topic(TOPIC, lambda event: told(*event[1]))
        run = uuid.uuid4().hex[:8]
        futures = {
            client.submit(_in_worker, task, wanted, key=f"{task.name}-{run}", retries=retries, pure=False): k
            for k, task in enumerate(tasks)
        }
        results: dict[int, Result] = {}
        for future in as_completed(futures, loop=client.loop, raise_errors=False):
            k = futures[future]
            results[k] = future.result() if future.status == "finished" else _failed(tasks[k], future.exception())
    return [results[k] for k in range(len(tasks))]


def _in_worker(task: Task, wanted: Wanted) -> Result:
    """Runs a task and tells the client how far it is."""
    from distributed import get_worker

    worker = get_worker()
    return run_task(task, wanted, lambda done, total: worker.log_event(TOPIC, (task.name, done, total)))


def _failed(task: Task, error: Any) -> Result:
    """What to say of a task that was given up."""
    told = " ".join(str(error).split())
    message = f"{type(error).__name__}: {told}; {task.folder / 'log.txt'} tells more"
    result = Result(task.settings, "failed", message, order=task.order)
    task.folder.mkdir(parents=True, exist_ok=True)
    write_result(task.folder, result)
    return result


@contextmanager
def _client(scheduler: str | None, workers: int | None, retries: int) -> Iterator[Client]:
    """A connection to a scheduler, or to one with workers of its own that go when the block ends."""
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
    quiet = {"distributed.logging.distributed": "critical", "distributed.scheduler.allowed-failures": retries}
    with (
        config.set(quiet),
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            dashboard_address="127.0.0.1:0",  # for the numbers it must have some port: one that is free, seen from here
            scheduler_kwargs={"dashboard": False},
            silence_logs=logging.CRITICAL,
        ) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        yield client
