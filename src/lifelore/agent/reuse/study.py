"""A study: the policy library learnt from a log, how to choose from it, and who is held out; as memory keeps it.

The library travels as the bytes of its file, packed into a record's integers, so it comes back bit for bit. The
newest fit counts. Nothing of any single user is in here.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.log_columns import check_word
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.protocols import Record
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.feature_prior import FeaturePrior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, ReuseAlgorithm
from lifelore.interaction.selection import DEFAULT_RULE, SelectionRule, restored_rule, rule_named
from lifelore.memory import Memory
from lifelore.memory.byte_words import bytes_of, words_of

KIND, VERSION = "reuse_study", 1
LEARNT: Literal["learnt"] = "learnt"
Change = float | Literal["learnt"]
"""How often the types of users change, see `Study`."""
ACTIVE, PILOT, RETIRED = "active", "pilot", "retired"
"""A policy is chosen from; or given to the control group alone, till a fit knows it; or given to nobody."""
LONGEST_NAME = 60
MODELS = ("uncertain", "plug-in")
"""Whether models of few runs are known to be uncertain, or taken for the truth."""


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

    @property
    def robot(self) -> str:
        """Under which name memory keeps it."""
        return f"reuse {self.name}"

    @property
    def active(self) -> list[str]:
        """Policies chosen from, in the library's order."""
        return [policy for policy in self.library.policies if self.states[policy] == ACTIVE]

    @property
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

    @cached_property
    def fingerprint(self) -> str:
        """Hash of the library and the dynamics: of all that turns the evidence of a user into a belief."""
        settings = repr(self.change) if self.models == "plug-in" else repr((self.change, self.models))
        if self.feature_prior is not None:
            settings += repr(self.feature_prior.to_dict())
        return hashlib.sha256(self.library.to_bytes() + settings.encode()).hexdigest()[:32]

    @cached_property
    def policy_names(self) -> dict[int, str]:
        """Each policy's name by the number that stands for it in records."""
        return {policy_number(policy): policy for policy in self.states}

    def expected(self, policy: str) -> float | None:
        """Expected outcome of a policy for a user of whom nothing is known; None where the library lacks it."""
        if policy not in self.library.policies:
            return None
        return float(self.library.prior @ self.library.performance.mean[:, self.library.index_of_policy(policy)])

    @property
    def best_single(self) -> str:
        """The policy in use that is expected to serve all users best, by the users of the fit alone."""
        expected = self.library.prior @ self.library.performance.mean
        return max(self.active, key=lambda policy: expected[self.library.index_of_policy(policy)])

    def prior_of(self, context: str | None, features: Mapping[str, float] | None = None) -> NDArray[np.float64]:
        """Prior over types, (n_types,): by features, else that of a known context, else everybody's.

        Features count where the study has learnt from just these; those of an earlier fit may be others.
        """
        if self.feature_prior is not None and features and set(features) == set(self.feature_prior.names):
            return self.feature_prior.prior(features)
        return self.contexts.get(context or "", self.library.prior)

    def holds_out(self, user: str) -> bool:
        """Whether a user is of the control group: decided by the two names, so the same for ever and everywhere.

        A larger share holds out the same users and more.
        """
        return _control_draw(self.name, user) < self.control

    def explored(self, probs: NDArray[np.float64]) -> NDArray[np.float64]:
        """The rule's probabilities of policies (..., n) with the share of exploration mixed in; rows sum to 1."""
        mixed = (1 - self.explore) * probs + self.explore / probs.shape[-1]
        return mixed / mixed.sum(axis=-1, keepdims=True)

    def with_state(self, policy: str, state: str) -> "Study":
        """The study with another state of one policy."""
        return replace(self, states={**self.states, policy: state})

    def to_record(self) -> Record:
        """What memory keeps."""
        packed = self.library.to_bytes()
        values = words_of(packed)
        about = {
            "study": self.name,
            "bytes": len(packed),
            "states": self.states,
            "contexts": {context: prior.tolist() for context, prior in self.contexts.items()},
            "control": self.control,
            "incumbent": self.incumbent,
            "rule": self.rule,
            "rule_settings": asdict(self.selection),  # pyright: ignore[reportArgumentType]
            "explore": self.explore,
            "change": self.change,
            "models": self.models,
            "fitted": self.fitted,
            "feature_prior": None if self.feature_prior is None else self.feature_prior.to_dict(),
        }
        return Record(KIND, self.name, VERSION, "newest", np.arange(len(values)), values, about)

    def keep(self, memory: Memory) -> None:
        """Make it the newest in memory."""
        # Whoever else writes at the same moment takes the next number.
        seq = memory.tasks(self.robot)
        while not memory.contribute(self.robot, [self.to_record()], process="study", seq=seq, task=_task(self)):
            seq += 1


@lru_cache(maxsize=10_000)
def _control_draw(study: str, user: str) -> float:
    """A number in [0, 1) that is the same for ever; users come again, so the last ones are stored."""
    return stream(0, "reuse control", study, user).random()


@lru_cache(maxsize=10_000)
def policy_number(policy: str) -> int:
    """A number that stands for a policy's name in records, the same in every memory."""
    return int.from_bytes(hashlib.sha256(policy.encode()).digest()[:7], "big")


def open_study(memory: Memory, name: str = "default") -> Study:
    """The study of that name.

    Raises
    ------
    NotFoundError
        There is none; the message names those there are.
    StoreError
        It was kept by a newer Lifelore, or is damaged.
    """
    check_study_name(name)
    record = memory.recall(KIND, name, VERSION)
    if record is None:
        _refuse_unknown(memory, name)
    about: Mapping[str, Any] = record.about
    # Cells beyond the library's are an earlier, larger study's, or a signal table of an earlier Lifelore.
    packed = bytes_of(record.values, about["bytes"])
    try:
        library = PolicyLibrary.from_bytes(packed, f"study '{name}'")
        learnt = about.get("feature_prior")
        feature_prior = None if learnt is None else FeaturePrior.from_dict(learnt)
    except InputError as error:
        raise StoreError(f"{error}; fit the study anew") from None
    contexts = {context: np.array(prior) for context, prior in about["contexts"].items()}
    settings = {key: about[key] for key in ("control", "incumbent", "rule", "explore", "change", "fitted")}
    # A study of an earlier Lifelore has no settings of its rule, and took its models for the truth.
    rule = asdict(restored_rule(about["rule"], about.get("rule_settings", {})))  # pyright: ignore[reportArgumentType]
    models = about.get("models", "plug-in")
    return Study(
        name,
        library,
        dict(about["states"]),
        contexts,
        **settings,
        models=models,
        rule_settings=rule,
        feature_prior=feature_prior,
    )


def study_names(memory: Memory) -> list[str]:
    """Names of the studies in memory, sorted."""
    return sorted(key for key, version, _ in memory.keys(KIND) if version == VERSION)


def check_study_name(name: str) -> str:
    """`name` itself, if it can name a study."""
    check_word("name", name)
    if len(name) > LONGEST_NAME or "/" in name:
        raise InputError(f"name must be at most {LONGEST_NAME} characters without '/', got {name[:80]!r}")
    return name


def _refuse_unknown(memory: Memory, name: str) -> NoReturn:
    newer = [version for key, version, _ in memory.keys(KIND) if key == name and version > VERSION]
    if newer:
        raise StoreError(f"study '{name}' was kept by a newer Lifelore (version {newer[-1]}); update this one")
    known = ", ".join(study_names(memory))
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


def _task(study: Study) -> dict[str, Any]:
    return {"study": study.name, "policies": len(study.states), "types": study.library.n_types}
