"""Logs keep to the documented format: folders, files, columns, and what L2Logger's own check asks of them."""

import csv
import json
import re
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.life import live
from lifelore.agent.live.output.l2_log import L2Log, LifeLog
from lifelore.core.errors import InputError, StoreError

from ..flat_settings import flat_settings

STANDARD = [
    "block_num", "exp_num", "worker_id", "block_type", "block_subtype", "task_name", "task_params", "exp_status",
    "timestamp",
]  # fmt: skip


def read(scenario: Path) -> list[dict[str, str]]:
    """All rows of a scenario by experience, after a look that it is one: log format 1.1."""
    info = json.loads((scenario / "logger_info.json").read_text())
    assert info["log_format_version"] == "1.1"
    assert isinstance(json.loads((scenario / "scenario_info.json").read_text()), dict)
    rows = []
    for file in scenario.glob("*/*/*"):
        assert file.name == "data-log.tsv"
        with file.open(encoding="utf-8", newline="") as text:
            table = csv.DictReader(text, delimiter="\t", strict=True)
            names = list(table.fieldnames or [])
            assert names[:9] == STANDARD
            assert names[9:] == sorted(set(names[9:]))
            assert info["metrics_columns"]
            assert set(info["metrics_columns"]) <= set(names[9:])
            for row in table:
                check_row(row, file)
                rows.append(row)
    rows.sort(key=lambda row: int(row["exp_num"]))
    assert [int(row["exp_num"]) for row in rows] == list(range(len(rows)))
    blocks = [int(row["block_num"]) for row in rows]
    assert blocks == sorted(blocks)
    return rows


def check_row(row: dict, file: Path) -> None:
    assert file.parent.name == f"{row['block_num']}-{row['block_type']}"
    assert file.parent.parent.name == row["worker_id"]
    assert re.fullmatch(r"[0-9a-zA-Z_\-.]+", row["worker_id"])
    assert row["block_type"] in ("train", "test")
    assert row["block_subtype"] in ("wake", "sleep")
    assert row["exp_status"] in ("complete", "incomplete")
    assert re.fullmatch("[0-9a-zA-Z]+_[0-9a-zA-Z]+", row["task_name"])
    assert isinstance(json.loads(row["task_params"]), dict)
    datetime.strptime(row["timestamp"], "%Y%m%dT%H%M%S.%f")
    for name in set(row) - set(STANDARD):
        float(row[name])


def test_blocks_begin_where_the_type_changes(tmp_path):
    log = L2Log(tmp_path, "small-life", ["reward"], {"author": "we", "scenario_type": "custom"})
    log.add("train", "maze_1", {"reward": [1.5, -2.0], "steps": [3, 4]}, params={"goal": [1, 2], "name": 'a"b'})
    log.add("train", "maze_2", {"steps": np.array([7]), "reward": np.array([0.1])}, complete=[False])
    log.add("test", "maze_1", {"reward": [5.0], "steps": [1]})
    log.add("train", "maze_1", {"reward": [6.0], "steps": [1]})
    assert re.fullmatch(r"small-life-\d+-\d{6}", log.path.name)
    assert json.loads((log.path / "scenario_info.json").read_text())["author"] == "we"
    rows = read(log.path)
    assert [(r["block_num"], r["block_type"], r["task_name"], r["reward"], r["steps"]) for r in rows] == [
        ("0", "train", "maze_1", "1.5", "3"),
        ("0", "train", "maze_1", "-2.0", "4"),
        ("0", "train", "maze_2", "0.1", "7"),
        ("1", "test", "maze_1", "5.0", "1"),
        ("2", "train", "maze_1", "6.0", "1"),
    ]
    assert [r["exp_status"] for r in rows] == ["complete"] * 2 + ["incomplete"] + ["complete"] * 2
    assert json.loads(rows[0]["task_params"]) == {"goal": [1, 2], "name": 'a"b'}


def test_a_life_is_logged_episode_by_episode(tmp_path):
    settings = flat_settings(tasks=3, episodes=40, max_steps=300, memory=str(tmp_path / "life.db"))
    kept = []
    log = LifeLog(tmp_path / "logs", settings.world.domain)

    def watch(task, results):
        log.add_results(task, results)
        kept.append((task, dict(results)))

    life = live(settings, watch=watch)
    assert [task for task, _ in kept] == life.report["tasks"]
    scenarios = {path.name.rsplit("-", 2)[0]: path for path in (tmp_path / "logs").iterdir()}
    assert sorted(scenarios) == ["lore", "scratch-task0", "scratch-task1", "scratch-task2"]
    rows = read(scenarios["lore"])
    curves = [results["lore"].curve for _, results in kept]
    assert [float(row["reward"]) for row in rows] == np.concatenate([c.rewards for c in curves]).tolist()
    assert [int(row["episode_step_count"]) for row in rows] == np.concatenate([c.steps for c in curves]).tolist()
    assert {row["block_num"] for row in rows} == {"0"}
    for (task, results), expert in zip(kept, sorted(s for s in scenarios if s != "lore"), strict=True):
        alone = read(scenarios[expert])
        assert {row["task_name"] for row in alone} == {"lattice_{}x{}".format(*task["goal"])}
        assert float(alone[0]["performance"]) == task["agents"]["scratch"]["first_return"]
        broken = [row["exp_status"] for row in alone].count("incomplete")
        assert len(alone) - broken == results["scratch"].complete
        assert broken == (results["scratch"].complete < len(results["scratch"].curve.returns))
    info = json.loads((scenarios["scratch-task0"] / "scenario_info.json").read_text())
    assert info == {"scenario_type": "ste", "agent": "scratch"}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"block_type": "play"}, "block_type must be one of train, test, got 'play'"),
        ({"task_name": "maze 1"}, "task_name must be label_variant, of letters and digits, got 'maze 1'"),
        ({"columns": {"steps": [1]}}, "columns must hold reward and no standard column, got steps"),
        ({"columns": {"reward": [1.0], "timestamp": [1]}}, "no standard column, got reward, timestamp"),
        ({"columns": {"reward": [1.0], "steps": [1, 2]}}, r"equally long rows, got \[\(1,\), \(2,\)\]"),
        ({"columns": {"reward": 1.0}}, r"equally long rows, got \[\(\)\]"),
    ],
)
def test_experiences_that_break_a_rule(change, words, tmp_path):
    log = L2Log(tmp_path, "life", ["reward"])
    with pytest.raises(InputError, match=words):
        log.add(**({"block_type": "train", "task_name": "maze_1", "columns": {"reward": [1.0]}} | change))
    assert read(log.path) == []


def test_columns_stay(tmp_path):
    log = L2Log(tmp_path, "life", ["reward"])
    log.add("train", "maze_1", {"reward": [1.0]})
    with pytest.raises(InputError, match="columns must stay reward, got reward, steps"):
        log.add("train", "maze_1", {"reward": [1.0], "steps": [2]})


def test_logs_that_cannot_be(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="folder must name a folder, got"):
        L2Log(tmp_path / "file", "life", ["reward"])
    with pytest.raises(InputError, match="folder must name a folder, got"):
        LifeLog(tmp_path / "file", "lattice")
    with pytest.raises(InputError, match="scenario must be of letters, digits"):
        L2Log(tmp_path, "a/b", ["reward"])
    with pytest.raises(InputError, match="at least one column that is not standard"):
        L2Log(tmp_path, "life", [])
    log = L2Log(tmp_path, "life", ["reward"])
    (log.path / "worker-0" / "0-train" / "data-log.tsv").mkdir(parents=True)
    with pytest.raises(StoreError, match=r"cannot write into .*0-train"):
        log.add("train", "maze_1", {"reward": [1.0]})
