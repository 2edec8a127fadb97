"""Every public class of `interaction` through `pickle` and `copy.deepcopy`: equal bits, then and afterwards.

A class that no maker of `MAKERS` makes, by itself or as a part, and that is not in `NOT_STATE`, fails
`test_every_public_class_is_here`.
"""

import pickle
import pkgutil
from collections import deque
from collections.abc import Callable
from copy import deepcopy
from enum import Enum
from importlib import import_module
from inspect import isclass
from typing import Any

import numpy as np
import pytest

import lifelore.interaction
from lifelore.core.protocols import SignalModel
from lifelore.interaction.adaptation.beat import EPSILONS, Adaptation, Beat
from lifelore.interaction.adaptation.beat_users import BeatUsers
from lifelore.interaction.baselines import baseline, probabilistic_policy_reuse
from lifelore.interaction.baselines.arm_statistics import ArmStatistics
from lifelore.interaction.baselines.clustered_ucb import ClusteredUCB
from lifelore.interaction.baselines.epsilon_greedy_means import EpsilonGreedyMeans
from lifelore.interaction.baselines.exp3 import EXP3
from lifelore.interaction.baselines.gp_ucb import GPUCB
from lifelore.interaction.baselines.interval_estimation import IntervalEstimation
from lifelore.interaction.baselines.thompson import GaussianThompson
from lifelore.interaction.baselines.try_all import TryAll
from lifelore.interaction.baselines.ucb1 import UCB1
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.beliefs.feature_prior import FeaturePrior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.evaluation.clustered_estimate import clustered_estimate
from lifelore.interaction.evaluation.importance_weights import weight_summary
from lifelore.interaction.evaluation.outcome_models import policy_means
from lifelore.interaction.library import storage_cost
from lifelore.interaction.library.offline_runs import run_offline
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.task_types import TaskTypes
from lifelore.interaction.library.user_types import UserTypes
from lifelore.interaction.outcomes import batch_likelihood, outcome_families, outcome_model
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.frame_columns import FrameColumns
from lifelore.interaction.outcomes.moment_outcomes import MomentOutcomes
from lifelore.interaction.outcomes.task_outcomes import SpreadWeights, TaskEvidence, TaskOutcomes
from lifelore.interaction.reuse.novelty import calibration as novelty_calibration
from lifelore.interaction.reuse.novelty import known_tasks
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.calibration import type_calibration
from lifelore.interaction.reuse.outcome_laws import Shown
from lifelore.interaction.reuse.reuse_algorithm import BestResponses, ReuseAlgorithm
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.reuse.user_names import UserNames
from lifelore.interaction.selection import RULES, rule_named
from lifelore.interaction.selection.belief_program import best_plan
from lifelore.interaction.selection.derived_arrays import DerivedArrays
from lifelore.interaction.selection.rule import Deterministic
from lifelore.interaction.selection.signal_rows import SignalRows
from lifelore.interaction.selection.type_classes import type_classes
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.joint_signal import JointSignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal
from lifelore.interaction.signals.ordered_normal_fit import fit_ordered_normals
from lifelore.interaction.signals.ordered_normal_signal import OrderedNormalSignal
from lifelore.interaction.signals.return_signal import ReturnSignal
from lifelore.interaction.signals.reward_signal import RewardSignal
from lifelore.interaction.signals.step_model import StepModel
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal

N_TYPES, N_POLICIES = 3, 4
LAWS = np.random.default_rng(1).dirichlet(np.ones(5), (N_TYPES, N_POLICIES))
STEPS = np.random.default_rng(2).dirichlet(np.ones(2), (N_TYPES, 2, 1))


def samples(n: int = 6) -> np.ndarray:
    random = np.random.default_rng(0)
    means = random.normal(scale=3, size=(N_TYPES, N_POLICIES, 1))
    return np.round(random.normal(means, 1, (N_TYPES, N_POLICIES, n)))


def library(model: str = "gaussian", signal: SignalModel | None = None) -> PolicyLibrary:
    made = PolicyLibrary.from_samples(samples(), model=model, signal=signal, prior=[0.2, 0.5, 0.3])
    if signal is None:
        made.table(8)
    return made


def presses(policy: int, seen: Any) -> np.ndarray:
    """A caller's function, at the top of a module as pickle needs it."""
    return -np.abs(np.arange(N_TYPES) - float(seen) - policy)


def agent(rule: str, **settings: Any) -> BayesianPolicyReuse:
    made = BayesianPolicyReuse(library(), rule_named(rule), seed=4, horizon=30, **settings)
    lives(made)
    return made


def lives(agent: BayesianPolicyReuse) -> list[Any]:
    """Ten episodes with the choices, probabilities and beliefs on the way."""
    seen: list[Any] = []
    for episode in range(10):
        policy = agent.select() if episode % 3 else agent.select([0, 2, 3])
        agent.update(policy, float(np.sin(episode) * 3))
        seen += [policy, agent.probabilities(), agent.log_belief, agent.surprise]
    agent.library.observe(1, 2, 5.0)
    ranked = agent.select_top(3)
    return [*seen, ranked, agent.probabilities([1, 2]), agent.explain().to_dict(), agent.generator.random()]


def sees(signals: list[Any]) -> Callable[[BayesianPolicyReuse], list[Any]]:
    """Episodes of an agent whose signals are given."""

    def asked(agent: BayesianPolicyReuse) -> list[Any]:
        seen: list[Any] = []
        for episode, signal in enumerate(signals * 3):
            policy = agent.select() if episode % 2 else agent.select([1, 2])
            agent.update(policy, signal)
            seen += [policy, agent.probabilities(), agent.log_belief]
        return seen

    return asked


def seeing(model: str, signal: SignalModel | None, signals: list[Any]) -> BayesianPolicyReuse:
    made = BayesianPolicyReuse(library(model, signal), rule_named("sampling"), seed=4)
    sees(signals)(made)
    return made


def users(dtype: Any, model: str = "gaussian", **settings: Any) -> UserBeliefs:
    made = UserBeliefs(library(model), 20, dtype, seed=3, **settings)
    if model == "gaussian":
        serves(made)
    return made


def serves_values(users: UserBeliefs) -> list[Any]:
    """Choices for many users whose outcomes are values of a categorical library."""
    chosen = users.select(np.arange(20), "sampling")
    users.update(np.arange(20), chosen, np.arange(20) % 2 + 0.0)
    return [chosen, users.log_belief.copy(), users.select(np.arange(20), "greedy")]


def serves(users: UserBeliefs) -> list[Any]:
    """Choices for many users and what they teach."""
    seen: list[Any] = []
    for rule in ("sampling", "greedy", "expected-improvement", "information-directed"):
        chosen = users.select(np.arange(20), rule)
        evidence = users.update(np.arange(20), chosen, np.linspace(-3, 3, 20))
        seen += [chosen, evidence, users.log_belief.copy(), users.probabilities([1, 2], rule)]
    return seen


def plays(player: Any) -> list[Any]:
    """Payoffs for a baseline with several tasks."""
    seen: list[Any] = []
    for episode in range(25):
        chosen = player.select()
        player.update(chosen, np.cos(chosen + episode))
        seen.append(chosen)
    return [*seen, player._generator.random()]


def adapts(learner: Beat) -> list[Any]:
    seen: list[Any] = []
    for step in range(12):
        policy = learner.select()
        learner.update(policy, step % 5, step % 5 if learner.actions else None)
        seen += [policy, learner.log_belief.copy()]
    learner.end_episode()
    return seen


def models(model: Any) -> list[Any]:
    """All that rules ask of a model of outcomes, before and after it learns."""
    seen: list[Any] = []
    for value in (2.0, -3.0):
        seen += [model.mean.copy(), model.deviation.copy(), model.log_density(2, value), model.density(value)]
        seen += [model.exceedance(0.5), model.expected_excess(0.5), model.table(4).probs, model.to_arrays()]
        many = model.batch_likelihood()
        rows = np.empty((2, N_TYPES))
        many.write(np.array([1, 3]), many.checked([0.0, 1.0]), rows)
        model.observe(1, 2, value)
        many.write(np.array([2, 2]), many.checked([0.0, 1.0]), rows)
        seen += [rows, model.take([2, 0], [1]).mean]
    return seen


def signals(signal: Any) -> Callable[[Any], list[Any]]:
    def asked(model: Any) -> list[Any]:
        part = model.take([2, 0], [1, 2])
        tables = [model.table(6).probs] if hasattr(model, "table") else []
        return [
            *tables,
            *(model.log_likelihood(policy, signal) for policy in range(2)),
            part.log_likelihood(0, signal),
        ]

    return asked


def scores(rule: Any) -> list[Any]:
    belief = np.random.default_rng(5).dirichlet(np.ones(N_TYPES), 4)
    draws = np.random.default_rng(6)
    return [
        rule.scores(library(), belief, episodes_left=5, generator=draws),
        rule.probabilities(library(), belief),
    ]


def writes(many: Any) -> list[Any]:
    rows = np.empty((2, N_TYPES))
    many.write(np.array([1, 3]), many.checked([0, 2]), rows)
    return [rows]


def normals() -> batch_likelihood.Normals:
    return batch_likelihood.Normals(*(LAWS[..., i].T.copy() for i in range(3)))


def nothing(_: Any) -> list[Any]:
    return []


def kept(name: str) -> Any:
    return deepcopy(getattr(agent("greedy"), name))


def reuser() -> Any:
    reuse = probabilistic_policy_reuse.ProbabilisticPolicyReuse()
    draws = np.random.default_rng
    return reuse.begin(3, np.full((2, 3, 2), 0.5), draws(0), draws(1))


SIZES = storage_cost.StorageSizes(2, 3, 4, 5, 6)
USER_ROWS = outcome_families.UserRows(np.array([0, 1, 1]), np.array([0, 0, 1]), np.array([1.0, 0.0, 1.0]), (2, 2))
COMMON: dict[str, Any] = {"n_tasks": 3, "seed": 2}
BASELINES: dict[type, dict[str, Any]] = {
    EXP3: {"gamma": 0.2}, UCB1: {}, TryAll: {}, IntervalEstimation: {}, EpsilonGreedyMeans: {},
    GaussianThompson: {}, ClusteredUCB: {"clusters": [0, 0, 1, 1]}, GPUCB: {"kernel": np.eye(4), "noise": 0.5},
}  # fmt: skip
SIGNALS: list[tuple[Any, Any]] = [
    (ReturnSignal(library().performance), 1.5),
    (CategorySignal(LAWS), 3),
    (CategorySignal(LAWS, categories=list("abcde")), "d"),
    (OrderedNormalSignal(LAWS[..., 0], LAWS[..., 1] + 0.1, [0.1, 0.3]), 1),
    (RewardSignal(library("categorical").performance), [1.0, 2.0]),
    (TransitionSignal(STEPS), [(0, 1), (1, 1)]),
    (StepRewardSignal([0.0, 5.0], STEPS), [(0, 0, 5.0), (1, 0, 0.0)]),
    (JointSignal([CategorySignal(LAWS), ReturnSignal(library().performance)]), (2, 0.5)),
    (LikelihoodSignal(presses, N_TYPES, N_POLICIES), 1.0),
    (LikelihoodSignal(presses, N_TYPES, N_POLICIES).take([2, 0, 1], [3, 1, 0]), 1.0),
]

CATEGORIES = np.random.default_rng(3).integers(5, size=(N_TYPES, N_POLICIES, 6))
MOVES = np.random.default_rng(4).integers(1, 9, (N_TYPES, 2, 1, 2))
SEEN: list[tuple[str, SignalModel | None, list[Any]]] = [
    ("categorical", None, [0.0, 1.0, 2.0]),
    ("histogram", None, [0.5, -1.5]),
    ("student-t", None, [2.0, -3.0]),
    ("gaussian", CategorySignal.from_samples(CATEGORIES), [0, 3, 1]),
    ("gaussian", TransitionSignal.from_counts(MOVES), [[(0, 1), (1, 1)], [(1, 0)]]),
]
"""Models of outcomes and of signals, learnt from runs, with signals for each."""

Maker = tuple[Callable[[], Any], Callable[[Any], list[Any]]]


def detector(**options: Any) -> NoveltyDetector:
    return NoveltyDetector.calibrate(
        library(**options),
        rule_named("sampling"),
        false_alarm=0.1,
        horizon=3,
        n_tasks=200,
        dynamics=TypeDynamics.static(),
    )


def watches(signal: Any) -> Callable[[NoveltyDetector], Any]:
    def watch(detector: NoveltyDetector) -> Any:
        detector.observe(0, signal)
        return detector.probability, detector.score

    return watch


MAKERS: list[Maker] = [
    *((lambda rule=rule: agent(rule), lives) for rule in RULES),
    (lambda: agent("sampling", dynamics=TypeDynamics.hazard(0.1, [0.2, 0.5, 0.3])), lives),
    (lambda: agent("sampling", novelty=0.05), lives),
    (lambda: BayesianPolicyReuse(library("student-t").take(policies=[0, 1, 2, 3])), lives),
    (lambda: users("f4"), serves),
    (lambda: users("f8", dynamics=TypeDynamics.transitions(np.eye(N_TYPES) * 0.7 + 0.1)), serves),
    *((lambda case=case: seeing(*case), sees(case[2])) for case in SEEN),
    (lambda: users("f4", "categorical"), serves_values),
    (lambda: detector(), watches(4.0)),
    (lambda: detector(signal=CategorySignal(LAWS)), watches(1)),
    *((lambda rule=rule: rule_named(rule), scores) for rule in RULES),
    *((lambda kind=kind, more=more: kind(N_POLICIES, **COMMON, **more), plays)
      for kind, more in BASELINES.items()),
    *((lambda epsilon=epsilon: Beat(library(signal=CategorySignal(LAWS)), epsilon=epsilon, lag=2,
                                    actions=CategorySignal(LAWS)), adapts) for epsilon in (0.2, *EPSILONS)),
    (lambda: BeatUsers(LAWS[..., 0], np.log(LAWS.transpose(1, 2, 0)), 5),
     lambda beat: [beat.update(np.arange(5), np.arange(5) % 4, np.arange(5)), beat.select(np.arange(5), 0.5)]),
    (lambda: Adaptation(2), lambda adaptation: [adaptation.after_step(step // 3) for step in range(9)]),
    *((lambda name=name: library(name).performance, models)
      for name in ("gaussian", "student-t", "histogram", "categorical")),
    *((lambda signal=signal: signal, signals(seen)) for signal, seen in SIGNALS),
    (library, lambda lib: [lib.to_bytes(), lib.table(8).probs, lib.with_type(samples()[0]).to_bytes()]),
    (lambda: ReuseAlgorithm(library()), lambda own: [own.update_row(own.start(), 1, 2.0), own.library.to_bytes()]),
    (lambda: BestResponses(samples()[..., 0], "f8"),
     lambda best: [best.greedy(np.full((4, N_TYPES), 1 / N_TYPES), np.random.default_rng(0))]),
    *((lambda law=law: law, lambda law: [law.step(np.log([0.2, 0.5, 0.3]))])
      for law in (TypeDynamics.static(), TypeDynamics.hazard(0.1, [0.2, 0.5, 0.3]))),
    (lambda: library().table(8), lambda table: [table.probs, type_classes(table).of_type]),
    (lambda: type_classes(library().table(8)), nothing),
    (lambda: batch_likelihood.NormalLikelihood(normals()), writes),
    (lambda: batch_likelihood.TableLikelihood(np.log(LAWS.transpose(1, 2, 0))), writes),
    (lambda: batch_likelihood.CalledLikelihood(library().performance.log_densities), writes),
    (lambda: batch_likelihood.LoopedLikelihood(presses), writes),
    (normals, nothing),
    (lambda: library().performance.moments, lambda found: [found.observe(0, 1, 3.0), found.to_arrays()]),
    (lambda: outcome_model.rows_of_samples(samples(), samples() ** 2 + 1), lambda rows: [rows.sums()]),
    (lambda: USER_ROWS, lambda rows: [rows.sums()]),
    *((lambda family=family: family(USER_ROWS), lambda own: [own.fit(np.full((2, 2), 0.5))])
      for family in outcome_families.FAMILIES.values()),
    (lambda: ArmStatistics.from_prior(2, 3, [1, 2, 3], 4),
     lambda arms: [arms.add(np.array([0, 2]), np.array([5.0, 1.0])), arms.mean, arms.squares]),
    (lambda: baseline.library_moments(library()), nothing),
    (lambda: probabilistic_policy_reuse.ProbabilisticPolicyReuse(reuse=0.5), nothing),
    (reuser, nothing),
    (lambda: probabilistic_policy_reuse.ReuseRule(0.1, 1.0, 0.9, 1.0), nothing),
    (lambda: FeaturePrior.fit(samples()[0], np.arange(4) % 3, [0.2, 0.5, 0.3]),
     lambda own: [own.prior(np.ones(6))]),
    (lambda: update(log_prior([0.5, 0.5]), np.log([0.1, 0.3])), nothing),
    (lambda: run_offline([1.0, 2.0], [3.0], lambda kind, g: [kind], lambda policy, task, g: policy * task),
     nothing),
    (lambda: TaskTypes(0.5, np.array([0, 1]), np.array([0, 1]), np.eye(2, dtype=bool)),
     lambda own: [own.type_prior()]),
    (lambda: UserTypes(np.eye(2), np.full(2, 0.5), (1.0, 2.0)), lambda own: [own.labels]),
    (lambda: SIZES, nothing),
    (lambda: storage_cost.storage_cost(SIZES), nothing),
    (lambda: best_plan(library(), 2), nothing),
    (lambda: kept("_evidence")[-1], nothing),
    (lambda: agent("greedy").explain(), lambda own: [own.to_dict()]),
    (lambda: agent("greedy").select_top(1)[0], nothing),
    (lambda: type_calibration(np.eye(3), np.arange(3)), lambda own: [own.to_dict()]),
    (lambda: library().for_task().evidence.evidence(1, 2.0, np.log(np.full(3, 1 / 3)), None), nothing),
    (lambda: users("f8").outcomes.tried(np.arange(3)), nothing),
    (lambda: UserNames(["ada", "ben"]), lambda own: [own.add(["carl"]), *own]),
    (lambda: SignalRows(np.full((3, 8), 0.5, np.float32), 4, 2), nothing),
    (lambda: fit_ordered_normals(np.ones((2, 2, 3)), None, 5.0), nothing),
    (lambda: clustered_estimate(1.0, np.array([0.5, -0.5]), [0, 1]), nothing),
    (lambda: weight_summary(np.array([0.5, 2.0]), [0, 1]), lambda own: [own.to_dict()]),
    (lambda: policy_means(np.arange(4.0), np.arange(4) % 2, 2, np.array([0, 0, 1, 1])),
     lambda own: [own.of_policies(1)]),
]  # fmt: skip

NOT_STATE = {
    batch_likelihood.BatchLikelihood: "a base; its kinds are here",
    CountedOutcomes: "a base",
    MomentOutcomes: "a base",
    StepModel: "a base",
    Deterministic: "a base",
    baseline.Baseline: "a base",
    FrameColumns: "reads the caller's table and is thrown away",
    TaskOutcomes: "a base",
    SpreadWeights: "a base",
    TaskEvidence: "numbers of a call",
    DerivedArrays: "a cache of the module",
    novelty_calibration.Watched: "tasks that were played within `calibrate`",
    known_tasks.CountedTasks: "tasks drawn within `calibrate`",
    known_tasks.NormalTasks: "tasks drawn within `calibrate`",
    Shown: "a view of `UserOutcomes` within a call",
}


def public_classes() -> set[type]:
    found: set[type] = set()
    for module in pkgutil.walk_packages(lifelore.interaction.__path__, "lifelore.interaction."):
        for name, one in vars(import_module(module.name)).items():
            if isclass(one) and one.__module__ == module.name and not name.startswith("_"):
                found.add(one)
    return {one for one in found if not getattr(one, "_is_protocol", False)}


def test_every_public_class_is_here():
    made: set[type] = set()
    for make, _ in MAKERS:
        add_kinds(make(), made, set())
    missing = public_classes() - made - set(NOT_STATE)
    assert sorted(one.__qualname__ for one in missing) == []


def add_kinds(value: Any, kinds: set[type], seen: set[int]) -> None:
    """Add the classes of an object and of all its parts."""
    if id(value) in seen or isclass(value):
        return
    seen.add(id(value))
    kinds.add(type(value))
    parts = list(getattr(value, "__dict__", {}).values())
    if isinstance(value, list | tuple | deque | set | frozenset):
        parts += value
    elif isinstance(value, dict):
        parts += value.values()
    for part in parts:
        add_kinds(part, kinds, seen)


def state(value: Any, seen: dict[int, int] | None = None) -> Any:
    """All of an object's state as plain comparable data, arrays as their bytes; shared parts as references."""
    seen = {} if seen is None else seen
    if isinstance(value, str | bytes | int | float | complex | type(None) | Enum | np.generic):
        return repr(value)
    if id(value) in seen:
        return f"part {seen[id(value)]}"
    seen[id(value)] = len(seen)
    if isinstance(value, np.ndarray):
        return str(value.dtype), value.shape, np.ascontiguousarray(value).tobytes()
    if isinstance(value, np.random.Generator):
        return state(value.bit_generator.state, {})
    if isinstance(value, dict):
        return [(state(key, seen), state(own, seen)) for key, own in value.items()]
    if isinstance(value, list | tuple | deque | set | frozenset):
        return [type(value).__name__, *(state(own, seen) for own in value)]
    if isclass(value) or (callable(value) and not hasattr(value, "__dict__")):
        return repr(value)
    if hasattr(value, "__self__"):
        return value.__name__, state(value.__self__, seen)
    if callable(value) and hasattr(value, "__qualname__"):
        return f"{value.__module__}.{value.__qualname__}"
    if hasattr(value, "func"):
        return state(value.func, seen), state(value.args, seen)
    return type(value).__qualname__, state(vars(value), seen)


WAYS: dict[str, Callable[[Any], Any]] = {
    **{f"pickle {protocol}": lambda one, protocol=protocol: pickle.loads(pickle.dumps(one, protocol))
       for protocol in (2, pickle.HIGHEST_PROTOCOL)},
    "deepcopy": deepcopy,
}  # fmt: skip


@pytest.mark.parametrize("way", sorted(WAYS))
@pytest.mark.parametrize("number", range(len(MAKERS)), ids=lambda number: f"{number}")
def test_a_copy_is_equal_and_does_the_same(number, way):
    make, use = MAKERS[number]
    first = make()
    before = state(first)
    second = WAYS[way](first)
    assert type(second) is type(first)
    assert state(second) == before
    expected = use(first)
    assert state(use(second)) == state(expected)


def test_using_a_copy_leaves_the_first_as_it_was():
    for make in (lambda: agent("sampling"), lambda: users("f8")):
        first = make()
        before = state(first)
        (lives if isinstance(first, BayesianPolicyReuse) else serves)(deepcopy(first))
        assert state(first) == before


def test_a_copied_agent_learns_with_the_library_that_was_copied_with_it():
    """Its likelihood is of the arrays that `observe` changes in place, as in the agent that was copied."""
    first = BayesianPolicyReuse(library())
    second = pickle.loads(pickle.dumps(first))
    for one in (first, second):
        one.library.observe(0, 1, 40.0)
        one.update(1, 3.0)
    assert np.array_equal(first.log_belief, second.log_belief)
    assert second.library.signal.outcomes is second.library.performance


def test_a_callers_lambda_cannot_be_pickled_and_says_so():
    signal = LikelihoodSignal(lambda policy, seen: np.zeros(2), n_types=2)
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(signal)
