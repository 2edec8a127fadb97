"""The cells of C3.4: learnt and hand-made priors in the factory, used in every way that the thesis leaves open.

Measuring and drawing live elsewhere, so that they can change without a new run. Thesis: §3.4.3, Figure 3.7.
"""

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import Rows
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import state_contexts
from lifelore.domains.factory.knowledge import expert_actions, incorrect_actions, invariances
from lifelore.experiments.chapter3.factory_learning import (
    N_ACTIONS,
    Problem,
    exact_prior,
    floor,
    greedy_return,
    hand_made_prior,
    hand_made_rows,
    learn_task,
    learnt_rows,
    problem_of,
    solved,
    tasks_of,
    with_pseudo_count,
)
from lifelore.experiments.chapter3.factory_settings import check_components, check_open, check_sizes
from lifelore.experiments.chapter3.lattice_learning import schedule_of
from lifelore.experiments.engine.curve_blocks import block_means

ADVICE = {"expert": expert_actions, "incorrect": incorrect_actions}
DRAWN = 0
"""The run whose learnt prior is kept for the figure."""


def makes(settings: Mapping) -> list[dict]:
    """The makes of prior: each hand-made one, and the learnt one in each encoding of states."""
    hand_made = [{"prior": name, "encoding": None} for name in ADVICE]
    return hand_made + [{"prior": "learnt", "encoding": encoding} for encoding in settings["encodings"]]


def uses(settings: Mapping) -> list[dict]:
    """The ways to use a prior: α⁰ × ties × schedule of ε."""
    return [
        {"alpha0": alpha0, "ties": ties, "schedule": schedule}
        for alpha0 in settings["alpha0"]
        for ties in settings["ties"]
        for schedule in settings["schedules"]
    ]


def cells(settings: Mapping) -> list[dict]:
    """One cell a run."""
    return [{"run": run} for run in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: training tasks, and one test task learnt in every way."""
    run, k, default = cell["run"], settings["components"], settings["default"]
    training = tasks_of(settings, seed, k, run, settings["training_tasks"])
    components = floor(settings["discount"]).draw_components(stream(seed, "factory", k, run, "test"), k)
    problem = problem_of(settings, components, (seed, "factory", k, run, "test"))
    priors = _priors(settings, training, problem)
    read = {name: with_pseudo_count(prior, default["alpha0"]) for name, prior in priors.items()}
    found = {
        **cell,
        "optimal_return": problem.solved.optimal_return,
        "optimal_reward": problem.solved.optimal_reward,
        "seen": components in training,
        "methods": list(_methods(settings, problem, priors)),
        "masses": _masses(problem, read),
        "unseen": {encoding: _unseen(problem, read[encoding], encoding) for encoding in settings["encodings"]},
    }
    if run == DRAWN:
        found["drawn"] = {"components": components, **_drawn(problem, read[default["encoding"]], default)}
    return found


def _priors(settings: Mapping, training: list[tuple[int, ...]], problem: Problem) -> dict[str, ActionPrior]:
    """Each make by name: encodings, expert, incorrect; a person is as sure as the training tasks make a prior."""
    known = [solved(components, settings["discount"]) for components in training]
    found = {encoding: exact_prior(known, encoding, 1.0) for encoding in settings["encodings"]}
    for name, advice_of in ADVICE.items():
        found[name] = hand_made_prior(advice_of(problem.solved.task), len(training), 1.0)
    return found


def _methods(settings: Mapping, problem: Problem, priors: Mapping[str, ActionPrior]) -> Iterator[dict]:
    """Every make in every use, and Q-learning under every schedule."""
    for schedule in settings["schedules"]:
        how = {"prior": "uniform", "encoding": None, "alpha0": None, "ties": None, "schedule": schedule}
        yield _summary(settings, problem, None, how)
    for make in makes(settings):
        prior = priors[make["encoding"] or make["prior"]]
        for use in uses(settings):
            rows = _rows(problem, with_pseudo_count(prior, use["alpha0"]), make["encoding"], use["ties"])
            yield _summary(settings, problem, rows, {**make, **use})


def _rows(problem: Problem, prior: ActionPrior, encoding: str | None, ties: str) -> Rows:
    if encoding is None:
        return hand_made_rows(problem, prior, ties)
    return learnt_rows(problem, prior, encoding, ties)


def _summary(settings: Mapping, problem: Problem, rows: Rows | None, how: Mapping) -> dict:
    """What is kept of one learner: rewards of an episode, and the return of what it has learnt."""
    curve, learner = learn_task(problem, rows, schedule_of(settings, how["schedule"]))
    rewards, early, last = curve.rewards, settings["early"], settings["last"]
    found = {
        **how,
        "first": float(rewards[0]),
        "early": float(rewards[:early].mean()),
        "last": float(rewards[-last:].mean()),
        "greedy": greedy_return(problem, learner.q),
    }
    if is_default(settings, how):
        found["curve"] = block_means(rewards)
    return found


def is_default(settings: Mapping, how: Mapping) -> bool:
    """Whether a prior is used in the default's way, whatever its make; Q-learning by the schedule alone."""
    keys = ("schedule",) if how["prior"] == "uniform" else ("alpha0", "ties", "schedule")
    return all(how[key] == settings["default"][key] for key in keys)


def _contexts(problem: Problem, name: str) -> NDArray[np.int64]:
    if name in ADVICE:
        return np.arange(problem.tables.n_states)
    return state_contexts(problem.solved.task, name)


def _masses(problem: Problem, priors: Mapping[str, ActionPrior]) -> dict[str, dict]:
    """The mass of each prior on each invariance of §3.4.2, in all states and in those it has counts of."""
    held = invariances(problem.solved.task)
    probs = np.full((problem.tables.n_states, N_ACTIONS), 1 / N_ACTIONS)
    found = {"uniform": {name: one.mass(probs) for name, one in held.items()}}
    for make, prior in priors.items():
        contexts = _contexts(problem, make)
        probs, seen = prior.probs(contexts), ~prior.unseen(contexts)
        found[make] = {name: one.mass(probs) for name, one in held.items()}
        if make not in ADVICE:
            among = {name: one._replace(states=one.states & seen).mass(probs) for name, one in held.items()}
            found[f"{make}, seen"] = {name: mass for name, mass in among.items() if np.isfinite(mass)}
    return found


def _unseen(problem: Problem, prior: ActionPrior, encoding: str) -> dict[str, float]:
    """Shares without counts: of all states in which something is left to do, and of those on an optimal way."""
    unseen = prior.unseen(state_contexts(problem.solved.task, encoding))
    acting = ~problem.solved.task.completed
    return {"all": float(unseen[acting].mean()), "way": float(unseen[problem.solved.way].mean())}


def _drawn(problem: Problem, prior: ActionPrior, default: Mapping) -> dict[str, list]:
    """The prior where nothing is procured and where all is, (n_cells, n_actions) each; None: no counts."""
    task = problem.solved.task
    procured = int(np.flatnonzero((task.stages == 1).all(axis=1))[0])
    found = {}
    for name, configuration in (("raw", 0), ("procured", procured)):
        contexts = state_contexts(task, default["encoding"], [configuration])
        seen = ~prior.unseen(contexts)
        probs = np.round(prior.probs(contexts), 3).tolist()
        found[name] = [row if known else None for row, known in zip(probs, seen, strict=True)]
    return found


def check(settings: Mapping) -> None:
    check_sizes(settings, "runs", "training_tasks", "episodes", "max_steps", "early", "last")
    check_components([settings["components"]])
    check_open(settings)
    for key in ("early", "last"):
        if settings[key] > settings["episodes"]:
            raise InputError(f"{key} must be at most episodes ({settings['episodes']}), got {settings[key]}")
