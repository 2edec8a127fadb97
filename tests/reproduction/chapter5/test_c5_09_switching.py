"""C5.9: games by hand and by counting all moves, filters and schedules by hand, measures of made-up results."""

from itertools import pairwise, product

import numpy as np
import pytest

from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.signals.category_signal import CategorySignal
from reproduction.chapter4.c4_04_pacman.pacman_library import Arena
from reproduction.chapter5.c5_09_switching.agents import AGENTS, BPR, KNOWS, OKR, OURS, KnowsType
from reproduction.chapter5.c5_09_switching.pacman_games import GhostFilter
from reproduction.chapter5.c5_09_switching.rounds import Recorded, RoundWorld, Shown
from reproduction.chapter5.c5_09_switching.run import measure, readings
from reproduction.chapter5.c5_09_switching.schedules import SCHEDULES, Lived, Opponent
from reproduction.chapter5.c5_09_switching.small_games import (
    DRAWN,
    GAMES,
    LOST,
    RING,
    START,
    WON,
    MatrixGame,
    pursuit,
)
from reproduction.chapter5.c5_09_switching.thesis_worlds import golf

# ---- small games -------------------------------------------------------------------------------------------


def short(game: MatrixGame, n_steps: int) -> MatrixGame:
    """A game of fewer moves, whose episodes can all be counted."""
    return MatrixGame(game.moves, game.following, game.pay, n_steps, game.over)


def counted_win_prob(game: MatrixGame, type_: int, policy: int) -> float:
    """Probability of a win, by all sequences of moves."""
    won = 0.0
    for moves in product(range(game.moves.shape[2]), repeat=game.n_steps):
        state, score, prob, over = 0, 0, 1.0, False
        for step, move in enumerate(moves):
            prob *= game.moves[type_, state, move]
            if not over:
                action = game.policies[policy, step, state]
                score += game.pay[state, action, move]
                state = game.following[state, action, move]
                over = bool(game.over[state])
        won += prob * (score > 0)
    return won


@pytest.mark.parametrize("name", GAMES)
def test_win_probabilities_are_those_of_all_sequences_of_moves(name):
    game = short(GAMES[name](), 4)
    every = range(game.n_types)
    counted = [[counted_win_prob(game, type_, policy) for policy in every] for type_ in every]
    assert np.allclose(game.win_probs, counted, atol=1e-12)


@pytest.mark.parametrize("name", GAMES)
def test_a_best_response_has_the_largest_score_of_all_plans(name):
    """Two moves: every plan that acts by step and state is tried."""
    game = short(GAMES[name](), 2)
    n_states, n_actions, _ = game.pay.shape

    def score(type_: int, first: int, then: tuple[int, ...]) -> float:
        found = 0.0
        for move, move2 in product(range(game.moves.shape[2]), repeat=2):
            prob, state = game.moves[type_, 0, move], game.following[0, first, move]
            found += prob * game.moves[type_, state, move2] * game.pay[0, first, move]
            if not game.over[state]:
                found += prob * game.moves[type_, state, move2] * game.pay[state, then[state], move2]
        return found

    for type_ in range(game.n_types):
        best = game.policies[type_]
        own = score(type_, best[0, 0], tuple(best[1]))
        plans = product(range(n_actions), product(range(n_actions), repeat=n_states))
        assert own == pytest.approx(max(score(type_, first, then) for first, then in plans), abs=1e-12)


def test_a_pursuer_meets_who_stays_after_as_many_steps_as_cells_between():
    game = pursuit()
    still = MatrixGame(np.eye(3)[np.full((1, RING), 1)], game.following, game.pay, START, game.over)
    assert still.win_probs.tolist() == [[1.0]]
    assert short(still, START - 1).win_probs.tolist() == [[0.0]]


def test_a_game_ends_as_its_score_says():
    """The only move of the opponent is the first; the two actions pay 1 and -1."""
    sure = MatrixGame(np.ones((1, 1, 1)), np.zeros((1, 2, 1), int), np.array([[[1], [-1]]]), 2, np.zeros(1, bool))
    plans = {WON: [[0], [0]], DRAWN: [[0], [1]], LOST: [[1], [1]]}
    for outcome, actions in plans.items():
        game = MatrixGame(sure.moves, sure.following, sure.pay, 2, sure.over)
        game.__dict__["policies"] = np.array([actions])
        agent = KnowsType.__new__(KnowsType)
        agent.type, agent._best = 0, np.array([0])
        assert game.play(stream(0, "test"), 0, agent) == Lived(float(outcome == WON), outcome, 0)


# ---- worlds of the thesis ----------------------------------------------------------------------------------


def test_an_episode_is_its_rounds():
    """Pays 0 and 1 for certain: the best policies' episodes score 2, and any other score is in a lower third."""
    probs = np.array([[[1.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]])
    library = PolicyLibrary(CategoricalOutcomes([0.0, 1.0], probs), CategorySignal(probs))
    pay = library.performance.mean
    world = RoundWorld(library, lambda random, type_, policy: Shown(policy, pay[type_, policy]), 10 * pay, 2)
    agent = KnowsType(library)
    agent.type = 1
    assert world.play(stream(0, "test"), 1, agent) == Lived(20.0, 2, 0)
    assert world.play(stream(0, "test"), 0, agent) == Lived(0.0, 0, 0)


def test_recorded_games_are_those_of_their_pair():
    pay = np.arange(12.0).reshape(2, 3, 2)
    games = Recorded(pay, np.log(np.full((2, 3, 2, 2), 0.5)))
    random = stream(0, "test")
    drawn = [games.round_of(random, 1, 2) for _ in range(50)]
    assert {one.pay for one in drawn} == {10.0, 11.0}
    assert all(one.signal == int(one.pay) for one in drawn)
    assert games.signal().log_likelihood(2, 11) == pytest.approx(np.log([0.5, 0.5]))


def test_a_ghost_is_followed_by_its_phases():
    """Two cells that see each other, and a third out of sight; a ghost that steps from 0 to 1 to 2 to 0."""
    cells_, line_of_sight = np.arange(3), np.array([[1, 1, 0], [1, 1, 0], [0, 0, 1]], bool)

    class Maze:
        n_cells, centre, sees = 3, 2, line_of_sight

    class Task:
        maze, params = Maze(), (None, None, cells_, np.array([[1], [2], [0]]), None)

    arena = Arena.__new__(Arena)
    object.__setattr__(arena, "task", Task())
    ghost, playing = GhostFilter(arena, 3), np.ones(3, bool)
    observation = lambda own, shown: own * 4 + shown  # noqa: E731
    # It starts in 0 or 1. Seen in 1, it is out of sight next, and then in 0; seen in 0 it must be in 1 next.
    ghost.see(np.array([observation(0, 1), observation(0, 0), observation(0, 0)]), playing)
    ghost.see(np.array([observation(0, 3), observation(0, 1), observation(0, 3)]), playing)
    assert ghost.log_likelihood[:2] == pytest.approx(np.log([0.5, 0.5]))
    assert ghost.log_likelihood[2] == -np.inf
    ghost.see(np.array([observation(0, 0), 0, 0]), np.array([True, False, False]))
    assert ghost.log_likelihood[:2] == pytest.approx(np.log([0.5, 0.5]))


# ---- schedules ---------------------------------------------------------------------------------------------


def opponent(schedule: str, seed: int = 0) -> Opponent:
    """Five types and policies; policy i pays least on type i."""
    return Opponent(1 - np.eye(5), (LOST, DRAWN, WON), schedule, stream(seed, "test"))


def places(schedule: str, outcomes: list[str], policies: list[int] | None = None) -> list[int]:
    """Places from 0 after episodes that end so."""
    one = opponent(schedule)
    one.place, found = 0, []
    for outcome, policy in zip(outcomes, policies or [0] * len(outcomes), strict=True):
        one.end_episode(Lived(0.0, outcome, policy))
        found.append(one.place)
    return found


def test_patterns_by_hand():
    outcomes = [WON, LOST, DRAWN, DRAWN, WON]
    assert places("by outcome", outcomes) == [2, 0, 1, 1, 2]
    assert places("moves on", outcomes) == [2, 2, 3, 0, 2]
    assert places("cycle", outcomes) == [1, 2, 3, 0, 1]
    assert places("static", outcomes) == [0] * 5


def test_an_adaptive_opponent_takes_the_type_on_which_the_last_policy_pays_least():
    one = opponent("adaptive")
    used = [int(policy) for policy in one.used]
    assert places("adaptive", [WON] * 4, used) == [0, 1, 2, 3]


def test_a_type_lasts_ten_or_two_episodes():
    for schedule, n in (("every ten", 10), ("every two", 2)):
        found = [0, *places(schedule, [WON] * 400)]
        spans = [set(found[start : start + n]) for start in range(n, 400, n)]
        assert all(len(span) == 1 for span in spans)
        assert len({span.pop() for span in spans}) == 4


def test_noise_leaves_the_pattern_in_a_fifth_of_the_episodes():
    """A fifth, of which a quarter lands where the pattern would: 15 % of 4,000 leave it, known to 1.2 %."""
    found = [0, *places("cycle, noise", [WON] * 4000)]
    left = np.mean([(a + 1) % 4 != b for a, b in pairwise(found)])
    assert left == pytest.approx(0.15, abs=0.024)


# ---- agents and measures -----------------------------------------------------------------------------------


def test_bpr_holds_its_policy_until_it_is_paid():
    library = golf().library
    agent = AGENTS[BPR](library, stream(0, "test"))
    first = agent.select()
    agent.observe(first, 0)
    assert agent.select() == first
    agent.end_episode(LOST, -80.0)
    other = agent.select()
    agent.observe(other, 0, -80.0)
    agent.end_episode(LOST, -80.0)  # paid already


def made_up(shares: dict[str, list[float]], world: str = "golf", schedule: str = "static") -> dict:
    """A result of runs in which who knows the types gains 2."""
    gains = {name: [2 * share for share in shares.get(name, [0.5] * 3)] for name in AGENTS if name != KNOWS}
    return {"world": world, "schedule": schedule, "gains": gains | {KNOWS: [2.0] * 3}}


def test_measures_by_hand():
    results = [made_up({OURS: [0.9, 1.0, 0.8], OKR: [0.7, 0.7, 0.7]}, schedule=name) for name in SCHEDULES]
    found = measure({}, results)
    assert found["ours_exact"].value == pytest.approx(0.9)
    assert found["okr_noise"].value == pytest.approx(0.7)
    assert found["static_upper"].value > 0.9 - 0.5
    assert found["okr_upper"].value > 0.9 - 0.7
    worse = [
        made_up({OURS: [0.4, 0.3, 0.2], OKR: [0.7, 0.7, 0.7]}, schedule=name) if name == "adaptive" else one
        for name, one in zip(SCHEDULES, results, strict=True)
    ]
    assert measure({}, worse)["okr_upper"].value < 0
    assert measure({}, worse)["static_upper"].value > 0


def test_a_share_is_the_mean_over_worlds_whatever_their_units():
    results = [made_up({OURS: [0.8] * 3}, world, name) for world in ("golf", "penalties") for name in SCHEDULES]
    for result in results[: len(SCHEDULES)]:
        result["gains"] = {name: [100 * gain for gain in gains] for name, gains in result["gains"].items()}
        result["gains"][OURS] = [200.0] * 3
    assert measure({}, results)["ours_known"].value == pytest.approx(0.9)
    by_worlds = {one["worlds"]: numbers["ours_known"].value for one, numbers in readings({}, results)}
    assert by_worlds == pytest.approx({"all": 0.9, "of the thesis": 1.0, "small games": 0.8})
