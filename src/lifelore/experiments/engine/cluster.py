"""Cells of a claim on the workers of a dask cluster (extra `cluster`), through joblib; the same bits as here.

A cell is a pure function of settings, cell and seed, and its worker must have the same code. So a cell whose
worker dies runs again on another worker, and the result does not depend on the cluster.
"""

import socket
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from time import thread_time
from typing import Any

from lifelore.core.errors import InputError, MissingExtraError
from lifelore.experiments.engine.registry import claim_of
from lifelore.experiments.engine.source_key import source_key

SECONDS_TO_CONNECT = 10
"""Time after which a scheduler counts as unreachable."""


def cells_on_cluster(
    scheduler: str, claim_id: str, settings: Mapping[str, Any], cells: Sequence[Mapping[str, Any]], seed: int
) -> Iterator[tuple[int, dict, float]]:
    """Run cells on a cluster; give (place in `cells`, result, processor seconds) of each as it finishes.

    Raises
    ------
    MissingExtraError
        dask.distributed is not installed.
    InputError
        The scheduler cannot be reached or has no workers, or a worker has other code.
    """
    from joblib import Parallel, delayed, parallel_config

    one: Any = 1  # joblib's annotations forget whole numbers
    code = source_key(claim_of(claim_id).run_cell.__module__)
    with _client(scheduler) as client, parallel_config(backend="dask", client=client):
        # A batch is a cell: cells take seconds, and the cells of a dead worker's batch all run again.
        run = Parallel(n_jobs=-1, batch_size=one, return_as="generator_unordered")
        asked = (delayed(run_on_worker)(i, claim_id, settings, cell, seed, code) for i, cell in enumerate(cells))
        done: Any = run(asked)
        yield from done


def run_on_worker(
    place: int, claim_id: str, settings: Mapping[str, Any], cell: Mapping[str, Any], seed: int, code: str
) -> tuple[int, dict, float]:
    """Run a cell in this process, which must have the code of the process that asks."""
    from threadpoolctl import threadpool_limits

    claim = claim_of(claim_id)
    if (own := source_key(claim.run_cell.__module__)) != code:
        raise InputError(
            f"scheduler: worker {socket.gethostname()} has other code of {claim_id} (key {own}, here {code}); "
            "install the same lifelore there"
        )
    # While the worker lives, because cells may overlap in its threads; a library's threads would change its sums.
    threadpool_limits(1)
    began = thread_time()
    result = claim.run_cell(settings, cell, seed)
    return place, result, thread_time() - began


@contextmanager
def _client(scheduler: str) -> Iterator[Any]:
    try:
        from distributed import Client  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingExtraError(
            "engine dask needs dask.distributed, which is not installed; pip install 'lifelore[cluster]'"
        ) from error
    try:
        client = Client(scheduler, timeout=SECONDS_TO_CONNECT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"scheduler {scheduler} cannot be reached; start it with: dask scheduler, and give its tcp:// address"
        ) from error
    try:
        if not client.scheduler_info()["workers"]:
            raise InputError(
                f"scheduler {scheduler} has no workers; start some: dask worker {scheduler} --nthreads 1"
            )
        yield client
    finally:
        client.close()
