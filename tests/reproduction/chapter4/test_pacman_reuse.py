"""What Pacman's learners and libraries are trained and counted by, and what the thesis leaves open there."""

import numpy as np
import pytest

from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import PacmanMaze
from lifelore.interaction.library.policy_library import PolicyLibrary
from reproduction.chapter4.c4_04_pacman.pacman_library import arenas, exact_moments, trained_policies
from reproduction.chapter4.c4_04_pacman.run import first_stretch, reused
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
