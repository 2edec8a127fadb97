"""C4.16: BEAT is Bayesian policy reuse: the same decisions, step by step, through the general algorithm.

The general algorithm gets ε-greedy selection, the transitions as signal, action sets as policies, and the same
generator. Beside them runs the belief as printed, which is never normalised. Thesis: §4.8.4.2.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import MAX_STEPS, BallGame, draw_sigma
from lifelore.domains.ball_game.moves import read_moves
from lifelore.domains.ball_game.simulated_player import advance, new_balls, random_states
from lifelore.experiments.chapter4.ball_game_play import train
from lifelore.experiments.chapter4.ball_game_settings import Setting, check_games
from lifelore.experiments.chapter4.c4_16_beat_is_reuse.ball_game_library import library_of, transition_of
from lifelore.experiments.chapter4.diversity_runs import EPISODES
from lifelore.interaction.adaptation.beat import Beat, Exploration, epsilon_of
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy

EPSILONS: dict[str, Exploration] = {"0": 0.0, "0.3": 0.3, "1/n": "1/n", "0.5 − 0.1 an episode": "by episode"}


def check(settings: Mapping) -> None:
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
