"""An agent of the user lives the same episodes as the others, and is measured from outside."""

import pytest

from lifelore.agent.any_tasks.live_in import TEXTBOOK, live_in
from lifelore.core.errors import InputError

pytestmark = pytest.mark.filterwarnings("ignore:(The action prior is empty|Nothing that was observed)")


class Corridor:
    """Three cells to the right end the episode; a step costs 1, the end pays 10."""

    name, n_actions = "corridor", 2

    def __init__(self):
        self.resets = []

    def reset(self, task, seed):
        self.resets.append((task, seed))
        self.cell = 0
        return 0

    def step(self, action):
        self.cell = max(0, self.cell + (1 if action else -1))
        over = self.cell == 3
        return self.cell, 10.0 if over else -1.0, over, False

    def context(self, state, last_reward):
        return state


def rightwards(world, task, seeds, max_steps):
    """Walk to the end."""
    for seed in seeds:
        world.reset(task, seed)
        for _ in range(max_steps):
            _, _, terminated, truncated = world.step(1)
            if terminated or truncated:
                break


def test_returns_are_measured_from_outside_and_compared(tmp_path):
    world, size = Corridor(), {"tasks": 3, "episodes": 4, "max_steps": 9, "discount": 0.5}
    report = live_in(world, **size, agents={"mine": rightwards}, csv=tmp_path / "l.csv")
    own = [task["agents"]["mine"] for task in report["tasks"]]
    # -1 - 0.5 + 0.25 · 10
    assert [(one["mean_return"], one["reached"]) for one in own] == [(1.0, True)] * 3
    assert report["settings"]["agents"] == ["lore", "scratch", "textbook", "mine"]
    assert {"lore_vs_scratch", "lore_vs_textbook", "lore_vs_mine"} < set(report["summary"])
    assert report["summary"]["lore_vs_mine"]["mean_return_difference"]["raw"]["mine"] == 1.0
    # All four agents had the same episodes.
    assert [world.resets[4 * n : 4 * n + 4] for n in range(4)] == [world.resets[:4]] * 4
    assert len(set(world.resets)) == 12
    assert (tmp_path / "l.csv").read_text().count(",mine,") == 3 * (4 + 4)
    # An agent of the user changes no other.
    for alone, beside in zip(live_in(Corridor(), **size)["tasks"], report["tasks"], strict=True):
        assert {name: beside["agents"][name] for name in alone["agents"]} == alone["agents"]


def test_textbook_is_q_learning_with_a_constant_epsilon():
    task = live_in(Corridor(), tasks=2, episodes=30, max_steps=20, **TEXTBOOK)["tasks"][1]["agents"]
    assert task["textbook"] == task["scratch"]
    fall = live_in(Corridor(), tasks=2, episodes=30, max_steps=20)["tasks"][1]["agents"]
    assert fall["textbook"] == task["textbook"] != fall["scratch"]


@pytest.mark.parametrize(
    ("agent", "said"),
    [
        (lambda world, task, seeds: None, "an end after 0 resets with 0 steps left in task 0"),
        (lambda world, task, seeds: world.reset(task, -1), r"got reset\(0, -1\) with 0"),
        (lambda world, task, seeds: world.reset(task + 1, seeds[0]), r"got reset\(1, "),
        (lambda world, task, seeds: world.step(1), "got a step with 0 steps left"),
        (lambda world, task, seeds: world.reset(task, seeds[0]), "an end after 1 resets with 9 steps left"),
        (
            lambda world, task, seeds: [world.reset(task, seed) for seed in seeds],
            r"got reset\(.* with 9 steps left",
        ),
        (lambda world, task, seeds: [world.reset(task, seeds[0]), *map(world.step, [0] * 10)], "9 steps long"),
        (
            lambda world, task, seeds: [rightwards(world, task, seeds, 9), world.reset(task, 1)],
            r"reset\(0, 1\) with 0",
        ),
    ],
)
def test_an_agent_that_lives_other_episodes_is_refused(agent, said):
    with pytest.raises(InputError, match=said):
        live_in(Corridor(), tasks=1, episodes=3, max_steps=9, agents={"mine": lambda *given: agent(*given[:3])})


@pytest.mark.parametrize(
    ("agents", "said"),
    [({"lore": rightwards}, "names other than lore, scratch, textbook"), ({"mine": 3}, "must be functions of")],
)
def test_names_and_functions_are_checked(agents, said):
    with pytest.raises(InputError, match=said):
        live_in(Corridor(), agents=agents)
