"""Workers of a dask cluster as joblib's backend (extra `cluster`)."""

from collections.abc import Iterator
from contextlib import contextmanager

from lifelore.core.errors import InputError, MissingExtraError

SECONDS_TO_CONNECT = 10
"""Time after which a scheduler counts as unreachable."""


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
