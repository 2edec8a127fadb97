"""Where cells run: in this process, in processes of this machine, or on the workers of a dask cluster.

A cell is a pure function of settings, cell and seed, so its result depends neither on the place nor on what runs
beside it. Starting processes takes longer than most quick runs, which therefore run here, one cell after another.
"""

import socket
from collections.abc import Generator, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager, nullcontext
from time import thread_time
from typing import Any, NamedTuple
from warnings import catch_warnings, filterwarnings

from lifelore.core.errors import InputError, MissingExtraError
from reproduction.engine.cell_store import CellStore
from reproduction.engine.claim import Claim
from reproduction.engine.provenance import source_key
from reproduction.engine.registry import claim_of

SECONDS_TO_CONNECT = 10
"""Time after which a scheduler counts as unreachable."""


class CellRun(NamedTuple):
    """A cell to run, and where it is kept."""

    claim: Claim
    settings: Mapping[str, Any]
    seed: int
    cell: Mapping[str, Any]
    store: CellStore


Finished = Generator[tuple[int, dict], None, None]
"""Place and content of each finished cell, which is stored already."""


def run_here(cells: Sequence[CellRun]) -> Finished:
    """Run cells one after another; where it is stopped, the cell under way is dropped."""
    from threadpoolctl import threadpool_limits

    for place, (claim, settings, seed, cell, store) in enumerate(cells):
        with threadpool_limits(1):  # a library's own threads would change its sums
            result, seconds = _timed(claim, settings, cell, seed)
        yield place, store.put(cell, result, seconds)


def run_on_workers(cells: Sequence[CellRun], jobs: int, scheduler: str | None = None) -> Finished:
    """Run cells in processes; where it is stopped, cells under way are dropped.

    Parameters
    ----------
    jobs : int
        Processes here; a cluster uses all its workers.
    scheduler : str, optional
        Address of a dask scheduler, such as ``tcp://host:8786`` (extra ``cluster``); default: this machine.

    Raises
    ------
    MissingExtraError
        dask.distributed is not installed.
    InputError
        The scheduler cannot be reached or has no workers; a worker has other code, or died for good.
    """
    from joblib import Parallel, delayed

    # joblib replaces a worker that has grown by 300 MB, loses nothing, and warns from a thread of its own.
    filterwarnings("ignore", message="A worker stopped while some jobs", category=UserWarning)
    one: Any = 1  # joblib's annotations forget whole numbers
    with cluster_backend(scheduler) if scheduler else nullcontext():
        # A batch is a cell: cells take seconds, and the cells of a dead worker's batch all run again.
        run = Parallel(-1 if scheduler else jobs, batch_size=one, return_as="generator_unordered")
        asked = (
            delayed(run_on_worker)(place, claim.id, settings, cell, seed, source_key())
            for place, (claim, settings, seed, cell, _) in enumerate(cells)
        )
        done: Any = run(asked)
        try:
            for place, result, seconds in done:
                yield place, cells[place].store.put(cells[place].cell, result, seconds)
        except BrokenExecutor as error:
            raise InputError(
                "jobs: a process that ran cells died, perhaps for want of memory; run the same again with fewer "
                f"than {jobs} (what is finished is kept)"
            ) from error
        finally:
            with catch_warnings(action="ignore"):  # of cells that are dropped
                done.close()


def run_on_worker(
    place: int, claim_id: str, settings: Mapping[str, Any], cell: Mapping[str, Any], seed: int, code: str
) -> tuple[int, dict, float]:
    """Run a cell in this process, which must have the code of the process that asks.

    Returns
    -------
    tuple
        `place`, the cell's result, and the processor seconds it took.
    """
    from threadpoolctl import threadpool_limits

    claim = claim_of(claim_id)
    if (own := source_key()) != code:
        raise InputError(
            f"worker {socket.gethostname()} has other code of {claim_id} (key {own}, here {code}); "
            "it must have the same lifelore"
        )
    # While the worker lives, because cells may overlap in its threads.
    threadpool_limits(1)
    return place, *_timed(claim, settings, cell, seed)


def _timed(claim: Claim, settings: Mapping[str, Any], cell: Mapping[str, Any], seed: int) -> tuple[dict, float]:
    """A cell's result and its processor seconds."""
    began = thread_time()
    return claim.run_cell(settings, cell, seed), thread_time() - began


@contextmanager
def cluster_backend(scheduler: str) -> Iterator[None]:
    """While it is entered, joblib runs on the workers of this scheduler; work of a dead worker runs on another.

    Raises
    ------
    MissingExtraError
        dask.distributed is not installed.
    InputError
        The scheduler cannot be reached or has no workers.
    """
    from joblib import parallel_config

    try:
        from distributed import Client  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingExtraError(
            "a cluster needs dask.distributed, which is not installed; pip install 'lifelore[cluster]'"
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
        with parallel_config(backend="dask", client=client):
            yield
    finally:
        client.close()
