"""What Pacman's learners and libraries are trained and counted by, and what the thesis leaves open there."""

import json

import numpy as np
import pytest

from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import STRATEGIES, PacmanMaze
from lifelore.interaction.library.policy_library import PolicyLibrary
from reproduction.chapter4.c4_04_pacman.pacman_library import (
    arenas,
    exact_moments,
    falling_schedule,
    greedy,
    sampled_returns,
    trained_policies,
)
from reproduction.chapter4.c4_04_pacman.run import first_stretch, reused, run_cell
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C4.4").sizes["quick"])

MAZE = PacmanMaze(5, 5)
TRAINED = {**QUICK, "training_episodes": 10_000}


@pytest.fixture(scope="module")
def at_home():
    return arenas(MAZE, MAZE.draw_foods(stream(5, "foods")))


@pytest.fixture(scope="module")
def library(at_home):
    return trained_policies(TRAINED, at_home, (5,))


def test_each_policy_is_the_best_against_its_own_ghost(at_home, library):
    mean, deviation = exact_moments(at_home, library)
    # Within the claim's tolerance, and the ghosts differ: no policy does for all.
    assert (np.diag(mean) >= mean.max(axis=1) - 7).all()
    assert np.diag(mean).mean() > 125
    assert (mean.max(axis=1) - mean.min(axis=1) > 50).all()
    assert (deviation >= 0).all()


def test_if_the_ghost_changed_with_each_episode_there_were_nothing_to_infer(at_home, library):
    # Printed: strategies "change from episode to episode". Then every episode is a draw from the mixture, whatever
    # was seen before, and the best that reuse can do is one policy's mean over the four.
    mean, _ = exact_moments(at_home, library)
    assert mean.mean(axis=0).max() < np.diag(mean).mean() - 15


def test_trained_without_a_discount_policies_dither():
    # Waiting is worth as much as winning later: nothing hurries, and the cap cuts the episode.
    values, maze = {}, PacmanMaze()
    for discount in (1.0, 0.97):
        found = []
        for layout in range(2):
            here = arenas(maze, maze.draw_foods(stream(layout, "foods")))
            policies = trained_policies({**TRAINED, "training_discount": discount}, here, (layout,))
            found.append([arena.moments(policy)[0] for arena, policy in zip(here, policies, strict=True)])
        values[discount] = np.array(found)
    assert values[0.97].min() > 80
    assert (values[1.0] < 60).sum() >= 2


def test_samples_are_of_the_policies_on_the_types(at_home, library):
    mean, deviation = exact_moments(at_home, library)
    samples = sampled_returns(at_home, library, 400, (1,))
    assert samples.shape == (4, 4, 400)
    # Five standard errors, and a little where nothing varies.
    assert (np.abs(samples.mean(axis=2) - mean) <= 5 * deviation / 20 + 1e-9).all()
    # Fewer samples are the first of more.
    assert np.array_equal(sampled_returns(at_home, library, 10, (1,)), samples[..., :10])


def test_rates_fall_as_printed():
    # 0.5, less 0.5/N after each of N episodes.
    assert falling_schedule(0.5, 0.1, 4, 1.0).epsilon.tolist() == [0.5, 0.375, 0.25, 0.125]


def test_greedy_policy_shares_ties():
    assert greedy(np.array([[0.0, 0.0], [1.0, 2.0]])).tolist() == [[0.5, 0.5], [0.0, 1.0]]


def test_episodes_needed_by_hand():
    expected = np.array([0, 9, 9, 0, 9, 9, 9, 0.0])
    # A mean may be lifted by chance: 9, 9, 0 has the mean 6.
    assert first_stretch(expected, 6, 3) == 1
    assert first_stretch(expected, 9, 3) == 5
    assert first_stretch(expected, 9.1, 1) is None


def test_reuse_settles_on_the_right_policy():
    known = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 1.0)
    first, second = np.array([[10.0] * 30, [0.0] * 30]), np.array([[0.0] * 30, [10.0] * 30])
    chosen = reused(known, np.array([first, second]), np.random.default_rng(0))
    assert (chosen[:, 1:] == [[0], [1]]).all()


def test_a_cell_is_the_same_whenever_it_is_run_and_plain_data():
    settings = {**QUICK, "training_episodes": 500, "episodes": 120, "reuse_episodes": 100}
    first, again = (run_cell(settings, {"layout": 1}, 3) for _ in range(2))
    assert json.loads(json.dumps(first, allow_nan=False)) == again
    assert len(first["tasks"]) == len(STRATEGIES)
    assert first != run_cell(settings, {"layout": 2}, 3)
