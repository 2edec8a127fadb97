"""C4.16: BEAT and Bayesian policy reuse with the same generator, decision by decision. Thesis: §4.8.4.2."""

from collections.abc import Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import MAX_STEPS, BallGame, LossScale, draw_sigma
from lifelore.domains.ball_game.moves import N_CONTEXTS, N_OUTCOMES, read_moves
from lifelore.domains.ball_game.simulated_player import advance, new_balls, random_states
from lifelore.interaction.adaptation.beat import Beat, Exploration, epsilon_of
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy
from lifelore.interaction.signals.transition_signal import TransitionSignal
from reproduction.chapter4.ball_game.games import Setting
from reproduction.chapter4.ball_game.games import check_games as check
from reproduction.chapter4.ball_game.methods import EPISODES
from reproduction.chapter4.ball_game.play import Trained, train

__all__ = ["cells", "check", "run_cell"]
EPSILONS: dict[str, Exploration] = {"0": 0.0, "0.3": 0.3, "1/n": "1/n", "0.5 − 0.1 an episode": "by episode"}
N_STATES = max(N_CONTEXTS, N_OUTCOMES)


def cells(settings: Mapping) -> list[dict]:
    """A cell for each ε, with users of all types."""
    return [{"game": list(settings["games"][0]), "epsilon": name} for name in EPSILONS]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Sessions of five episodes: decisions, those alike, how far beliefs differ, and when products vanish."""
    setting, epsilon = Setting(*cell["game"]), EPSILONS[cell["epsilon"]]
    game = setting.game
    trained = train(game, settings["training"], seed)
    library = library_of(game, trained, trained.scale(setting.normalisation))
    sessions = []
    for kind, user in product(range(game.n_types), range(settings["users"])):
        name = (setting.words, cell["epsilon"], kind, user)
        beat = Beat(library, epsilon=epsilon, seed=stream(seed, "C4.16", *name))
        generator = stream(seed, "C4.16", *name)
        reuse = BayesianPolicyReuse(library, EpsilonGreedy(0.0), dynamics=TypeDynamics.static(), seed=generator)
        sessions.append(_session(game, kind, beat, reuse, epsilon, stream(seed, "C4.16", "world", *name)))
    return {**cell, "sessions": sessions}


def _session(
    game: BallGame, kind: int, beat: Beat, reuse: BayesianPolicyReuse, epsilon: Exploration, world
) -> dict:
    """One user's episodes, BEAT in charge."""
    schedule, product = epsilon_of(epsilon), np.full(game.n_types, 1 / game.n_types)
    decisions, alike, vanished, apart = 0, 0, 0, 0.0
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


def library_of(game: BallGame, trained: Trained, scale: LossScale) -> PolicyLibrary:
    """Types × speeds as a policy library; its signal takes the pairs of `transition_of`."""
    samples = -scale.loss(trained.steps, trained.hits)
    types = [f"b = {b}" for b in game.sizes]
    policies = [f"speed {z}" for z in game.speeds]
    return PolicyLibrary.from_samples(samples, types, policies, signal=transition_signal(trained))


def transition_signal(trained: Trained) -> TransitionSignal:
    """T(s' | s; type, speed) in classes: from the context of a command to its outcome."""
    table = np.exp(trained.signal_table())
    n_speeds, _, n_types = table.shape
    probs = np.zeros((n_types, n_speeds, N_STATES, 1, N_STATES))
    shares = table.reshape(n_speeds, N_CONTEXTS, N_OUTCOMES, n_types).transpose(3, 0, 1, 2)
    probs[:, :, :N_CONTEXTS, 0, :N_OUTCOMES] = shares
    probs[:, :, N_CONTEXTS:, 0, 0] = 1.0  # no command has such a context
    return TransitionSignal(probs / probs.sum(axis=-1, keepdims=True))


def transition_of(signal: int) -> NDArray[np.int64]:
    """A signal's number as one transition (context, outcome), (1, 2) int64."""
    return np.array([divmod(int(signal), N_OUTCOMES)], np.int64)
