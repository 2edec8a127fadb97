"""C4.16: BEAT is Bayesian policy reuse: the same decisions, step by step, through the general algorithm.

The general algorithm gets ε-greedy selection, the transitions as signal, action sets as policies, and the same
generator. Beside them runs the belief as printed, which is never normalised. Thesis: §4.8.4.2.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import MAX_STEPS, BallGame, draw_sigma
from lifelore.domains.ball_game.moves import read_moves
from lifelore.domains.ball_game.simulated_player import advance, new_balls, random_states
from lifelore.experiments.chapter4.ball_game_play import train
from lifelore.experiments.chapter4.ball_game_settings import DEFAULT, Setting, check_games
from lifelore.experiments.chapter4.c4_16_beat_is_reuse.ball_game_library import library_of, transition_of
from lifelore.experiments.chapter4.diversity_runs import EPISODES
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate
from lifelore.interaction.adaptation.beat import Beat, Exploration, epsilon_of
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy

FULL = {"games": [DEFAULT], "users": 20, "training": 100}
QUICK = {"games": [DEFAULT], "users": 1, "training": 10}
EPSILONS: dict[str, Exploration] = {"0": 0.0, "0.3": 0.3, "1/n": "1/n", "0.5 − 0.1 an episode": "by episode"}


def _check(settings: Mapping) -> None:
    check_games(settings, ("users", "training"))


def cells(settings: Mapping) -> list[dict]:
    """One an ε; each runs users of all types."""
    return [{"game": list(settings["games"][0]), "epsilon": name} for name in EPSILONS]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Sessions of five episodes: decisions, those alike, how far beliefs differ, and when products vanish."""
    setting = Setting(*cell["game"])
    game = setting.game
    trained = train(game, settings["training"], seed)
    library = library_of(game, trained, trained.scale(setting.normalisation))
    sessions = []
    for kind in range(game.n_types):
        for user in range(settings["users"]):
            name = (setting.words, cell["epsilon"], kind, user)
            beat = Beat(library, epsilon=EPSILONS[cell["epsilon"]], seed=stream(seed, "C4.16", *name))
            reuse = BayesianPolicyReuse(library, EpsilonGreedy(0.0), seed=stream(seed, "C4.16", *name))
            world = stream(seed, "C4.16", "world", *name)
            sessions.append(_session(game, kind, beat, reuse, EPSILONS[cell["epsilon"]], world))
    return {**cell, "sessions": sessions}


def _session(
    game: BallGame, kind: int, beat: Beat, reuse: BayesianPolicyReuse, epsilon: Exploration, world
) -> dict:
    """One user's episodes, BEAT in charge."""
    schedule, product = epsilon_of(epsilon), np.full(game.n_types, 1 / game.n_types)
    decisions = alike = vanished = 0
    apart = 0.0
    heading, signal, before = np.empty(1, np.int64), np.empty(1, np.int64), np.empty((1, 2), np.int64)
    for episode in range(EPISODES):
        balls = new_balls(game, [kind], draw_sigma(world), random_states(world, 1))
        while balls.playing[0]:
            reuse.rule = EpsilonGreedy(schedule(decisions, episode))
            speed = beat.select()
            alike += reuse.select() == speed
            decisions += 1
            advance(game.field, balls, np.array([speed]), 0, MAX_STEPS, heading, before)
            read_moves(game.field, before, heading, np.array([speed]), balls.x, balls.y, signal)
            move = transition_of(signal[0])
            beat.update(speed, move)
            reuse.update(speed, move)
            product = product * np.exp(beat.library.signal.log_likelihood(speed, move))
            vanished = vanished or (decisions if not product.any() else 0)
            apart = max(apart, float(np.abs(beat.belief - reuse.belief).max()))
        beat.end_episode()
    finite = beat.log_belief[np.isfinite(beat.log_belief)]
    return {
        "kind": kind, "decisions": decisions, "alike": alike, "apart": apart, "vanished": vanished,
        "spread": round(float(finite.max() - finite.min()), 2),
    }  # fmt: skip


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of decisions alike, the largest difference of beliefs, and when the printed products become zero."""
    sessions = [s for r in results for s in r["sessions"]]
    decisions = sum(s["decisions"] for s in sessions)
    share = sum(s["alike"] for s in sessions) / decisions
    apart = max(s["apart"] for s in sessions)
    spread = np.array([s["spread"] for s in sessions])
    gone = [s["vanished"] for s in sessions if s["vanished"]]
    found = {
        "decisions_alike": Estimate(share, share, None, decisions),
        "beliefs_apart": Estimate(apart, float(np.median([s["apart"] for s in sessions])), None, len(sessions)),
        "belief_spread": mean_estimate(spread),
        "belief_spread_largest": Estimate(float(spread.max()), float(np.median(spread)), None, len(spread)),
        "products_that_vanish": mean_estimate([float(s["vanished"] > 0) for s in sessions]),
    }
    if gone:
        found["steps_until_products_vanish"] = mean_estimate(np.array(gone, float))
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By ε and type: decisions, those alike, the spread of the log belief and when products vanish."""
    found = []
    for result in results:
        for kind in sorted({s["kind"] for s in result["sessions"]}):
            mine = [s for s in result["sessions"] if s["kind"] == kind]
            row = {key: sum(s[key] for s in mine) for key in ("decisions", "alike")}
            row |= {key: [s[key] for s in mine] for key in ("spread", "vanished")}
            found.append({"epsilon": result["epsilon"], "kind": kind, **row})
    return found


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.c4_16_beat_is_reuse.figure_decision_agreement import draw_decision_agreement

    return draw_decision_agreement(result, list(EPSILONS))


CLAIM = Claim(
    id="C4.16",
    title="BEAT is Bayesian policy reuse (§4.8.4.2)",
    thesis="The BEAT algorithm is a special case of BPR, corresponding to the use of ε-greedy policy selection, "
    "MDP transition functions as observation models, and action sets as pre-learnt policies to reuse.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.16"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    check=_check,
)
