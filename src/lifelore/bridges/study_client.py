"""A Python client of one study, which answers also while the service is gone, and delivers each outcome once.

This file imports the standard library alone: copy it into a program that has no Lifelore.

    with StudyClient("http://127.0.0.1:8321", "playlists", fallback="slow") as client:
        choice = client.decide("ada")
        client.observe(choice, 7.5)

A thread of the client fetches the study's table of probabilities, delivers outcomes, and finds out when a service
that was gone is back.
"""

import atexit
import http.client
import json
import logging
import math
import os
import random
import socket
import sqlite3
import threading
import time
import uuid
from collections import Counter, deque
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, closing, suppress
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote, urlsplit

log = logging.getLogger("lifelore.study_client")

FAILURES = 3
"""Failures in a row after which calls no longer ask the service; more cost slow calls, fewer give up too early."""
WAITS = (0.25, 5.0)
"""Seconds between attempts to reach a service that is gone: the first wait, doubled up to the last."""
LINGER = 0.05
"""Seconds in which outcomes gather to be delivered together; more saves requests, but beliefs are older."""
BATCH = 1000
"""Outcomes in one delivery."""
PROBE = 2.0
"""Seconds that the table may take; more finds a slow service, but a service that hangs is found back later."""
PATIENCE = 10.0
"""Seconds that a delivery or the erasure of a user may take."""
REMEMBERED = 10_000
"""Users whose last probabilities, and offline choices whose particulars, are in memory."""
MOST_CALLS = 32
"""Calls at a time that wait for the service."""
RETRIED = ("store", "rate", "time")
"""Kinds of errors of one outcome that are not its fault."""


class ServiceUnavailable(ConnectionError):
    """The service gave no answer in time, or said that it cannot answer now."""


class ServiceRefusal(ValueError):
    """The service refused a request that breaks a rule; the message is the service's own."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status


@dataclass(frozen=True)
class Choice:
    """A policy for a user.

    Attributes
    ----------
    policy : str
        Name of the policy.
    decision : str
        UUID of the decision.
    probability : float
        Probability with which this policy was drawn, in (0, 1].
    source : str
        ``"service"``; ``"table"``, drawn from the last probabilities known of the user or of strangers; or
        ``"fallback"``.
    user : str
        Name of the user.
    context : str, optional
        Context of the user.
    time : float
        Seconds since 1970, UTC.
    """

    policy: str
    decision: str
    probability: float
    source: str
    user: str
    context: str | None
    time: float


class StudyClient:
    """Decisions and outcomes of one study over HTTP. All methods may be called from many threads.

    Parameters
    ----------
    url : str
        Address of the service, such as ``"https://lore.example.org"``.
    study : str
        Name of the study.
    token : str, optional
        Token of the service.
    fallback : str, optional
        The policy if nothing else is known. Without it, the constructor waits for the service's first table.
    queue : path, optional
        A file for the outcomes that are not delivered yet: they survive a crash of this process. One client at a
        time can use it. Without a file, outcomes that `close` could not deliver are lost.
    timeout : float
        Seconds after which `decide` answers without the service, > 0.
    refresh : float
        Seconds between two fetches of the table, > 0.
    capacity : int
        Maximum number of outcomes that wait for delivery; further ones are lost, and counted as ``lost``.
    fsync : bool
        Whether the queue's file also survives a failure of the machine; each outcome then waits for the disk.
    seed : int, optional
        Seed of the draws that the client makes itself.

    Raises
    ------
    ValueError
        An argument breaks its rule, another client uses the queue's file, or the service refuses the request.
    ServiceUnavailable
        Without `fallback`: the service gave no table within two seconds.

    Examples
    --------
    >>> client = StudyClient("http://127.0.0.1:9", "playlists", fallback="slow")  # no service answers here
    >>> choice = client.decide("ada")
    >>> choice.policy, choice.source
    ('slow', 'fallback')
    >>> client.close()
    """

    def __init__(
        self,
        url: str,
        study: str,
        token: str | None = None,
        fallback: str | None = None,
        queue: str | os.PathLike[str] | None = None,
        timeout: float = 0.2,
        *,
        refresh: float = 60.0,
        capacity: int = 100_000,
        fsync: bool = False,
        seed: int | None = None,
    ) -> None:
        if not (timeout > 0 and refresh > 0 and capacity > 0):
            raise ValueError(
                f"timeout, refresh and capacity must be above 0, got {timeout}, {refresh}, {capacity}"
            )
        self.study, self._fallback, self._timeout, self._refresh = study, fallback, timeout, refresh
        self._link = _Link(url, f"/v1/studies/{quote(study, safe='')}", token)
        self._breaker, self._random = _Breaker(), random.Random(seed)
        self._table: dict[str | None, dict[str, float]] = {}
        self._users, self._offline = Recent(REMEMBERED), Recent(REMEMBERED)
        self._counts, self._lock, self._delivering = Counter(), threading.Lock(), threading.Lock()
        self._delivery_wait, self._deliver_at, self._probed_at = 0.0, 0.0, -math.inf
        self._process = os.getpid()
        self._wake, self._stopped = threading.Event(), threading.Event()
        self._queue = _Queue(queue, capacity, fsync)
        try:
            if fallback is None:
                self._fetch_table()
        except BaseException:
            self._link.close()
            self._queue.close()
            raise
        self._thread = threading.Thread(target=self._run, name=f"study {study}", daemon=True)
        self._thread.start()
        atexit.register(self.close)

    def __enter__(self) -> "StudyClient":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def decide(
        self,
        user: str,
        context: str | None = None,
        features: Mapping[str, float] | None = None,
        available: Sequence[str] | None = None,
        request: str | None = None,
    ) -> Choice:
        """A policy for the user, within about `timeout` seconds whether or not the service answers.

        Parameters
        ----------
        user : str
            Name of the user.
        context : str, optional
            Context of the user, as in the logs of the fit.
        features : mapping, optional
            Numbers known of the user beforehand.
        available : sequence of str, optional
            Policies that the user can get now; default: all.
        request : str, optional
            An identifier unique for the user. The same request gets the same decision from the service. Without
            the service it gets the same decision as long as the probabilities are the same.

        Raises
        ------
        ValueError
            An argument breaks a rule, or the service does not know the study.
        RuntimeError
            The client is closed, or was made before a fork of the process.
        """
        if not (isinstance(user, str) and user):
            raise ValueError(f"user must be a text of at least one character, got {user!r}")
        if available is not None and not len(available):
            raise ValueError("available must name a policy, got none")
        given = {
            "user": user, "context": context, "request": request,
            "features": None if features is None else dict(features),
            "available": None if available is None else list(available),
        }  # fmt: skip
        item = {name: value for name, value in given.items() if value is not None}
        made = self._made_by_service(item)
        if made is None:
            return self._offline_choice(item)
        self._count("service")
        if probabilities := made.pop("probabilities"):
            self._users.put((user, context), probabilities)
        return _choice(item, source="service", **made)

    def observe(self, choice: Choice | str, outcome: float) -> None:
        """Queue the outcome of a decision; it is delivered soon, and counts once however often it is delivered.

        Parameters
        ----------
        choice : Choice or str
            The choice, or its ``decision``. Of a choice made without the service, the identifier alone is enough
            for the last 10,000 of this client.
        outcome : float
            Finite; larger is better.
        """
        self._check_usable()
        outcome = float(outcome)
        if not math.isfinite(outcome):
            raise ValueError(f"outcome must be a finite number, got {outcome}")
        if isinstance(choice, str):
            choice = self._offline.get(choice) or choice
        if isinstance(choice, str) or choice.source == "service":
            line = {"decision": choice if isinstance(choice, str) else choice.decision, "outcome": outcome}
        else:
            line = {"id": choice.decision, "user": choice.user, "policy": choice.policy, "outcome": outcome}
            line |= {"time": choice.time} | ({} if choice.context is None else {"context": choice.context})
        if not self._queue.put(line):
            self._count("lost")
        self._wake.set()

    def flush(self, seconds: float = 5.0) -> bool:
        """Whether all outcomes were delivered within these seconds. The first attempt is made at once."""
        end = time.monotonic() + seconds
        if len(self._queue):
            self._deliver_at, self._probed_at = 0.0, -math.inf
        while len(self._queue) and time.monotonic() < end:
            self._wake.set()
            time.sleep(min(0.005, seconds))
        return not len(self._queue)

    def close(self, seconds: float = 5.0) -> None:
        """End the client, after at most these seconds to deliver outcomes. A queue's file keeps the rest."""
        if self._stopped.is_set() or self._process != os.getpid():
            return
        if not self.flush(seconds) and not self._queue.path:
            log.error("study %s: %d outcomes are lost, since no queue stores them", self.study, len(self._queue))
        self._stopped.set()
        self._wake.set()
        self._thread.join(seconds)
        self._link.close()
        self._queue.close()
        atexit.unregister(self.close)

    def report(self, seconds: float = 60.0) -> dict[str, Any]:
        """The study's report: decisions, outcomes, uplift over the control group with its interval.

        Raises
        ------
        ServiceUnavailable
            The service gave no answer in these seconds.
        """
        return self._link.ask("GET", "/report", None, seconds)

    def forget(self, user: str) -> None:
        """Erase all that the service and this client store of a user. Unlike outcomes, this is not queued.

        Raises
        ------
        ValueError
            The service stores nothing of the user.
        ServiceUnavailable
            The service gave no answer in ten seconds; ask again later.
        """
        with self._delivering:
            self._queue.forget(user)
            self._users.drop(lambda key, _: key[0] == user)
            self._offline.drop(lambda _, choice: choice.user == user)
            self._link.ask("DELETE", f"/user?name={quote(user, safe='')}", None, PATIENCE)

    def counts(self) -> dict[str, int]:
        """Numbers of choices and of outcomes since the start.

        Returns
        -------
        dict
            Choices by source: ``service``, ``table``, ``fallback``. Outcomes ``delivered``, ``refused`` by the
            service, ``lost`` since the queue was full, and ``pending``.
        """
        names = ("service", "table", "fallback", "delivered", "refused", "lost")
        with self._lock:
            return {name: self._counts[name] for name in names} | {"pending": len(self._queue)}

    def _made_by_service(self, item: dict[str, Any]) -> dict[str, Any] | None:
        """The service's decision; None if it gives none."""
        self._check_usable()
        if not self._breaker.admits():
            return None
        try:
            made = self._link.ask_within(self._timeout, "/decisions", item, _made)
        except ServiceUnavailable as error:
            self._failed(error)
            self._wake.set()
            return None
        except ServiceRefusal:
            self._breaker.ended(well=True)
            raise
        if self._breaker.ended(well=True):
            log.warning("study %s: the service is back", self.study)
        return made

    def _failed(self, error: ServiceUnavailable) -> None:
        if self._breaker.ended(well=False):
            log.warning("study %s: choices are made without the service: %s", self.study, error)

    def _offline_choice(self, item: dict[str, Any]) -> Choice:
        user, context, available = item["user"], item.get("context"), item.get("available")
        draws, decision = self._random, uuid.uuid4()
        if "request" in item:  # the same one again gets the same draw, in another process too
            draws = random.Random(json.dumps([self.study, user, item["request"]]))
            decision = uuid.UUID(int=draws.getrandbits(128), version=4)
        source = "table"
        drawn = _drawn(self._users.get((user, context)), available, draws)
        drawn = drawn or _drawn(self._table.get(context, self._table.get(None)), available, draws)
        if drawn is None:
            source, drawn = "fallback", (self._fallback_of(available), 1.0)
        choice = _choice(item, drawn[0], str(decision), drawn[1], source)
        self._offline.put(choice.decision, choice)
        self._count(source)
        return choice

    def _fallback_of(self, available: Sequence[str] | None) -> str:
        """The fallback; if it is not available, the first policy that is."""
        if available is not None and self._fallback not in available:
            return available[0]
        assert self._fallback is not None  # without it there is a table
        return self._fallback

    def _count(self, name: str, more: int = 1) -> None:
        with self._lock:
            self._counts[name] += more

    def _check_usable(self) -> None:
        if self._process != os.getpid():
            raise RuntimeError("the client was made before a fork of the process; make one in each process")
        if self._stopped.is_set():
            raise RuntimeError("the client is closed; make another one")

    def _run(self) -> None:
        """Until the end: fetch the table when it is due, deliver outcomes when there are any."""
        while not self._stopped.is_set():
            try:
                if time.monotonic() >= self._probe_at():
                    self._probe()
                if not self._breaker.is_open and time.monotonic() >= self._deliver_at:
                    self._deliver()
            except Exception:  # a defect in one round must not end all later deliveries
                log.exception("study %s: the client's thread goes on", self.study)
            can_deliver = len(self._queue) and not self._breaker.is_open
            due = min(self._probe_at(), self._deliver_at if can_deliver else math.inf)
            self._wake.wait(max(due - time.monotonic(), 0))
            self._wake.clear()
            self._stopped.wait(LINGER)

    def _probe_at(self) -> float:
        return self._probed_at + (self._breaker.wait if self._breaker.is_open else self._refresh)

    def _probe(self) -> None:
        """Fetch the table; a service that answers may be asked for decisions again."""
        self._probed_at, answered = time.monotonic(), True
        try:
            self._fetch_table()
        except ServiceUnavailable as error:
            self._failed(error)
            answered = False
        except ServiceRefusal as error:
            log.warning("study %s has no table: %s", self.study, error)
        if self._breaker.is_open:
            self._breaker.probed(answered)
            self._delivery_wait = self._deliver_at = 0.0

    def _fetch_table(self) -> None:
        self._table = self._link.ask("GET", "/table", None, PROBE, _table)

    def _deliver(self) -> None:
        """Deliver the oldest outcomes; if the service cannot take them now, they stay in the queue."""
        with self._delivering:
            lines = self._queue.head(BATCH)
            refused: list[str] = []
            try:
                for route, name in (("/outcomes/batch", "decision"), ("/past", "id")):
                    self._post(route, [line for line in lines if name in line], refused)
            except ServiceUnavailable as error:
                self._delivery_wait = min(max(WAITS[0], 2 * self._delivery_wait), WAITS[1])
                self._deliver_at = time.monotonic() + self._delivery_wait
                log.info("study %s: %d outcomes wait: %s", self.study, len(self._queue), error)
                return
            self._queue.pop(len(lines))
        self._delivery_wait = self._deliver_at = 0.0
        self._count("delivered", len(lines) - len(refused))
        self._count("refused", len(refused))
        for message in refused[:3]:
            log.warning("study %s: the service refused an outcome: %s", self.study, message)

    def _post(self, route: str, items: list[dict[str, Any]], refused: list[str]) -> None:
        """Deliver these outcomes; the messages of those that the service refuses are added to `refused`."""
        if not items:
            return
        read = _errors_of(len(items)) if route == "/outcomes/batch" else lambda _: []
        try:
            errors = self._link.ask("POST", route, {"items": items}, PATIENCE, read)
        except ServiceRefusal as error:
            if error.status in (404, 405):  # no such study now: not the fault of the outcomes
                raise ServiceUnavailable(str(error)) from error
            if len(items) > 1:  # one of them breaks a rule: find it by halves
                self._post(route, items[: len(items) // 2], refused)
                self._post(route, items[len(items) // 2 :], refused)
                return
            errors = [("input", str(error))]
        for kind, message in errors:
            if kind in RETRIED:
                raise ServiceUnavailable(message)
            refused.append(message)


def _choice(item: Mapping[str, Any], policy: str, decision: str, probability: float, source: str) -> Choice:
    return Choice(policy, decision, float(probability), source, item["user"], item.get("context"), time.time())


def _drawn(
    probabilities: Mapping[str, float] | None, available: Collection[str] | None, draws: random.Random
) -> tuple[str, float] | None:
    """A policy and its probability among those available; None if none of them has a probability above 0."""
    row = probabilities or {}
    known = {name: p for name, p in row.items() if p > 0 and (available is None or name in available)}
    if not known:
        return None
    (name,) = draws.choices(list(known), list(known.values()))
    return name, known[name] / sum(known.values())


def _row(document: Mapping[str, Any]) -> dict[str, float]:
    """Probabilities by policy, at least one of them above 0."""
    row = {name: float(p) for name, p in document.items()}
    if not (all(0 <= p <= 1 for p in row.values()) and sum(row.values()) > 0):
        raise ValueError(f"probabilities must lie in [0, 1] and not all be 0, got {row}")
    return row


def _made(document: Mapping[str, Any]) -> dict[str, Any]:
    """A decision that the service made, with what a client reads of it."""
    row = document.get("probabilities")
    return {
        "policy": str(document["policy"]), "decision": str(document["decision"]),
        "probability": float(document["probability"]), "probabilities": _row(row) if row else None,
    }  # fmt: skip


def _table(document: Mapping[str, Any]) -> dict[str | None, dict[str, float]]:
    """The probabilities of policies for strangers by context; those of everybody are at None."""
    contexts = {context: _row(row) for context, row in document.get("contexts", {}).items()}
    return {None: _row(document["default"]), **contexts}


def _errors_of(number: int) -> Callable[[Any], list[tuple[str, str]]]:
    """A reader of the answer to a batch of this number: the errors' (kind, message)."""

    def read(document: Mapping[str, Any]) -> list[tuple[str, str]]:
        items = document["items"]
        if len(items) != number:
            raise ValueError(f"{number} items were sent, {len(items)} came back")
        errors = [item["error"] for item in items if "error" in item]
        return [(str(error["kind"]), str(error["message"])) for error in errors]

    return read


class Recent:
    """The last values by key, at most `size` of them."""

    def __init__(self, size: int) -> None:
        self._values: dict[Any, Any] = {}
        self._size, self._lock = size, threading.Lock()

    def get(self, key: Any) -> Any:
        return self._values.get(key)

    def put(self, key: Any, value: Any) -> None:
        with self._lock:
            self._values.pop(key, None)
            self._values[key] = value
            if len(self._values) > self._size:
                del self._values[next(iter(self._values))]

    def drop(self, unwanted: Callable[[Any, Any], bool]) -> None:
        with self._lock:
            self._values = {key: value for key, value in self._values.items() if not unwanted(key, value)}


class _Breaker:
    """Whether calls ask the service: after `FAILURES` in a row none does, and after a good probe a single one."""

    def __init__(self) -> None:
        self._failures, self._try_one, self._lock = 0, False, threading.Lock()
        self.wait = WAITS[0]

    @property
    def is_open(self) -> bool:
        return self._failures >= FAILURES and not self._try_one

    def admits(self) -> bool:
        if self._failures < FAILURES:
            return True
        with self._lock:
            admitted, self._try_one = self._try_one, False
            return admitted

    def ended(self, well: bool) -> bool:
        """Count how a call has ended; whether calls ask the service, or no longer ask it, from here on."""
        with self._lock:
            before, self._failures = self._failures, 0 if well else self._failures + 1
            if well:
                self.wait = WAITS[0]
            return (before >= FAILURES) != (self._failures >= FAILURES)

    def probed(self, answered: bool) -> None:
        """Wait longer for the next probe; if this one was answered, a single call may ask the service."""
        self.wait, self._try_one = min(2 * self.wait, WAITS[1]), answered


class _Queue:
    """Outcomes in the order of their arrival, until they are delivered; in a SQLite file, else in memory."""

    def __init__(self, path: str | os.PathLike[str] | None, capacity: int, fsync: bool) -> None:
        self.path = None if path is None else os.fspath(path)
        self._capacity, self._lock, self._in_memory = capacity, threading.Lock(), path is None
        self._file = _opened(":memory:" if self.path is None else self.path, fsync)
        self._left: sqlite3.Connection | None = None  # a file that could not be written
        self._count()

    def __len__(self) -> int:
        return self._length

    def put(self, line: dict[str, Any]) -> bool:
        """Add an outcome; False if the queue is full."""
        with self._lock:
            if self._length >= self._capacity:
                return False
            self._change("INSERT INTO outcomes (line) VALUES (?)", json.dumps(line), 1)
            return True

    def head(self, most: int) -> list[dict[str, Any]]:
        """The oldest outcomes."""
        with self._lock:
            rows = self._file.execute("SELECT line FROM outcomes ORDER BY number LIMIT ?", [most])
            return [json.loads(line) for (line,) in rows]

    def pop(self, number: int) -> None:
        """Remove the oldest outcomes, which are delivered."""
        oldest = "SELECT number FROM outcomes ORDER BY number LIMIT ?"
        with self._lock:
            self._change(f"DELETE FROM outcomes WHERE number IN ({oldest})", number, -1)

    def forget(self, user: str) -> None:
        """Remove the outcomes of a user whom they name."""
        with self._lock:
            statement = "DELETE FROM outcomes WHERE json_extract(line, '$.user') = ?"
            self._change(statement, user, -1)
            if self._left is not None:
                try:
                    with self._left:
                        self._left.execute(statement, [user])
                except sqlite3.Error as error:
                    log.error("outcomes of a forgotten user stay in the queue's file: %s", error)

    def close(self) -> None:
        with self._lock:
            self._file.close()
            if self._left is not None:
                self._left.close()

    def _count(self) -> None:
        (self._length,) = self._file.execute("SELECT COUNT(*) FROM outcomes").fetchone()

    def _change(self, statement: str, value: Any, sign: int) -> None:
        """Add rows (sign 1) or remove them (-1). What the file cannot take is in memory from here on."""
        try:
            with self._file:
                changed = self._file.execute(statement, [value]).rowcount
            self._length += sign * changed
        except sqlite3.Error as error:
            if self._in_memory:
                raise
            log.error("outcomes are in memory alone, since their file cannot be written: %s", error)
            self._left, self._file, self._in_memory = self._file, _opened(":memory:", fsync=False), True
            try:
                self._left.backup(self._file)  # its outcomes are delivered again after a restart, and count once
            except sqlite3.Error as unread:
                log.error("the outcomes in that file wait for a restart: %s", unread)
            self._count()
            self._change(statement, value, sign)


def _opened(path: str, fsync: bool) -> sqlite3.Connection:
    """The open file of a queue, which no other client can open; what is erased is overwritten."""
    if os.path.exists(path) and not os.path.isfile(path):
        raise ValueError(f"queue must be the path of a file, got {path}")
    try:
        with ExitStack() as failed:
            file = failed.enter_context(closing(sqlite3.connect(path, timeout=0, check_same_thread=False)))
            for pragma in ("locking_mode = EXCLUSIVE", "journal_mode = TRUNCATE", "secure_delete = ON"):
                file.execute(f"PRAGMA {pragma}")
            file.execute(f"PRAGMA synchronous = {'FULL' if fsync else 'OFF'}")
            file.execute("CREATE TABLE IF NOT EXISTS outcomes (number INTEGER PRIMARY KEY, line TEXT NOT NULL)")
            if path != ":memory:":
                os.chmod(path, 0o600)
            failed.pop_all()
            return file
    except sqlite3.Error as error:
        reason = {
            "SQLITE_BUSY": "another client uses it; give each client a file of its own",
            "SQLITE_NOTADB": "it has other content; give a new file",
        }.get(error.sqlite_errorname, error)
        raise ValueError(f"queue {path} cannot be used: {reason}") from None


class _Link:
    """HTTP to one service. Connections stay open; each serves one call at a time."""

    def __init__(self, url: str, prefix: str, token: str | None) -> None:
        parts = urlsplit(url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"url must begin with http:// or https:// and a host, got {url!r}")
        self._class = http.client.HTTPSConnection if parts.scheme == "https" else http.client.HTTPConnection
        self._host, self._port, self._prefix = parts.hostname, parts.port, parts.path.rstrip("/") + prefix
        self._headers = {"Content-Type": "application/json"}
        if token is not None:
            if not (token.isascii() and token.isprintable()):
                raise ValueError("token must be printable ASCII, as `lifelore serve --add-token` prints it")
            self._headers["Authorization"] = f"Bearer {token}"
        self._idle: deque[http.client.HTTPConnection] = deque()
        self._workers, self._closed = ThreadPoolExecutor(MOST_CALLS, "study call"), False

    def ask_within(self, seconds: float, path: str, document: Any, read: Callable[[Any], Any]) -> Any:
        """As `ask`, by POST; the seconds also end an answer that comes slowly."""
        connection = self._connection(seconds)
        answer = self._workers.submit(self._asked, connection, "POST", path, document, read)
        try:
            return answer.result(seconds)
        except TimeoutError:
            answer.cancel()
            with suppress(OSError, AttributeError):  # wakes the worker that waits for it
                connection.sock.shutdown(socket.SHUT_RDWR)
            raise ServiceUnavailable("no answer in time") from None

    def ask(self, method: str, path: str, document: Any, seconds: float, read: Callable[[Any], Any] = dict) -> Any:
        """The document of the answer, read by a function.

        Raises
        ------
        ServiceUnavailable
            Nothing came in these seconds, the answer says to come back later, or it is not the service's.
        ServiceRefusal
            The service says that the request breaks a rule.
        """
        return self._asked(self._connection(seconds), method, path, document, read)

    def close(self) -> None:
        self._closed = True
        self._workers.shutdown(wait=False)
        while self._idle:
            self._idle.pop().close()

    def _connection(self, seconds: float) -> http.client.HTTPConnection:
        """The connection that was used last, or a new one."""
        try:
            connection = self._idle.pop()
        except IndexError:
            return self._class(self._host, self._port, timeout=seconds)
        connection.timeout = seconds
        if connection.sock is not None:
            connection.sock.settimeout(seconds)
        return connection

    def _asked(
        self,
        connection: http.client.HTTPConnection,
        method: str,
        path: str,
        document: Any,
        read: Callable[[Any], Any],
    ) -> Any:
        body = None if document is None else json.dumps(document, allow_nan=False).encode()
        request = method, self._prefix + path, body, self._headers
        try:
            status, content = self._exchange(connection, request)
            answer = json.loads(content)
            if status == 200:
                return read(answer)
            message = str(answer["error"]["message"])
        except (OSError, http.client.HTTPException, ValueError, LookupError, TypeError, AttributeError) as error:
            raise ServiceUnavailable(f"{type(error).__name__}: {error}") from error
        if 400 <= status < 500 and status not in (401, 403, 408, 429):
            raise ServiceRefusal(status, message)
        raise ServiceUnavailable(f"status {status}: {message}")

    def _exchange(self, connection: http.client.HTTPConnection, request: tuple[Any, ...]) -> tuple[int, bytes]:
        """Status and content of the answer. A connection that ended while it was idle is replaced once."""
        was_idle = connection.sock is not None
        try:
            connection.request(*request)
            with closing(connection.getresponse()) as response:
                content = response.read()
        except ConnectionError:
            connection.close()
            if was_idle:
                return self._exchange(connection, request)
            raise
        except BaseException:
            connection.close()
            raise
        if self._closed or len(self._idle) >= MOST_CALLS:
            connection.close()
        else:
            self._idle.append(connection)
        return response.status, content
