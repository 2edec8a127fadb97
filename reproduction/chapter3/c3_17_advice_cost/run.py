"""C3.17: advice given in 100 steps as its cost κ grows, and to Q-learning before and after it has learnt.

The gain of advice has a ceiling in each state, above which no κ can be met, whoever walks there:

    KL[θ, p θ + (1 - p) / 4] ≤ KL[θ, 1/4] = log 4 - H(θ)

Whether the agents of Figure 3.23 followed the advice is not printed. A walk that reaches its goal ends.
Thesis: §3.7.2.3, Figure 3.23.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.figures.style import GREY, Axes
from reproduction.chapter3.advice import mazes
from reproduction.chapter3.advice.learning import learner_schedule
from reproduction.chapter3.advice.mazes import AGENT_COLOURS, AGENT_WORDS, AGENTS, KAPPA, Maze
from reproduction.chapter3.learning.schedules import PRINTED
from reproduction.engine.learning_run import greedy_probs, learnt
from reproduction.engine.records import having
from reproduction.figures.panels import panels

cells = mazes.maze_cells
EARLY, LATE = "q_early", "q_late"
"""Q-learning after one episode, and after all."""


def kappas_of(settings: Mapping) -> list[float]:
    """The values of κ, rising, 0 and the thesis's among them."""
    return sorted({0.0, KAPPA, *settings["kappas"]})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: advised steps in 100 of every agent by κ, for each choice and heeded or not; the walks drawn."""
    maze, kappas = mazes.maze_of(settings, cell, seed), kappas_of(settings)
    policies, amounts, drawn = agent_policies(settings, maze), [], {}
    for choice, heeds in product(mazes.choices_of(settings), settings["heeds"]):
        purposes = mazes.goal_models_of(maze, **choice)
        advisors = [mazes.thesis_advisor(purposes, kappa) for kappa in kappas]
        known = np.array(advisors[0].guide.theta[0].any(axis=1))
        of_agents = {}
        for agent, policy in policies.items():
            if heeds:
                walked = [
                    [w.advised for w in mazes.walks_of(settings, maze, policy, advisor)] for advisor in advisors
                ]
            else:
                alone = mazes.walks_of(settings, maze, policy, advisors[0], heeds=False)
                walked = [[known[w.states] & (w.gain >= kappa) for w in alone] for kappa in kappas]
            of_agents[agent] = [100 * float(np.concatenate(at_kappa).mean()) for at_kappa in walked]
            if not amounts and cell == cells(settings)[0] and agent in AGENTS:
                drawn[agent] = [[100 * float(advised.mean()) for advised in at_kappa] for at_kappa in walked]
        amounts.append(of_agents)
    return {**cell, "amounts": amounts, "drawn": drawn}


def agent_policies(settings: Mapping, maze: Maze) -> dict[str, list]:
    """The policy of each agent on each errand; those of Q-learning as it would go on."""
    found = {agent: mazes.policies_of(settings, maze, agent) for agent in AGENTS}
    for name, episodes in ((EARLY, 1), (LATE, settings["episodes"])):
        schedule = learner_schedule(settings, maze, PRINTED, episodes)
        learners = [
            learnt(errand.tables, (*maze.names, "learner", number), None, schedule)[1]
            for number, errand in enumerate(mazes.errands_of(maze, settings["tasks"]))
        ]
        found[name] = [greedy_probs(learner.q, float(schedule.epsilon[-1])) for learner in learners]
    return found


def _numbers(settings: Mapping, results: Sequence[Mapping], place: int) -> dict[str, Estimate]:
    """The least fall and the largest rise of any agent, and what parts Q-learning from random and optimal."""
    amounts = {
        agent: np.array([result["amounts"][place][agent] for result in results])
        for agent in (*AGENTS, EARLY, LATE)
    }
    at_kappa = {agent: amount[:, kappas_of(settings).index(KAPPA)] for agent, amount in amounts.items()}
    falls = [amount[:, 0] - amount[:, -1] for amount in amounts.values()]
    return {
        "least_fall": mazes.maze_estimate(min(falls, key=np.mean)),
        "largest_rise": mazes.maze_estimate(max(map(steepest_rise, amounts.values()), key=np.mean)),
        "early_minus_random": mazes.maze_estimate(at_kappa[EARLY] - at_kappa["random"]),
        "late_minus_optimal": mazes.maze_estimate(at_kappa[LATE] - at_kappa["optimal"]),
    }


def steepest_rise(amounts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each maze's rise between the two κ where the mean (n_mazes, n_kappas) rises most; 0 where it never does."""
    mean = amounts.mean(axis=0)
    last = int((mean - np.minimum.accumulate(mean)).argmax())
    first = int(mean[: last + 1].argmin())
    return amounts[:, last] - amounts[:, first]


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """How advice falls, its largest rise, Q-learning's two ends: by loops, experts, α⁰ and obedience."""
    heeds = settings["heeds"]
    for reading, loops, place in mazes.readings_of(settings):
        own = having(results, loops=loops)
        for number, heeded in enumerate(heeds):
            yield {**reading, "heeds": heeded}, _numbers(settings, own, place * len(heeds) + number)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Advice by κ to every agent of fixed policy, over the walks of the first maze."""
    return [
        {"curve_of": agent, "mean": np.mean(walks, axis=1).tolist(), "deviation": np.std(walks, axis=1).tolist()}
        for result in results
        for agent, walks in result["drawn"].items()
    ]


@panels(6.4, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """Figure of claim C3.17: the thesis's Figure 3.23, advice in 100 steps by κ.

    The figure from the result: walks of one maze, with one standard deviation.
    """
    kappas = kappas_of(result["settings"])
    for place, row in enumerate(result["rows"]):
        agent, shift = row["curve_of"], 0.004 * kappas[-1] * (place - 2)
        axes.errorbar(
            [kappa + shift for kappa in kappas], row["mean"], row["deviation"], color=AGENT_COLOURS[agent],
            label=AGENT_WORDS[agent], lw=1.5, elinewidth=0.8, marker="o", ms=3,
        )  # fmt: skip
    axes.axvline(KAPPA, color=GREY, lw=0.9, ls=(0, (4, 3)))
    axes.set(xlabel="κ (nats)", ylabel="advised steps in 100", ylim=(0, 104))
    axes.legend()
