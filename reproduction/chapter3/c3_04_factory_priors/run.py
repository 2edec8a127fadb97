"""Cells of C3.4: learnt and hand-made priors in the factory, over the grid of choices that the thesis leaves open.

Thesis: §3.4.3, Figure 3.7.
"""

from collections.abc import Iterator, Mapping

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import state_contexts
from lifelore.domains.factory.knowledge import expert_actions, incorrect_actions, invariances
from reproduction.chapter3.factory import learning
from reproduction.chapter3.factory.learning import KEYS, LEARNT, N_ACTIONS, PLAIN, Problem, contexts_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.curve_blocks import block_means
from reproduction.engine.grid import run_grid

ADVICE = {"expert": expert_actions, "incorrect": incorrect_actions}
"""Actions that a person advises, by name of the hand-made prior."""
STAGES = 40
"""Stages of learning on; the policy learnt is judged after each, so more say more finely when it is learnt."""
DRAWN = 0
"""The run whose learnt prior the figure shows."""


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: training tasks, and one test task learnt with every prior in every cell of the grid."""
    run, k, default = cell["run"], settings["components"], settings["default"]
    training = learning.tasks_of(settings, seed, k, run, settings["training_tasks"])
    components = learning.floor(settings["discount"]).draw_components(stream(seed, "factory", k, run, "test"), k)
    problem = learning.problem_of(settings, components, (seed, "factory", k, run, "test"))
    priors = _priors(settings, training, problem)
    at_default = {name: learning.with_pseudo_count(prior, default["alpha0"]) for name, prior in priors.items()}
    found = {
        **cell,
        "optimal_return": problem.solved.optimal_return,
        "optimal_reward": problem.solved.optimal_reward,
        "seen": components in training,
        "methods": list(_methods(settings, problem, priors)),
        "long": {name: _learnt_on(settings, problem, priors, name) for name in (PLAIN, *ADVICE, LEARNT)},
        "optimistic": _learnt_on(settings, problem, priors, "incorrect", most_earned(problem))["greedy"],
        "masses": _masses(problem, at_default),
        "unseen": {name: _unseen(problem, at_default[name], name) for name in settings["encodings"]},
    }
    if run == DRAWN:
        found["drawn"] = {"components": components, **_drawn(problem, at_default[default["encoding"]], default)}
    return found


def _priors(settings: Mapping, training: list[tuple[int, ...]], problem: Problem) -> dict[str, ActionPrior]:
    """Learnt priors by encoding, and hand-made ones, which count as much as the training tasks."""
    known = [learning.solved(components, settings["discount"]) for components in training]
    found = {encoding: learning.exact_prior(known, encoding, 1.0) for encoding in settings["encodings"]}
    for name, advice_of in ADVICE.items():
        found[name] = learning.hand_made_prior(advice_of(problem.solved.task), len(training), 1.0)
    return found


def _methods(settings: Mapping, problem: Problem, priors: Mapping[str, ActionPrior]) -> Iterator[dict]:
    """Rewards of an episode and the return of the learnt policy, of every prior in every cell of the grid."""
    early, last, default = settings["early"], settings["last"], settings["default"]

    def numbers(name: str, cell: Mapping) -> dict:
        rows = None
        if name != PLAIN:
            prior = learning.with_pseudo_count(priors[cell["encoding"] or name], cell["alpha0"])
            rows = learning.rows_of(problem, prior, cell["encoding"], cell["ties"])
        curve, learner = learning.learn_task(problem, rows, schedule_of(settings, cell["schedule"]))
        rewards = curve.rewards
        shown = all(cell[key] in (None, default[key]) for key in KEYS[1:])
        return {
            "first": float(rewards[0]),
            "early": float(rewards[:early].mean()),
            "last": float(rewards[-last:].mean()),
            "greedy": learning.greedy_return(problem, learner.q),
            **({"curve": block_means(rewards)} if shown else {}),
        }

    yield from run_grid(learning.grid_of(settings, ADVICE), "prior", PLAIN, (*ADVICE, LEARNT), numbers)


def stages_of(settings: Mapping) -> list[int]:
    """Episodes after which a policy learnt on is judged."""
    return np.unique(np.rint(np.linspace(0, settings["long_episodes"], STAGES + 1)[1:])).astype(int).tolist()


def most_earned(problem: Problem) -> float:
    """A bound on the return of any state: every component procured, assembled and completed at once."""
    task = problem.solved.task
    rewards = task.factory.rewards
    return rewards.completion + 2 * len(task.components) * rewards.use


def _learnt_on(
    settings: Mapping, problem: Problem, priors: Mapping[str, ActionPrior], name: str, first_q: float = 0.0
) -> dict:
    """The default's use of a prior over ``long_episodes``: rewards at the end and by stage, and greedy returns."""
    default, rows = settings["default"], None
    if name != PLAIN:
        encoding = default["encoding"] if name == LEARNT else None
        prior = learning.with_pseudo_count(priors[encoding or name], default["alpha0"])
        rows = learning.rows_of(problem, prior, encoding, default["ties"])
    schedule = schedule_of({**settings, "episodes": settings["long_episodes"]}, default["schedule"])
    stages = stages_of(settings)
    curve, greedy = learning.learn_in_stages(problem, rows, schedule, stages, first_q)
    by_stage = [float(part.mean()) for part in np.split(curve.rewards, stages[:-1])]
    return {"last": float(curve.rewards[-settings["last"] :].mean()), "greedy": greedy, "rewards": by_stage}


def _masses(problem: Problem, priors: Mapping[str, ActionPrior]) -> dict[str, dict]:
    """The mass of each prior on each invariance of §3.4.2, in all states and in those it has counts of."""
    held = invariances(problem.solved.task)
    probs = np.full((problem.tables.n_states, N_ACTIONS), 1 / N_ACTIONS)
    found = {"uniform": {name: invariance.mass(probs) for name, invariance in held.items()}}
    for make, prior in priors.items():
        contexts = contexts_of(problem, None if make in ADVICE else make)
        probs, seen = prior.probs(contexts), ~prior.unseen(contexts)
        found[make] = {name: invariance.mass(probs) for name, invariance in held.items()}
        if make not in ADVICE:
            among = {name: i._replace(states=i.states & seen).mass(probs) for name, i in held.items()}
            found[f"{make}, seen"] = {name: mass for name, mass in among.items() if np.isfinite(mass)}
    return found


def _unseen(problem: Problem, prior: ActionPrior, encoding: str) -> dict[str, float]:
    """Shares without counts: of all states in which something is left to do, and of those on an optimal way."""
    unseen = prior.unseen(contexts_of(problem, encoding))
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
