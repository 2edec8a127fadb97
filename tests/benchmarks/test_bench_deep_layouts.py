"""`bench deep_layouts`: other layouts every episode, rows by hand, and one small run of each method."""

from importlib.util import find_spec

import pytest

from benchmarks.action import deep_layouts
from benchmarks.action.deep_layouts import (
    DQN,
    EVERY,
    MASKABLE_PPO,
    ONE,
    PLAIN,
    PRIOR,
    WORLD,
    layout_rows,
)
from benchmarks.action.deep_worlds import new_world
from lifelore.bridges.minigrid_view import SymbolicView
from lifelore.core.errors import MissingExtraError

pytest.importorskip("minigrid")


def layouts(run, n=6):
    env = deep_layouts.OtherLayouts(SymbolicView(new_world(WORLD)), MASKABLE_PPO, run)
    found = []
    for _ in range(n):
        env.reset(seed=0)
        found.append(env.unwrapped.grid.encode().tobytes())
    return found


def test_every_episode_has_another_layout_the_same_for_both_learners():
    one, again, other = layouts(0), layouts(0), layouts(1)
    assert one == again != other
    assert len(set(one)) > 3


def test_rows_are_paired_by_run():
    runs = {
        (DQN, EVERY): {
            PLAIN: [{"scores": [0.9, score], "goals": 10} for score in (0.1, 0.5, 0.3)],
            PRIOR: [{"scores": [0.0, score], "goals": 30} for score in (0.2, 0.6, 0.4)],
        }
    }
    rows = {row["name"]: row for row in layout_rows(runs)}
    case = f"{WORLD}, {EVERY}, {DQN}"
    assert rows[f"{case} {PRIOR}, score at the end"]["value"] == pytest.approx(0.4)
    gain = rows[f"{case}, score at the end, gain by prior, mean"]
    assert gain["value"] == pytest.approx(0.1)
    assert rows[f"{case}, goals reached while learning, gain by prior, interquartile mean"]["value"] == 20


@pytest.mark.deep
def test_each_method_learns_with_and_without_the_prior():
    pytest.importorskip("sb3_contrib")
    ticks = []
    cases = {(MASKABLE_PPO, ONE): 512, (DQN, EVERY): 300}
    result = deep_layouts.bench_deep_layouts(1, lambda *tick: ticks.append(tick), cases)
    assert [tick[:2] for tick in ticks] == [(n, 4) for n in range(1, 5)]
    scores = [row["value"] for row in result["rows"] if row["name"].endswith("prior, score at the end")]
    assert len(scores) == 4
    assert all(0 <= score <= 1 for score in scores)


@pytest.mark.skipif(find_spec("stable_baselines3") is not None, reason="the extra deep is installed")
def test_without_the_extra_the_error_names_it():
    with pytest.raises(MissingExtraError, match=r"lifelore\[deep\]"):
        deep_layouts.bench_deep_layouts(1, lambda *tick: None)
