"""The long table of a life holds each task's and each episode's numbers, to the bit."""

import csv
from collections import defaultdict

import pytest

from lifelore.agent.any_tasks.live_in import live_in
from lifelore.agent.live.life import live
from lifelore.agent.live.output.long_table import COLUMNS, LongTable
from lifelore.core.errors import StoreError

from ..flat_settings import flat_settings


def read(path):
    """(task, agent, episode or "", measure) to value, and the runs."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    numbers = {(int(r["task"]), r["agent"], r["episode"], r["measure"]): float(r["value"]) for r in rows}
    assert len(numbers) == len(rows)
    return numbers, {r["run"] for r in rows}


class Coin:
    """One step an episode; action 1 pays the seed's parity."""

    n_actions, name = 2, "coin"

    def reset(self, task, seed):
        self.pays = 0.1 * (seed % 7)
        return "start"

    def step(self, action):
        return "over", self.pays * action, True, False

    def context(self, state, last_reward):
        return "coin"


def test_a_life_in_an_own_world(tmp_path):
    report = live_in(Coin(), tasks=3, episodes=30, seed=4, csv=tmp_path / "life.csv")
    numbers, runs = read(tmp_path / "life.csv")
    assert runs == {"4"}
    for task in report["tasks"]:
        for agent, measures in task["agents"].items():
            returns = [numbers[task["index"], agent, str(episode), "return"] for episode in range(30)]
            assert returns[0] == measures["first_return"]
            assert sum(returns) / 30 == measures["mean_return"]
            assert numbers[task["index"], agent, "", "final_return"] == measures["final_return"]
            assert numbers[task["index"], agent, "", "reached"] == measures["reached"]
    assert len(numbers) == 3 * 3 * (30 + 4)


def test_a_life_of_live(tmp_path):
    lengths = defaultdict(list)
    with LongTable(tmp_path / "life.csv", 0) as table:

        def watch(task, results):
            table.add_results(task, results)
            for agent, result in results.items():
                lengths[agent].append(result.complete)

        settings = flat_settings(tasks=2, jobs=1, memory=str(tmp_path / "memory.db"))
        report = live(settings, watch=watch).report
    numbers, _ = read(tmp_path / "life.csv")
    for place, task in enumerate(report["tasks"]):
        for agent, measures in task["agents"].items():
            first = numbers[task["index"], agent, "0", "return"]
            assert first == measures["first_return"]
            assert numbers[task["index"], agent, "", "steps_to_80"] == measures["steps_to_80"]
            episodes = {e for t, a, e, _ in numbers if (t, a) == (task["index"], agent) and e}
            assert episodes == {str(number) for number in range(lengths[agent][place])}


def test_a_file_that_cannot_be_written_is_refused_before_the_life(tmp_path):
    with pytest.raises(StoreError, match=r"measures cannot be written to .*: No such file"):
        live_in(Coin(), tasks=1, episodes=1, csv=tmp_path / "none" / "life.csv")
