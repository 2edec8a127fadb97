"""`lifelore live`: the contract of its JSON, lives that repeat and go on, and what a person sees."""

import json
from pathlib import Path

import pytest

from lifelore.app.live_command import setting_keys
from lifelore.domains import OccupancyMap, office_map, write_occupancy_map
from lifelore.memory import open_memory
from tests.app.changed_settings import changed

DOCUMENT = {
    "domain", "how", "map", "n_states", "building", "seed", "settings", "tasks", "summary", "memory", "seconds",
}  # fmt: skip
TASK = {"index", "goal", "how", "optimal_return", "agents"}
COUNTS = ("steps_to_80", "steps_to_goal", "collisions", "episodes_to_80")
MEASURES = (*COUNTS, "first_return")
RESULT = {*MEASURES, "reached", "final_return"}
ESTIMATE = {"value", "median", "ci95", "n"}
RATIOS = ("steps_to_80_ratio", "collisions_ratio", "jumpstart")
TOLD = {
    "domain", "map", "tasks", "cell", "robot_radius", "destinations", "agent", "robot",
    "start", "memory", "episodes", "max_steps", "seed", "jobs", "density", "discount", "goal_reward",
    "wall_reward", "alpha0", "weight",
}  # fmt: skip
LATTICE = ("live", "--domain", "lattice", "--json")


def check_estimate(estimate: dict, n: int) -> None:
    assert set(estimate) == ESTIMATE
    assert estimate["n"] == n
    if estimate["ci95"] is not None:
        low, high = estimate["ci95"]
        assert low <= high


def check_task(task: dict, names: list[str]) -> None:
    assert set(task) == TASK
    assert [type(part) for part in (task["index"], *task["goal"])] == [int, int, int]
    assert task["how"] == "searched"
    assert task["optimal_return"] > 0
    assert list(task["agents"]) == names
    for result in task["agents"].values():
        assert set(result) == RESULT
        assert type(result["reached"]) is bool
        assert all(type(result[name]) is int and result[name] >= 0 for name in COUNTS)
        assert {type(result[name]) for name in ("first_return", "final_return")} <= {int, float}
        assert result["final_return"] <= task["optimal_return"] * (1 + 1e-9)


def check_summary(summary: dict, names: list[str], n_tasks: int) -> None:
    size = max(1, n_tasks // 3)
    rest = [name for name in names if name != "scratch"]
    assert set(summary) == {"agents", *(f"{name}_vs_scratch" for name in rest)}
    for name in rest:
        beside = summary[f"{name}_vs_scratch"]
        assert set(beside) == {*RATIOS, "capped"}
        assert set(beside["capped"]) == {name, "scratch"}
        for measure in RATIOS:
            check_estimate({k: v for k, v in beside[measure].items() if k != "raw"}, size)
            assert set(beside[measure]["raw"]) == {name, "scratch"}
    assert list(summary["agents"]) == names
    for thirds in summary["agents"].values():
        assert set(thirds) == {"first", "last"}
        for third in thirds.values():
            assert set(third) == {*MEASURES, "capped"}
            for measure in MEASURES:
                check_estimate(third[measure], size)


@pytest.mark.parametrize(
    ("options", "names"),
    [
        ((), ["lore", "scratch"]),
        (("--agent", "all"), ["lore", "model", "prior", "scratch", "undirected", "rmax", "frontier"]),
        (("--agent", "scratch"), ["scratch"]),
        (("--tasks", "1"), ["lore", "scratch"]),
    ],
    ids=["default", "all", "scratch", "one task"],
)
def test_the_contract(options, names, ask, tmp_path):
    said = ask(*LATTICE, "--tasks", 6, "--seed", 5, "--memory", tmp_path / "life.db", *options)
    assert (said.status, said.err) == (0, "")
    life = said.document
    n_tasks = 1 if "--tasks" in options else 6
    assert set(life) == DOCUMENT
    assert (life["domain"], life["map"], life["n_states"], life["seed"]) == ("lattice", None, 341, 5)
    assert set(life["settings"]) == TOLD
    assert life["settings"]["tasks"] == n_tasks == len(life["tasks"])
    assert life["settings"]["memory"] == str(tmp_path / "life.db")
    assert [task["index"] for task in life["tasks"]] == list(range(n_tasks))
    for task in life["tasks"]:
        check_task(task, names)
    check_summary(life["summary"], names, n_tasks)
    assert life["memory"] == {"tasks_before": 0, "tasks_after": n_tasks}
    assert life["seconds"] > 0


def repeatable(life: dict) -> dict:
    """The report without what may differ: time, threads and where the memory lies."""
    settings = {k: v for k, v in life["settings"].items() if k not in ("memory", "jobs")}
    return {k: v for k, v in life.items() if k != "seconds"} | {"settings": settings}


def test_the_same_seed_is_the_same_life_for_any_number_of_threads_and_in_another_process(
    ask, start, answer, tmp_path
):
    """Other hash seeds, other addresses: nothing of a process may enter a life."""
    life = (*LATTICE, "--tasks", 3, *changed(episodes=60))
    first = repeatable(ask(*life, "--set", "jobs=1", "--memory", "1.db").document)
    again = answer(start(*life, "--set", "jobs=3", "--memory", "3.db"))
    assert repeatable(again.document) == first
    other = ask(*LATTICE, "--tasks", 3, "--set", "episodes=60", "--seed", 1, "--memory", "other.db").document
    assert [task["goal"] for task in other["tasks"]] != [task["goal"] for task in first["tasks"]]


def test_without_a_memory_named_it_is_the_users_own(ask, own_data_folder):
    assert ask(*LATTICE, "--tasks", 1).document["settings"]["memory"] == str(own_data_folder / "lifelore.db")
    assert ask(*LATTICE, "--tasks", 1).document["memory"] == {"tasks_before": 1, "tasks_after": 2}
    assert ask("memory", "show", "--json").document["robots"][0]["tasks"] == 2


def map_of(state, tmp_path: Path) -> Path:
    write_occupancy_map(tmp_path / "map.yaml", OccupancyMap(state, 0.05, (0.0, 0.0, 0.0)))
    return tmp_path / "map.yaml"


def test_a_map_is_lived_in_and_named_in_the_report(ask, tmp_path):
    path = map_of(office_map(3).state[:300, :300], tmp_path)
    life = ask("live", "--map", path, "--tasks", 1, "--memory", "life.db", "--json").document
    assert (life["domain"], life["map"]) == ("building", str(path))
    assert life["n_states"] > 50
    assert life["settings"]["discount"] == 0.99
    check_task(life["tasks"][0], ["lore", "scratch"])


def test_a_person_sees_a_table_and_what_was_written(ask, tmp_path):
    said = ask("live", "--domain", "lattice", "--tasks", 6, "--memory", "life.db", "--out", "out")
    assert (said.status, said.err) == (0, "new folder out\n")
    for words in ("6 goals searched in lattice, 341 places", "this robot has finished 6 tasks in all",
                  "steps to 80 %",
                  "lore compared with scratch, last third", "wrote out/summary.json"):  # fmt: skip
        assert words in said.out
    written = [Path(line.removeprefix("wrote ")) for line in said.out.splitlines() if line.startswith("wrote ")]
    assert {path.name for path in written} >= {"summary.json", "life.png", "world.png", "prior.png"}
    assert all(path.stat().st_size > 0 for path in written)
    assert set(json.loads(Path("out/summary.json").read_text())) == DOCUMENT


def test_nothing_is_forgotten_when_the_pictures_cannot_be_kept(ask, known, monkeypatch):
    """The folder is looked at first: a refusal costs no life, and memory stays as it was."""
    before = known.read_bytes()
    Path("taken").write_text("a file")
    assert "taken" in ask(*LATTICE, "--tasks", 2, "--memory", known, "--out", "taken").refusal
    assert known.read_bytes() == before
    with open_memory(known) as memory:
        assert memory.tasks("robot") == 2


def test_the_measures_go_into_a_long_table_beside_json_and_pictures(ask, tmp_path):
    files = ("--csv", tmp_path / "life.csv", "--out", "out")
    said = ask(*LATTICE, "--tasks", 1, "--seed", 3, "--memory", "life.db", *files)
    assert (said.status, said.err) == (0, "new folder out\n")
    assert json.loads(Path("out/summary.json").read_text()) == said.document
    header, *rows = (tmp_path / "life.csv").read_text(encoding="utf-8").splitlines()
    assert header == "run,task,agent,episode,measure,value"
    lore = said.document["tasks"][0]["agents"]["lore"]
    assert f"3,0,lore,,steps_to_80,{lore['steps_to_80']}" in rows
    assert any(row.startswith("3,0,scratch,0,return,") for row in rows)
    refused = ask(*LATTICE, "--memory", "none.db", "--csv", tmp_path / "no" / "life.csv")
    assert "measures cannot be written to" in refused.refusal


def test_every_episode_is_logged_where_it_is_told(ask, tmp_path):
    said = ask(*LATTICE, "--tasks", 1, "--memory", "life.db", "--log", tmp_path / "logs")
    assert (said.status, said.err) == (0, "")
    rows = {path.parts[-4].split("-")[0] for path in (tmp_path / "logs").glob("*/*/0-train/data-log.tsv")}
    assert {"lore", "scratch"} <= rows
    (tmp_path / "file").write_text("")
    refused = ask(*LATTICE, "--memory", "none.db", "--log", tmp_path / "file")
    assert "folder must name a folder" in refused.refusal
    assert not (tmp_path / "none.db").exists()


SET = {
    "building": {
        "cell": 0.4, "robot_radius": 0.15, "min_free": 0.5, "refresh": True, "compare": False,
        "building": "home", "start": [1.5, 1.5],
    },
    "lattice": {"destinations": 3, "size": 9, "episodes": 7, "jobs": 1, "max_steps": 30,
        "discount": 0.9, "goal_reward": 7.0, "wall_reward": -3.0, "alpha0": 0.3, "weight": 2.0,
    },
    "noise": {"density": 0.55},
    "advice": {"loops": 0.3},
}  # fmt: skip
"""A domain to values, other than the defaults, of settings that it takes."""
ELSEWHERE = {"again", "busy", "move_names"}
"""Settings that other tests look at: they need known goals."""


def test_every_setting_is_set_and_stands_in_the_report(ask, tmp_path):
    listed = {one["key"]: one for one in ask("live", "--settings", "--json").document["settings"]}
    assert {key for told in SET.values() for key in told} == set(listed) - ELSEWHERE
    path = map_of(office_map(3).state[:300, :300], tmp_path)
    for domain, told in SET.items():
        assert not [key for key, value in told.items() if value == listed[key]["default"]]
        texts = told | {key: str(value).lower() for key, value in told.items() if isinstance(value, bool)}
        texts |= {"start": "1.5,1.5"} if "start" in told else {}
        place = ("--map", path) if domain == "building" else ()
        options = ("live", "--domain", domain, *place, "--tasks", 1, "--memory", f"{domain}.db", "--json")
        settings = ask(*options, *changed(**texts)).document["settings"]
        assert {key: settings[key] for key in told} == told


DRIVE = {"reached", "metres", "seconds", "refusals", "replans"}


def test_known_goals_are_driven_to(ask, tmp_path):
    path = map_of(office_map(3).state[:300, :300], tmp_path)
    Path("jobs.csv").write_text("name,x,y\nhere,1.475,1.525\nthere,6.475,1.525\n")
    options = ("live", "--map", path, "--goals", "jobs.csv", "--memory", "life.db")
    said = ask(*options, *changed(busy="true", move_names="true"), "--json").document
    assert said["how"] == "driven"
    assert {key: said["settings"][key] for key in ("goals", "busy", "move_names")} == {
        "goals": 2, "busy": True, "move_names": True,
    }  # fmt: skip
    assert [task["name"] for task in said["tasks"]] == ["here", "there"]
    for task in said["tasks"]:
        assert set(task) == {
            "index", "goal", "how", "position", "name", "clock", "start", "map_metres", "agents",
        }  # fmt: skip
        assert list(task["agents"]) == ["lore", "map only"]
        assert all(set(drive) == DRIVE for drive in task["agents"].values())
    assert set(said["summary"]) == {"lore_vs_map_only", "agents"}
    shown = ask(*options)
    for words in ("2 jobs driven in", "there 6.475,1.525: driven ", "in simulation, nothing slows or blocks"):
        assert words in shown.out
    assert "80 %" not in shown.out
    assert "map alone" not in shown.out
    assert "s on the map alone (×" in ask(*options, *changed(busy="true")).out
    assert "log as a folder holds episodes of searches" in ask(*options, "--log", "logs").refusal
    assert "busy applies to goals that are driven to" in ask("live", *changed(busy="true")).refusal


def test_an_interrupted_list_begins_again_by_a_setting(ask, tmp_path):
    path = map_of(office_map(3).state[:300, :300], tmp_path)
    Path("jobs.csv").write_text("name,x,y\nhere,1.475,1.525\n")
    options = ("live", "--map", path, "--goals", "jobs.csv", "--memory", "life.db", "--json")
    assert ask(*options, *changed(again="true")).document["settings"]["again"] is True
    assert "again" not in ask(*options).document["settings"]
    assert "again applies to a job list" in ask("live", *changed(again="true"), "--memory", "no.db").refusal


def test_the_settings_of_hidden_types_reach_the_life():
    keys = setting_keys("tabletop")
    told = {"episodes": 3, "false_alarm": 0.1, "spare": 2, "refresh": True}
    assert set(told) == set(keys.settings) - ELSEWHERE
    values = keys.read([f"{key}={str(value).lower()}" for key, value in told.items()])
    assert values == told
    assert keys.arguments({"tasks": 5, "robot": "bo", "csv": "x"} | values) == told | {
        "tasks": 5,
        "robot": "bo",
    }


def test_every_setting_says_what_it_means(ask):
    for domain in ("building", "tabletop"):
        rows = ask("live", "--domain", domain, "--settings", "--json").document["settings"]
        assert all(len(row["meaning"].split()) >= 3 and row["meaning"].endswith(".") for row in rows)
        lines = ask("live", "--domain", domain, "--settings").out.splitlines()
        assert [line.split()[0] for line in lines[1:]] == [row["key"] for row in rows]
        assert all(row["meaning"] in line for row, line in zip(rows, lines[1:], strict=True))


@pytest.mark.slow
def test_a_log_that_cannot_be_written_is_named(ask):
    said = ask("live", "--tasks", 1, "--memory", "life.db", "--log", "none/life.mcap", "--set", "compare=false")
    assert said.status != 0
    assert "log cannot be written to none/life.mcap: No such file or directory" in said.err
