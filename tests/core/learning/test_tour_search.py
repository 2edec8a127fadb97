"""Search along a tour: sooner than by nearest places, and whole where doors closed or nothing is known."""

import numpy as np

from lifelore.core.learning.curve import GOALS, new_curve
from lifelore.core.learning.known_world import UNKNOWN, WorldModel, unknown_world
from lifelore.core.learning.model_learning import ExplorationStrategy, StateInfo, explore, new_model_learner
from lifelore.core.learning.tour_search import KnownTour, explore_on_tour
from lifelore.core.streams import stream
from lifelore.domains import lattice, noise_maze


def lived(world, model, goal, seed=0, tour=True, episodes=20, max_steps=1000, known=None):
    """The learner and its curve after the first arrival at the goal, or all episodes."""
    tables = world.task(goal).tables()
    learner = new_model_learner(world.n_states, 4, stream(seed, "world"), stream(seed, "own"))
    seen = StateInfo(world.percepts, np.zeros(world.n_states, np.int32), np.zeros((1, 4)))
    known, curve, steps = KnownTour.of(model, world.cells, known), new_curve(episodes), 0
    task = tables, model, seen, ExplorationStrategy(), learner
    while not learner.cursor[GOALS]:
        more = (
            explore_on_tour(*task, known, curve, max_steps, 0.95, 10)
            if tour
            else explore(*task, curve, max_steps, 0.95, 10)
        )
        steps += more
        if not more:
            break
    return learner, curve, steps


def remembered(world) -> WorldModel:
    refused = world.neighbour < 0
    stays = np.arange(world.n_states)[:, None]
    return WorldModel(np.where(refused, stays, world.neighbour).astype(np.int32), world.percepts.copy())


def test_a_world_without_knowledge_is_searched_as_before():
    world = noise_maze(stream(3, "maze"), density=0.6)
    learners = [lived(world, unknown_world(world.n_states, 4), 7, tour=tour)[0] for tour in (True, False)]
    assert all(np.array_equal(one, other) for one, other in zip(*learners, strict=True))


def test_the_tour_of_the_same_moves_is_not_planned_again():
    world = lattice(13)
    model = remembered(world)
    known = KnownTour.of(model, world.cells)
    assert KnownTour.of(model, world.cells, known) is known
    model.target[0] = UNKNOWN
    model.target[model.target == 0] = UNKNOWN
    assert 0 not in KnownTour.of(model, world.cells, known).tour


def test_a_door_that_closed_is_left_out_and_the_goal_still_found():
    world = noise_maze(stream(5, "maze"), density=0.6)
    model = remembered(world)
    # The learner remembers moves through walls.
    state, action = np.nonzero(world.neighbour < 0)
    inner = np.random.default_rng(0).choice(len(state), 20, replace=False)
    model.target[state[inner], action[inner]] = (state[inner] + 1) % world.n_states
    known = KnownTour.of(model, world.cells)
    for goal in (0, world.n_states // 2, world.n_states - 1):
        own = WorldModel(model.target.copy(), model.percept.copy())
        learner, _, _ = lived(world, own, goal, goal, known=known)
        assert learner.cursor[GOALS] == 1
