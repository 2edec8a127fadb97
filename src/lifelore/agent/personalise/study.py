"""A study: the policy library learnt from a log, how to choose from it, and who is held out.

Each fit, registration or change of a policy stores a new version in the tables of `lifelore.memory.studies`; the
newest counts. Nothing of any single user is in here.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.interaction.beliefs.feature_prior import FeaturePrior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, ReuseAlgorithm
from lifelore.interaction.selection import DEFAULT_RULE, SelectionRule, restored_rule, rule_named
from lifelore.memory import Memory
from lifelore.memory.record_rules import check_name
from lifelore.memory.studies import ARCHIVED, StudyVersion
from lifelore.memory.study_rows import StudyRows, UserRow

LEARNT: Literal["learnt"] = "learnt"
Change = float | Literal["learnt"]
"""How often the types of users change, see `Study`."""
ACTIVE, PILOT, RETIRED = "active", "pilot", "retired"
"""A policy is chosen from; or given to the control group alone, till a fit knows it; or given to nobody."""
LONGEST_NAME = 60
EARLIER = "earlier user "
ADAPTATION = "adapt/"
"""Beginning of the names in memory of adaptations, which no study has."""
MODELS = ("uncertain", "plug-in")
"""Whether models of few runs are known to be uncertain, or taken for the truth."""
NAMED_TYPE = 0.99
"""Belief in the type that a log names for a user; at 1, no outcome could correct a wrong name."""
CHOOSING = ("control", "incumbent", "rule", "explore", "change", "models")
"""Settings that say how a study chooses."""
SETTINGS = (*CHOOSING, "fitted", "earlier")
"""Settings that are stored as they are."""


@dataclass(frozen=True, eq=False)
class Study:
    """Everything that a choice needs and that is no user's own.

    Parameters
    ----------
    name : str
    library : PolicyLibrary
        Of all policies the log has outcomes of, retired ones too: they are evidence.
    states : dict of str to str
        What each policy is: ``active``, ``pilot`` or ``retired``.
    contexts : dict of str to (n_types,) float64
        Prior over types of users of a context.
    feature_prior : FeaturePrior, optional
        Prior over types from numbers that are known of a user beforehand.
    control : float
        Share of users held out, in [0, 1).
    incumbent : str, optional
        What the held out get; default each policy with equal probability.
    rule : str
        Name of the selection rule.
    explore : float
        Share of the others' choices that are any active policy, in [0, 1].
    change : float or "learnt"
        Probability that a user's type is drawn anew before the next choice, in [0, 1]; at 0 types are static.
        "learnt" is a belief over such probabilities for each user.
    models : {"uncertain", "plug-in"}
        As for `BayesianPolicyReuse`.
    fitted : dict
        What it was learnt from, plain data.
    rule_settings : dict
        Settings of the rule by name; its defaults for those left out.
    number, version : int
        Of the study in the tables of memory, and of what is stored there; 0 before it is kept.
    archived : bool
        Whether the study takes no more decisions.
    earlier : bool
        Whether an earlier Lifelore made it, so that it may have users whose names are not known.
    """

    name: str
    library: PolicyLibrary
    states: dict[str, str]
    contexts: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    control: float = 0.1
    incumbent: str | None = None
    rule: str = DEFAULT_RULE
    explore: float = 0.0
    change: Change = LEARNT
    models: str = "uncertain"
    fitted: dict[str, Any] = field(default_factory=dict)
    rule_settings: dict[str, Any] = field(default_factory=dict)
    feature_prior: FeaturePrior | None = None
    number: int = 0
    version: int = 0
    archived: bool = False
    earlier: bool = False

    def __post_init__(self) -> None:
        check_study_name(self.name)
        _check_share("control", self.control, below_one=True)
        _check_share("explore", self.explore)
        _check_change(self.change)
        rule_named(self.rule, **self.rule_settings)
        if self.models not in MODELS:
            raise InputError(f"models must be one of {', '.join(MODELS)}, got {self.models!r}")
        if self.incumbent is not None and self.states.get(self.incumbent) != ACTIVE:
            raise NotFoundError(
                f"incumbent must be a policy in use, got '{self.incumbent}'; there are {', '.join(self.active)}"
            )

    @cached_property
    def active(self) -> list[str]:
        """Policies chosen from, in the library's order."""
        return [policy for policy in self.library.policies if self.states[policy] == ACTIVE]

    @cached_property
    def pilots(self) -> list[str]:
        """Policies that the control group alone gets, by name."""
        return sorted(policy for policy, state in self.states.items() if state == PILOT)

    @cached_property
    def active_numbers(self) -> list[int]:
        """Numbers of the active policies in the library."""
        return [self.library.index_of_policy(policy) for policy in self.active]

    @cached_property
    def selection(self) -> SelectionRule:
        """The selection rule."""
        return rule_named(self.rule, **self.rule_settings)

    @cached_property
    def dynamics(self) -> Dynamics:
        """How types change."""
        if isinstance(self.change, str):
            return TypeDynamics.learnt()
        return TypeDynamics.hazard(self.change, self.library.prior) if self.change else TypeDynamics.static()

    @cached_property
    def algorithm(self) -> ReuseAlgorithm:
        """Algorithm 7 with this library; `new_rows` gives users rows of their own."""
        return ReuseAlgorithm(self.library, dynamics=self.dynamics, models=self.models)  # pyright: ignore

    @property
    def choosing(self) -> dict[str, Any]:
        """The settings that say how it chooses, by name."""
        return {name: getattr(self, name) for name in CHOOSING}

    def expected(self, policy: str) -> float | None:
        """Expected outcome of a policy for a user of whom nothing is known; None where the library lacks it."""
        if policy not in self.library.policies:
            return None
        return float(self.library.prior @ self.library.performance.mean[:, self.library.index_of_policy(policy)])

    @property
    def best_single(self) -> str:
        """The policy in use that is expected to serve all users best, by the users of the fit alone."""
        return max(self.active, key=lambda policy: self.expected(policy) or 0.0)

    def prior_of(
        self, context: str | None, features: Mapping[str, float] | None = None, type_: str | None = None
    ) -> NDArray[np.float64]:
        """Prior over types, (n_types,): by features, else that of a known context, else everybody's.

        Features count where the study has learnt from just these; those of an earlier fit may be others. Of a
        user whose type a log names, that type has `NAMED_TYPE`.
        """
        if self.feature_prior is not None and features and set(features) == set(self.feature_prior.names):
            prior = self.feature_prior.prior(features)
        else:
            prior = self.contexts.get(context or "", self.library.prior)
        if type_ not in self.library.types:
            return prior
        named = np.zeros(len(prior))
        named[self.library.types.index(type_)] = NAMED_TYPE
        return named + (1 - NAMED_TYPE) * prior

    def holds_out(self, user: str) -> bool:
        """Whether a user is of the control group: decided by the two names, so the same for ever and everywhere.

        A larger share holds out the same users and more.
        """
        return bool(self.held_out([user])[0])

    def held_out(self, users: Sequence[str]) -> NDArray[np.bool_]:
        """`holds_out` for each of many users, (n_users,)."""
        return shares_of((self.name,), users) < self.control if self.control else np.zeros(len(users), bool)

    def with_state(self, policy: str, state: str) -> "Study":
        """The study with another state of one policy."""
        return replace(self, states={**self.states, policy: state})

    def keep(self, memory: Memory) -> "Study":
        """The study as stored, the newest in memory; a new version if more has changed than policies' states."""
        about = {name: getattr(self, name) for name in SETTINGS} | {
            "states": self.states,
            "contexts": {context: prior.tolist() for context, prior in self.contexts.items()},
            "rule_settings": asdict(self.selection),  # pyright: ignore[reportArgumentType]
            "feature_prior": None if self.feature_prior is None else self.feature_prior.to_dict(),
        }
        stored = memory.studies.keep(self.name, about, self.library.to_bytes(), free=("states",))
        return replace(self, number=stored.number, version=stored.version)


def shares_of(words: Sequence[object], *columns: Sequence[object]) -> NDArray[np.float64]:
    """A number in [0, 1) for each row of columns, drawn by the words and the row, the same for ever."""
    start = "".join(f"{word}\x1f" for word in words)
    rows = columns[0] if len(columns) == 1 else ("\x1f".join(map(str, row)) for row in zip(*columns, strict=True))
    digests = [hashlib.sha256(f"{start}{row}".encode()).digest() for row in rows]
    return np.frombuffer(b"".join(digests), ">u8")[::4] / 2.0**64


def user_key(study: str, user: str) -> str:
    """16 hexadecimal digits that stand for a user of a study."""
    if user.startswith(EARLIER):
        return user.removeprefix(EARLIER)
    return hashlib.sha256(f"{study}\x1f{user}".encode()).hexdigest()[:16]


def earlier_name(key: str) -> str:
    """The name of a user of whom an earlier Lifelore stored the `user_key` alone."""
    return EARLIER + key


def known_users(
    rows: StudyRows, study: Study, names: Sequence[str], *, lock: bool = False, count: bool = False
) -> dict[str, UserRow]:
    """`StudyRows.users`; users of whom only the key is known are found too, and with `lock` get their names."""
    users = rows.users(names, lock=lock, count=count)
    if study.earlier and len(users) < len(names):
        keys = {earlier_name(user_key(study.name, name)): name for name in names if name not in users}
        found = rows.users(list(keys), lock=lock, count=count)
        if found and lock:
            rows.rename({user.number: keys[own] for own, user in found.items()})
        users |= {keys[own]: user._replace(name=keys[own]) for own, user in found.items()}
    return users


def open_study(memory: Memory, name: str = "default") -> Study:
    """Open the study of a name.

    Raises
    ------
    NotFoundError
        There is none; the message names those there are.
    StoreError
        It is damaged.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore import PolicyLibrary, open_memory
    >>> from lifelore.agent.personalise.registration import register
    >>> library = PolicyLibrary.from_means([[8.0, 2.0], [3.0, 9.0]], 1.0, policies=["calm", "jazz"])
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/songs.db") as memory:
    ...     study = register(memory, "songs", library)
    ...     open_study(memory, "songs").active == study.active
    True
    """
    check_study_name(name)
    found = newest_version(memory, name)
    if found is None:
        _refuse_unknown(memory, name)
    return study_of(name, found)


def newest_version(memory: Memory, name: str) -> StudyVersion | None:
    """The newest version of a study, which need not be readable; None where there is no such study."""
    found = memory.studies.newest(name)
    if found is None:
        from lifelore.agent.personalise.earlier_studies import take_earlier

        found = memory.studies.newest(name) if take_earlier(memory, name) else None
    return found


def states_after(policies: Sequence[str], earlier: Mapping[str, str]) -> dict[str, str]:
    """The state of each policy where a study gets a library with `policies` in place of an earlier one.

    A retired policy stays so. What the library does not know cannot be chosen: it is retired, unless it still
    waits for its first outcomes.
    """
    known = {policy: RETIRED if earlier.get(policy) == RETIRED else ACTIVE for policy in policies}
    gone = {policy: state for policy, state in earlier.items() if policy not in known}
    return known | {policy: PILOT if state == PILOT else RETIRED for policy, state in gone.items()}


def study_of(name: str, found: StudyVersion) -> Study:
    """The study of a stored version; StoreError where it is damaged."""
    about = found.about
    try:
        library = PolicyLibrary.from_bytes(found.content, f"study '{name}'")
        learnt = about["feature_prior"]
        feature_prior = None if learnt is None else FeaturePrior.from_dict(learnt)
    except InputError as error:
        raise StoreError(f"{error}; fit the study anew") from None
    return Study(
        name,
        library,
        dict(about["states"]),
        {context: np.array(prior) for context, prior in about["contexts"].items()},
        **{key: about[key] for key in SETTINGS},
        rule_settings=asdict(restored_rule(about["rule"], about["rule_settings"])),  # pyright: ignore
        feature_prior=feature_prior,
        number=found.number,
        version=found.version,
        archived=found.state == ARCHIVED,
    )


def study_states(memory: Memory) -> dict[str, str]:
    """The state of each study, "active" or "archived", by its name."""
    from lifelore.agent.personalise.earlier_studies import earlier_studies

    states = memory.studies.states().items()
    named = {name: state for name, state in states if not name.startswith(ADAPTATION)}
    return dict.fromkeys(earlier_studies(memory), ACTIVE) | named


def check_study_name(name: str) -> str:
    """`name` itself, if it can name a study."""
    check_name("name", name)
    if len(name) > LONGEST_NAME or "/" in name:
        raise InputError(f"name must be at most {LONGEST_NAME} characters without '/', got {name[:80]!r}")
    return name


def _refuse_unknown(memory: Memory, name: str) -> NoReturn:
    known = ", ".join(sorted(study_states(memory)))
    other = ", or say which with --name" if known else ""
    raise NotFoundError(
        f"no study '{name}' in {memory.location}; known: {known or 'none'}. Begin with 'lifelore reuse fit'{other}"
    )


def _check_change(change: Change) -> None:
    if change == LEARNT:
        return
    if isinstance(change, str):
        raise InputError(f"change must be {LEARNT!r} or a probability, got {change!r}")
    _check_share("change", change)


def _check_share(name: str, share: float, below_one: bool = False) -> None:
    if not 0 <= share <= 1 or (below_one and share == 1):
        raise InputError(f"{name} must lie between 0 and 1{', 1 left out' if below_one else ''}, got {share}")
