import pytest

from lifelore import compare_agents
from lifelore.core.errors import InputError, NotFoundError
from tests.agent.any_tasks.windy_grid import SETTINGS, WINDS, WindyGrid

CONTEXTS = (0, 1, 0, 1)


def make(number):
    return WindyGrid(WINDS[CONTEXTS[number]])


def straight(world, task, seeds, max_steps):
    """Goes right for ever."""
    for seed in seeds:
        world.reset(task, seed)
        for _ in range(max_steps):
            _, _, terminated, truncated = world.step(3)
            if terminated or truncated:
                break


def test_agents_are_compared_on_the_same_tasks():
    report = compare_agents(make, CONTEXTS, {"full": None, "textbook": None, "mine": straight}, **SETTINGS)
    assert [task["context"] for task in report["tasks"]] == list(CONTEXTS)
    assert all(set(task["agents"]) == {"full", "textbook", "mine"} for task in report["tasks"])
    summary = report["summary"]
    assert summary["full_vs_textbook"]["mean_return_difference"]["value"] > 0
    assert summary["full_vs_mine"]["mean_return_difference"]["value"] > 0
    # No agent changes another.
    alone = compare_agents(make, CONTEXTS[:2], {"textbook": None, "mine": straight}, **SETTINGS)
    for one, other in zip(alone["tasks"], report["tasks"], strict=False):
        assert one["agents"] == {name: other["agents"][name] for name in one["agents"]}


def test_an_environment_in_place_of_a_function_is_named():
    with pytest.raises(InputError, match="make must be a function from task number to environment, got WindyGrid"):
        compare_agents(make(0), CONTEXTS, **SETTINGS)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("agents", "more", "says"),
    [
        (["fulll"], {}, "agents must be of full"),
        ({"full": straight}, {}, "names other than full"),
        ([], {}, "needs an agent"),
        (["full"], {"memory": "life.db"}, "stores nothing"),
    ],
)
def test_mistakes_are_named(agents, more, says):
    with pytest.raises((InputError, NotFoundError), match=says):
        compare_agents(make, CONTEXTS, agents, **SETTINGS, **more)
