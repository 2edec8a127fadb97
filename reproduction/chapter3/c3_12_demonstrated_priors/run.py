"""C3.12: priors from demonstrated trajectories beside self-trained ones, in modified factories.

The thesis's demonstrator was a person. Here people are simulated, each with a skill: the share of steps taken
knowingly. A run draws training factories with lists of components; each is demonstrated once, by the people in
turn, and solved exactly for the self-trained prior. A trajectory counts an action for each visit, a policy its
tied best actions in every state. All priors meet the same factories, lists and random numbers.
A person otherwise acts at random:

    π(a | s) = skill · [a is best in s] / (number of best in s) + (1 - skill) / |A|

Thesis: §3.4.8, Figure 3.16.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.learning.q_learning import Rows
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import checked_best
from lifelore.core.streams import stream
from lifelore.figures.style import BLUE, GREEN, GREY
from reproduction.chapter3.factory import comparison, modified_tasks
from reproduction.chapter3.factory.comparison import UNIFORM
from reproduction.chapter3.factory.figure import one_panel
from reproduction.chapter3.factory.learning import N_ACTIONS, Problem, contexts_of, exact_prior, rows_of
from reproduction.engine.grid import Cell, Grid


def person_policy(best: ArrayLike, skill: float) -> NDArray[np.float64]:
    """Action probabilities of a person, (n_states, n_actions), rows sum to 1; uniform without best action."""
    best = checked_best(best)
    known = best | ~best.any(axis=1, keepdims=True)
    return skill * known / known.sum(axis=1, keepdims=True) + (1 - skill) / best.shape[1]


def simulated_demonstration(
    tables: Tables,
    best: ArrayLike,
    skill: float,
    generator: np.random.Generator,
    *,
    task: str,
    agent: str,
    most_steps: int,
) -> Demonstration | None:
    """One demonstration from a start to the end of the episode; None if it takes more than `most_steps` steps.

    Parameters
    ----------
    tables : Tables
    best : (n_states, n_actions) bool
        Best or tied-best actions.
    skill : float
        In [0, 1]: 0 chooses uniformly, 1 is an expert.
    generator : numpy generator
    task, agent : str
        Names in the demonstration.
    most_steps : int
        Number of steps after which the person gives up, at least 1.
    """
    cum, outcome_cum = np.cumsum(person_policy(best, skill), axis=1), tables.by_pair.outcome_cum
    state = int(generator.choice(tables.starts))
    states, actions = [], []
    for _ in range(most_steps):
        choice, outcome = generator.random(2)
        action = int((choice * cum[state, -1] >= cum[state, :-1]).sum())
        k = int((outcome >= outcome_cum[state, action, :-1]).sum())
        states.append(state)
        actions.append(action)
        if tables.event[state, action, k] & TERMINAL:
            return Demonstration(task, agent, np.array(states, np.int64), np.array(actions, np.int64))
        state = int(tables.next_state[state, action, k])
    return None


SELF, SHOWN = "self-trained", "shown"
METHODS = (UNIFORM, SELF, SHOWN)
PEOPLE = {"familiar": (0.9,), "expert": (1.0,), "varied": (1.0, 0.9, 0.7, 0.5)}
"""Skills of the people who demonstrate, in turn."""
PATIENCE = 4000
"""Steps after which a person gives up."""
PAIRS = {
    "shown_minus_self": (SHOWN, SELF),
    "shown_minus_uniform": (SHOWN, UNIFORM),
    "self_minus_uniform": (SELF, UNIFORM),
}


def grid_of(settings: Mapping) -> Grid:
    """The grid; the self-trained prior does not read who the people are."""
    keys = ("features", "schedule", "people", "ties", "alpha0", "max_steps", "trajectories")
    return comparison.grid_of(settings, keys[:3], keys[3:], {SELF: [key for key in keys if key != "people"]})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method in every cell of the grid."""
    own = (seed, "C3.12", cell["run"])
    training = modified_tasks.problems_of(settings, (*own, "training"), max(settings["trajectories"]))

    @cache
    def shown_by(people: str) -> list[Demonstration | None]:
        return [demonstrate(problem, people, i) for i, problem in enumerate(training)]

    def rows_of_method(method: str, how: Cell) -> Callable[[Problem], Rows]:
        known = training[: how["trajectories"]]
        # Every state of the exact policies counts, or each step of the demonstrations once (Eq. 3.7, 3.3).
        if method == SELF:
            prior = exact_prior(known, how["features"], how["alpha0"])
        else:
            prior = from_shown(known, shown_by(how["people"]), how)
        return lambda problem: rows_of(problem, how["features"], prior.probs, how["ties"])

    return {**cell, **modified_tasks.compared(settings, grid_of(settings), own, METHODS, rows_of_method)}


def demonstrate(problem: Problem, people: str, number: int) -> Demonstration | None:
    """Task `number`, demonstrated by the person whose turn it is; None where that person gives up."""
    skills = PEOPLE[people]
    turn = number % len(skills)
    return simulated_demonstration(
        problem.tables, problem.best, skills[turn], stream(*problem.stream, people, "person"),
        task=str(number), agent=f"person {turn}", most_steps=PATIENCE,
    )  # fmt: skip


def from_shown(known: Sequence[Problem], shown: Sequence[Demonstration | None], how: Cell) -> ActionPrior:
    """The prior from demonstrations of the training tasks; each step counts once (Eq. 3.3)."""
    prior = ActionPrior(N_ACTIONS, how["alpha0"])
    done = [demonstration for demonstration, _ in zip(shown, known, strict=False) if demonstration]
    codes = {one.task: contexts_of(known[int(one.task)], how["features"]) for one in done}
    count_demonstrations(prior, done, lambda one: codes[one.task][one.states])
    return prior


measure, readings, rows = comparison.functions_of(grid_of, METHODS, lambda found, cell: found.shares(cell, PAIRS))


LOOKS = {
    "uniform": ("uniform prior", GREY),
    "shown": ("prior from demonstrations (simulated person)", GREEN),
    "self-trained": ("self-trained prior", BLUE),
}

draw = partial(one_panel, looks=LOOKS)
"""Figure of claim C3.12: learning with priors demonstrated by simulated people, and with self-trained priors."""
