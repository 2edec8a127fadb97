"""Processes that run long functions and read uploads: a request that ends early ends its function too.

Python cannot stop a thread. A process can be killed: where a client leaves, at the time limit of a request, and
when the service stops. A hostile file can crash or fill a process alone, and not the service.
"""

import asyncio
import multiprocessing
import os
import resource
import signal
import threading
import traceback
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from typing import Any, NamedTuple

from starlette.requests import Request

from lifelore.core.errors import InputError, LifeloreError
from lifelore.memory import open_memory

MEMORY = 16 << 30
"""Bytes of address space of a process; more let a hostile file take more of the machine."""
PROCESSES = 2
"""Largest number of processes; further calls wait, so that long functions do not take all of the machine."""


class ClientLeft(Exception):
    """The client closed its connection before the answer."""


class _Worker(NamedTuple):
    """A process, and the executor that has this one alone, so that its end ends no other call."""

    executor: ProcessPoolExecutor
    pid: int

    def kill(self) -> None:
        with suppress(ProcessLookupError):
            os.kill(self.pid, signal.SIGKILL)
        self.executor.shutdown(wait=False)


class WorkerProcess:
    """Processes that start at the first call, and again after a call that crashed or ended early."""

    def __init__(self, processes: int = PROCESSES) -> None:
        self._free = asyncio.Semaphore(processes)
        self._idle: list[_Worker] = []
        self._busy: set[_Worker] = set()

    async def run(self, request: Request, function: Callable[..., Any], *arguments: Any) -> Any:
        """The result of a function of a module in a process, which is killed if the request ends before.

        Parameters
        ----------
        request : Request
            Its body has been read. The call ends when its client leaves, or when its task is cancelled: at the
            time limit, and when the service stops.
        function, arguments
            They and the result travel to and from the process, so a memory is none of them: see `over_memory`.
            What a function stores in one transaction, a kill leaves whole or not at all.

        Raises
        ------
        LifeloreError
            As the function raised it.
        InputError
            The function crashed the process, or needs more than `MEMORY`.
        ClientLeft
            The client closed its connection.
        RuntimeError
            Any other error of the function; the message is its traceback.
        """
        left = asyncio.ensure_future(_left(request))
        call = asyncio.ensure_future(self.call(function, *arguments))
        try:
            await asyncio.wait({left, call}, return_when=asyncio.FIRST_COMPLETED)
            if call.done():
                return call.result()
            raise ClientLeft
        finally:
            left.cancel()
            call.cancel()

    async def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """As `run`, where no client waits."""
        async with self._free:
            worker = self._idle.pop() if self._idle else await _started()
            self._busy.add(worker)
            try:
                result, error = await asyncio.wrap_future(worker.executor.submit(_answer, function, arguments))
            except BaseException as ended:
                worker.kill()
                if isinstance(ended, BrokenProcessPool):
                    message = "the request crashed the process that worked on it; check what it sends"
                    raise InputError(message) from None
                raise
            finally:
                self._busy.discard(worker)
            self._idle.append(worker)
        if error is not None:
            raise error
        return result

    def stop(self) -> None:
        """End all processes; the next call starts another."""
        for worker in (*self._idle, *self._busy):
            worker.kill()
        self._idle.clear()


async def _started() -> _Worker:
    executor = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), _limit_process)
    try:
        return _Worker(executor, await asyncio.wrap_future(executor.submit(os.getpid)))
    except BaseException:
        executor.shutdown(wait=False)
        raise


async def _left(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass


def over_memory(where: str | None, function: Callable[..., Any], *arguments: Any) -> Any:
    """``function(memory, *arguments)`` over the memory of the settings, opened in this process.

    Examples
    --------
    In a route::

        await service.worker.run(request, over_memory, service.settings.memory, function, *arguments)
    """
    with open_memory(where, durable=True) as memory:
        return function(memory, *arguments)


def _limit_process() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    threading.Thread(target=_end_with_service, daemon=True).start()


def _end_with_service() -> None:
    """End this process in the middle of a call where the service was killed."""
    service = multiprocessing.parent_process()
    if service is not None:
        service.join()
        os._exit(1)


def _answer(function: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, Exception | None]:
    """The result of a function and its error, in a form that travels."""
    try:
        return function(*arguments), None
    except LifeloreError as error:
        return None, type(error)(str(error))
    except MemoryError:
        return None, InputError("the request needs too much memory; send less")
    except Exception:
        return None, RuntimeError(traceback.format_exc())
