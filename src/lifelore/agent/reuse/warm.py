"""The verb `reuse warm`: users who came after the fit get a past, from logs; each line counts once.

A log is recognised by its content. The same log again changes nothing. A log that has grown since adds its new
lines. A log that was changed in place is refused, because its lines cannot be told from those that are there.
"""

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.history import open_history, user_key
from lifelore.agent.reuse.log import ReadFile, ReuseLog, read_log
from lifelore.agent.reuse.log_format import LogFormat
from lifelore.agent.reuse.past import ATTEMPTS, FedFile, Past, PastUser, read_past, too_busy
from lifelore.agent.reuse.study import Study
from lifelore.core.errors import InputError
from lifelore.memory import Memory


def warm(sources: Any, memory: Memory, study: Study, form: LogFormat | None = None) -> dict[str, Any]:
    """Add the lines of logs to the past of their users; the library stays as it is.

    Parameters
    ----------
    sources : sequence of paths or tables, or a table
        As `read_log` takes them.

    Returns
    -------
    dict
        ``study``; ``rows`` added, of ``users``; ``known``: rows that are in the past already; ``decisions``:
        rows left out because memory has them as decisions; ``unknown_policies``: rows added whose policy the
        library does not know, which give no evidence; ``unknown_types``: users whose type it does not know;
        ``pending``, ``filled_outcomes``, ``filled_policies``, ``without_policy`` (see `ReuseLog`).

    Raises
    ------
    InputError, NotFoundError
        A log breaks a rule, or was fed before with other lines; memory is as it was.
    """
    log = read_log(sources, form)
    own = _own_decisions(memory, study, log)
    for _ in range(ATTEMPTS):
        past = read_past(memory, study.name)
        numbers = _numbers(past, log.files)
        last = np.array([past.files[number].last_line if number in past.files else -1 for number in numbers])
        new = ~own & (log.line > last[log.file])
        rows = np.flatnonzero(new)
        if not rows.size or _added(past, study.name, log, rows, numbers, "warm").keep(memory, study.name):
            return _document(study, log, rows, own)
    raise too_busy(memory)


def keep_fitted_past(memory: Memory, study: Study, log: ReuseLog) -> None:
    """Make the past that of the fit's logs, and of those warm logs that are not among them."""
    own = _own_decisions(memory, study, log)
    rows, own_rows = np.flatnonzero(~own), np.flatnonzero(own)
    own_pairs = set(zip(log.user.codes[own_rows].tolist(), log.file[own_rows].tolist(), strict=True))
    for _ in range(ATTEMPTS):
        past = read_past(memory, study.name)
        gone = {number for number, fed in past.files.items()
                if fed.by == "fit" or any(_is_start(fed, file) for file in log.files)}  # fmt: skip
        past = past.without_files(gone)
        first = max(past.files, default=-1) + 1
        numbers = list(range(first, first + len(log.files)))
        past = _added(past, study.name, log, rows, numbers, "fit")
        # The fit has read these users' decisions too; as outcomes they count once, from memory.
        for user, file in own_pairs:
            known = past.users.setdefault(user_key(study.name, log.user.names[user]), PastUser())
            known.rows.setdefault(numbers[file], [])
        if past.keep(memory, study.name):
            return
    raise too_busy(memory)


def _own_decisions(memory: Memory, study: Study, log: ReuseLog) -> NDArray[np.bool_]:
    """Which rows memory has as decisions, as in a log that `reuse report` wrote, (n,)."""
    own = np.zeros(len(log), bool)
    named = np.array([bool(name) for name in log.decision.names], bool)[log.decision.codes]
    known: dict[int, set[str]] = {}
    for row in np.flatnonzero(named).tolist():
        user = int(log.user.codes[row])
        if user not in known:
            history = open_history(memory, study, user_key(study.name, log.user.names[user]))
            known[user] = {history.identifier(one) for one in history.decisions}
        own[row] = log.decision.names[log.decision.codes[row]] in known[user]
    return own


def _numbers(past: Past, files: Sequence[ReadFile]) -> list[int]:
    """The number of each file in the past, a new one where it is not there."""
    numbers: list[int] = []
    for file in files:
        new = max([*past.files, *numbers], default=-1) + 1
        numbers.append(_number_of(past, file, new))
    return numbers


def _number_of(past: Past, file: ReadFile, new: int) -> int:
    """The number of a file in the past, or `new`.

    Raises
    ------
    InputError
        The file was fed before, with lines that it has no more.
    """
    for number, fed in past.files.items():
        if _is_start(fed, file):
            return number
    for fed in past.files.values():
        if fed.path == file.path:
            raise InputError(
                f"log '{file.path}' was read before with other lines; put the new lines into a log of their own, "
                "or fit anew"
            )
    return new


def _is_start(fed: FedFile, file: ReadFile) -> bool:
    """Whether a file begins with all lines of one that was fed."""
    if fed.size > file.size:
        return False
    if fed.size == file.size:
        return fed.digest == file.digest
    content = Path(file.path).read_bytes() if file.content is None else file.content
    ends = content[fed.size - 1 : fed.size] == b"\n" or content[fed.size : fed.size + 1] in (b"\n", b"\r")
    return ends and hashlib.sha256(content[: fed.size]).hexdigest() == fed.digest


def _added(
    past: Past, study: str, log: ReuseLog, rows: NDArray[np.int64], numbers: Sequence[int], by: str
) -> Past:
    """The past with some rows of a log."""
    order = rows[np.argsort(log.user.codes[rows], kind="stable")]
    users, starts = np.unique(log.user.codes[order], return_index=True)
    policies, outcomes = log.policy.names, log.outcomes.tolist()
    codes, files = log.policy.codes.tolist(), log.file.tolist()
    for user, own in zip(users.tolist(), np.split(order, starts[1:]), strict=True):
        known = past.users.setdefault(user_key(study, log.user.names[user]), PastUser())
        if log.type_of_user[user] >= 0:
            known.type = log.type.names[log.type_of_user[user]]
        if log.context_of_user[user] >= 0:
            known.context = log.context.names[log.context_of_user[user]]
        if log.feature_names and not np.isnan(log.features_of_user[user]).any():
            known.features = dict(zip(log.feature_names, log.features_of_user[user].tolist(), strict=True))
        for row in own.tolist():
            known.rows.setdefault(numbers[files[row]], []).append((policies[codes[row]], outcomes[row]))
    for number, file in zip(numbers, log.files, strict=True):
        kind = past.files[number].by if number in past.files else by
        past.files[number] = FedFile(file.path, file.size, file.digest, file.last_line, kind)
    return past


def _document(study: Study, log: ReuseLog, rows: NDArray[np.int64], own: NDArray[np.bool_]) -> dict[str, Any]:
    users = np.unique(log.user.codes[rows])
    types = {log.type.names[place] for place in log.type_of_user[users].tolist() if place >= 0}
    unknown = [policy not in study.library.policies for policy in log.policy.names]
    return {
        "study": study.name,
        "rows": len(rows),
        "users": len(users),
        "known": int((~own).sum()) - len(rows),
        "decisions": int(own.sum()),
        "unknown_policies": int(np.array(unknown)[log.policy.codes[rows]].sum()),
        "unknown_types": sorted(types - set(study.library.types)),
        "pending": log.pending,
        "filled_outcomes": log.filled_outcomes,
        "filled_policies": log.filled_policies,
        "without_policy": log.without_policy,
    }
