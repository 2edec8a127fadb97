"""The pages for robots: their commands run as printed, and nav2's parameters fit each other and the exports."""

import csv
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

from lifelore.agent.live.report import FILES, MASK_FILES
from lifelore.domains.buildings.occupancy_map import OccupancyMap, read_occupancy_map, write_occupancy_map

DOCS = Path(__file__).parents[1] / "docs"
NAV2 = (DOCS / "nav2.md").read_text(encoding="utf-8")
ROBOTS = (DOCS / "start" / "robots.md").read_text(encoding="utf-8")
(PARAMETERS,) = (yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", NAV2, flags=re.S))


def parameters(node: str) -> dict:
    return PARAMETERS[node]["ros__parameters"]


def test_every_mask_has_its_server_its_info_and_its_filter():
    costmap = PARAMETERS["global_costmap"]["global_costmap"]["ros__parameters"]
    assert len(costmap["filters"]) == 2
    for name in costmap["filters"]:
        assert costmap[name]["plugin"] == "nav2_costmap_2d::KeepoutFilter"
        topic = costmap[name]["filter_info_topic"]
        (info,) = [p for p in map(parameters, infos()) if p["filter_info_topic"] == topic]
        assert (info["type"], info["base"], info["multiplier"]) == (0, 0.0, 1.0)
        (server,) = [p for p in map(parameters, servers()) if p["topic_name"] == info["mask_topic"]]
        assert Path(server["yaml_filename"]).name in MASK_FILES
    assert set(parameters("lifecycle_manager_filters")["node_names"]) == {*infos(), *servers()}


def infos() -> list[str]:
    return [name for name in PARAMETERS if name.endswith("_info_server")]


def servers() -> list[str]:
    return [name for name in PARAMETERS if name.endswith("_mask_server")]


def test_the_table_names_files_that_are_written():
    rows = re.findall(r"^\| (`.*?`) \|", NAV2, flags=re.M)
    named = {name for row in rows for name in re.findall(r"`([^`]+)`", row)}
    assert named == {"paths.csv", "directions.csv", *MASK_FILES}
    assert named <= set(FILES)


def said(line: str, folder: Path) -> str:
    """What a printed command prints, run with a memory of its own."""
    words = shlex.split(line.split(" > ")[0], comments=True)[1:]
    command = [sys.executable, "-m", "lifelore.app.command_line", *words, "--memory", "life.db"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_the_commands_of_own_goals_run_as_printed(tmp_path):
    state = np.zeros((60, 90), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = 1
    write_occupancy_map(tmp_path / "my_building.yaml", OccupancyMap(state, 0.1))
    (jobs,) = re.findall(r"```text\n(time,name,x,y\n.*?)```", ROBOTS, flags=re.S)
    (tmp_path / "jobs.csv").write_text(jobs, encoding="utf-8")
    section = ROBOTS.split("### Your own goals")[1]
    (block,) = re.findall(r"```sh\n(.*?)```", section.split("###")[0], flags=re.S)
    for line in block.splitlines():
        printed = said(line, tmp_path)
        if "--goals" in line:
            assert "task 2: 11:15 dock 2.05,1.55: lore" in printed
    with (tmp_path / "way.csv").open(newline="", encoding="utf-8") as file:
        ends = [(float(row["x"]), float(row["y"])) for row in csv.DictReader(file)]
    assert (ends[0], ends[-1]) == ((2.05, 1.55), (7.25, 4.15))
    assert set(np.unique(read_occupancy_map(tmp_path / "pictures" / "keepout.yaml").state)) <= {0, 1}
    (to_lab, _) = [line for line in NAV2.splitlines() if line.startswith("lifelore way")]
    message = json.loads(said(to_lab, tmp_path))
    assert {"header", "poses", "from", "to", "length", "places", "contradicted"} == set(message)
    for key in ("from", "to", "length", "places", "contradicted"):
        assert f"`{key}`" in NAV2
