"""A panel: very many users of a study, decided and observed in batches by `UserBeliefs`.

Beliefs are held in main memory. Each batch is stored in a journal before it is answered, and the journal gives the
beliefs again after a restart or a new fit of the study. Users of a panel have no history of their own in memory:
`one_user` does not know them. A single program at a time may serve the panel of a study.
"""

import hashlib
import threading
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.agent.personalise.panel_journal import Columns, Entry, PanelJournal
from lifelore.agent.reuse.log_columns import check_word
from lifelore.agent.reuse.study import Study
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.streams import stream
from lifelore.interaction.outcomes.outcome_model import LARGEST
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.memory import Memory

Numbers = NDArray[np.int64]


def drawn(probs: NDArray[np.float64], draws: NDArray[np.float64]) -> Numbers:
    """The policy of each row of probabilities that a number in [0, 1) falls on, (n,), none of probability 0."""
    ends = probs.cumsum(axis=1)
    chosen = (ends <= draws[:, None] * ends[:, -1:]).sum(axis=1)
    last = probs.shape[1] - 1 - (probs[:, ::-1] > 0).argmax(axis=1)
    return np.minimum(chosen, last)


class _Batch:
    """A batch of decisions: rows of users, policies, and which outcomes were observed."""

    def __init__(self, rows: Numbers, entry: Entry) -> None:
        self.rows, self.columns, self.about = rows, entry.columns, entry.about
        self.observed = np.zeros(len(rows), bool)


class Panel:
    """The users of a study whom batches serve.

    Parameters
    ----------
    memory : Memory
    study : Study
    seed : int
        The draws depend on it, on the study, and on the number of the batch.

    Raises
    ------
    StoreError
        The journal names a policy that the study has no outcomes of.
    """

    def __init__(self, memory: Memory, study: Study, seed: int = 0) -> None:
        self.study, self._seed = study, seed
        self._journal, self._lock = PanelJournal(memory, study.name), threading.Lock()
        self._beliefs = UserBeliefs(
            study.library,
            1,
            "f8",
            dynamics=study.dynamics,
            models=study.models,  # pyright: ignore[reportArgumentType]
        )
        self._rows: dict[int, int] = {}
        self._names: dict[str, int] = {}
        self._keys = np.empty(0, np.uint64)
        self._batches: dict[str, _Batch] = {}
        self._requests: dict[str, str] = {}
        for entry in self._journal.entries():
            self._replay(entry)

    @property
    def n_users(self) -> int:
        """Number of users who had a decision."""
        return len(self._rows)

    def decide(
        self,
        users: Sequence[str],
        *,
        available: Sequence[str] | None = None,
        masks: ArrayLike | None = None,
        request: str | None = None,
    ) -> dict[str, Any]:
        """Choose a policy for each of `users`, and store the decisions.

        Parameters
        ----------
        users : sequence of str
            A user may come several times; all decisions are made by the same belief.
        available : sequence of str, optional
            Policies that all of them can get now.
        masks : (n_users, n_policies) bool, optional
            Policies in use that each of them can get now, in the order of `policies` of the answer.
        request : str, optional
            The same request again gets the decisions that it got before.

        Returns
        -------
        dict
            ``batch``, to give the outcomes by; ``policies``, names; for each user ``chosen``, a place in
            ``policies``, its ``probability``, and ``control``; ``repeated``.

        Raises
        ------
        InputError, NotFoundError
            A name or mask breaks its rule; nothing is stored.
        """
        if request is not None:
            check_word("request", request)
        with self._lock:
            if request in self._requests:
                return self._answer(self._requests[request], repeated=True)
            policies = self.study.active
            may = self._available(len(users), policies, available, masks)
            rows = self._rows_of_names(users)
            keys = self._keys[rows]
            probs, control = self._probabilities(keys, rows, may)
            draws = stream(self._seed, "reuse panel", self.study.name, len(self._batches)).random(len(rows))
            chosen = drawn(probs, draws)
            probability = probs[np.arange(len(rows)), chosen]
            columns: Columns = {"policy": chosen, "control": control, "probability": probability}
            name = self._journal.append_decisions(keys, rows, columns, policies=policies, request=request)
            self._take(name, rows, Entry(name, "decisions", {"policies": policies, "request": request}, columns))
            return self._answer(name, repeated=False)

    def observe(
        self, batch: str, outcomes: Sequence[float], places: Sequence[int] | None = None
    ) -> dict[str, int]:
        """Store outcomes of decisions of a batch, each once, and learn from them as they come.

        Parameters
        ----------
        places : sequence of int, optional
            Places of the decisions in the batch, each once; by default all of them in order.

        Returns
        -------
        dict
            ``taken``; ``known``: outcomes that were there before, and changed nothing.

        Raises
        ------
        NotFoundError
            There is no such batch.
        InputError
            An outcome or place breaks its rule; nothing is stored.
        """
        with self._lock:
            if batch not in self._batches:
                raise NotFoundError(f"no batch '{batch[:60]}' in the panel of study '{self.study.name}'")
            own = self._batches[batch]
            values = np.asarray(outcomes, np.float64)
            at = np.arange(len(own.rows)) if places is None else np.asarray(places, np.int64)
            if values.ndim != 1 or at.shape != values.shape:
                raise InputError(f"outcomes must be as many as decisions, {at.size}, got {values.size}")
            if at.size and (at.min() < 0 or at.max() >= len(own.rows) or len(np.unique(at)) < len(at)):
                raise InputError(f"places must be distinct and lie in [0, {len(own.rows)})")
            if not (np.abs(values) <= LARGEST).all():
                raise InputError(f"outcomes must be finite numbers of at most {LARGEST:g} in size")
            new = ~own.observed[at]
            if new.any():
                columns = {"outcome": values[new], "place": at[new]}
                self._learnable(own, columns)
                self._journal.append_outcomes(columns, batch=batch)
                self._learn(own, columns)
            return {"taken": int(new.sum()), "known": int((~new).sum())}

    def belief(self, users: Sequence[str]) -> list[dict[str, float]]:
        """β of each of `users` by type; strangers have the prior."""
        with self._lock:
            rows = [self._rows.get(self._key(user), -1) for user in users]
            start = np.exp(self._beliefs.algorithm.log_prior)
            found = [start if row < 0 else self._beliefs.belief([row])[0] for row in rows]
        return [dict(zip(self.study.library.types, row.tolist(), strict=True)) for row in found]

    def _key(self, user: str) -> int:
        check_word("user", user)
        return int.from_bytes(hashlib.sha256(f"{self.study.name}\x1f{user}".encode()).digest()[:8], "big")

    def _rows_of_names(self, users: Sequence[str]) -> Numbers:
        """Rows of users by name; new users get the next rows, unless a name breaks its rule."""
        if new := [user for user in dict.fromkeys(users) if user not in self._names]:
            rows = self._rows_of(np.array([self._key(user) for user in new], np.uint64))
            self._names.update(zip(new, rows.tolist(), strict=True))
        return np.fromiter(map(self._names.__getitem__, users), np.int64, len(users))

    def _rows_of(self, keys: NDArray[np.uint64]) -> Numbers:
        """Rows of users by key; new users get the next rows."""
        rows = np.fromiter(
            (self._rows.setdefault(key, len(self._rows)) for key in keys.tolist()), np.int64, len(keys)
        )
        if (more := len(self._rows) - self._beliefs.n_users) > 0:
            self._beliefs.add_users(more)
        if len(self._rows) > len(self._keys):
            grown = np.zeros(2 * len(self._rows), np.uint64)
            grown[: len(self._keys)] = self._keys
            self._keys = grown
        self._keys[rows] = keys
        return rows

    def _available(
        self, n: int, policies: list[str], available: Sequence[str] | None, masks: ArrayLike | None
    ) -> NDArray[np.bool_]:
        may = np.ones((n, len(policies)), bool)
        if available is not None:
            for policy in available:
                if policy not in self.study.states:
                    raise NotFoundError(f"available must name policies of the study, got '{policy[:60]}'")
            may &= np.array([policy in available for policy in policies])
        if masks is not None:
            try:
                own = np.asarray(masks, bool)
            except ValueError:
                own = np.empty(0, bool)
            if own.shape != may.shape:
                raise InputError(f"masks must have a row of {len(policies)} values for each user")
            may = may & own
        if not may.any(axis=1).all():
            raise InputError("available and masks must leave every user a policy in use; leave the others out")
        return may

    def _probabilities(
        self, keys: NDArray[np.uint64], rows: Numbers, may: NDArray[np.bool_]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Probability of each policy in use, (n, n_active), and who is of the control group, (n,)."""
        study, library = self.study, self.study.library
        columns = study.active_numbers
        whole = np.zeros((len(rows), library.n_policies), bool)
        whole[:, columns] = may
        mask = None if whole.all() else whole
        probs = self._beliefs.probabilities(rows, study.selection, available=mask)[:, columns]
        even = may / may.sum(axis=1, keepdims=True)
        probs = (1 - study.explore) * probs + study.explore * even
        control = keys / 2.0**64 < study.control
        if control.any():
            held = even
            if study.incumbent is not None:
                place = study.active.index(study.incumbent)
                held = np.where(may[:, place, None], np.arange(len(columns)) == place, even)
            probs = np.where(control[:, None], held, probs)
        return probs / probs.sum(axis=1, keepdims=True), control

    def _answer(self, name: str, *, repeated: bool) -> dict[str, Any]:
        own = self._batches[name]
        return {
            "batch": name,
            "policies": own.about["policies"],
            "chosen": own.columns["policy"].tolist(),
            "probability": own.columns["probability"].astype(np.float32).astype(np.float64).tolist(),
            "control": own.columns["control"].astype(bool).tolist(),
            "repeated": repeated,
        }

    def _replay(self, entry: Entry) -> None:
        if entry.kind == "decisions":
            self._take(entry.name, self._rows_of(entry.columns["user"]), entry)
        elif entry.about["batch"] in self._batches:
            self._learn(self._batches[entry.about["batch"]], entry.columns)

    def _take(self, name: str, rows: Numbers, entry: Entry) -> None:
        self._batches[name] = _Batch(rows, entry)
        if entry.about["request"] is not None:
            self._requests[entry.about["request"]] = name

    def _learnable(self, own: _Batch, columns: Columns) -> None:
        """Raise InputError for an outcome that no type can have."""
        if self.study.library.performance.kind == "categorical":  # pyright: ignore[reportAttributeAccessIssue]
            values = self.study.library.performance.values  # pyright: ignore[reportAttributeAccessIssue]
            if not np.isin(columns["outcome"], values).all():
                raise InputError(f"outcomes must be one of {', '.join(f'{value:g}' for value in values)}")

    def _learn(self, own: _Batch, columns: Columns) -> None:
        at = columns["place"].astype(np.int64)
        names = own.about["policies"]
        library = self.study.library
        numbers = np.array([library.policies.index(name) if name in library.policies else -1 for name in names])
        policies = numbers[own.columns["policy"][at].astype(np.int64)]
        known = policies >= 0
        if not known.all():
            raise StoreError(f"the panel of study '{self.study.name}' has outcomes of policies that no fit knows")
        self._beliefs.update(own.rows[at], policies, columns["outcome"])
        own.observed[at] = True
