"""The page on nav2: its commands run as printed, and its parameters fit each other and the exports."""

import csv
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

from lifelore.agent.live.output.report import FILES, MASK_FILES
from lifelore.domains.buildings.occupancy_map import read_occupancy_map

DOCS = Path(__file__).parents[1] / "docs"
NAV2 = (DOCS / "nav2.md").read_text(encoding="utf-8")
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
def test_the_commands_run_as_printed(tmp_path):
    shutil.copytree(DOCS.parent / "examples", tmp_path / "examples")
    live, to_dock, to_point = [line for line in NAV2.splitlines() if line.startswith("lifelore ")]
    assert "11:15:00 dock 4.975,12.525: driven" in said(live, tmp_path)
    assert set(np.unique(read_occupancy_map(tmp_path / "exports" / "keepout.yaml").state)) <= {0, 1}
    said(to_point, tmp_path)
    with (tmp_path / "way.csv").open(newline="", encoding="utf-8") as file:
        ends = [(float(row["x"]), float(row["y"])) for row in csv.DictReader(file)]
    assert ends[-1] == (4.975, 12.525)
    message = json.loads(said(to_dock, tmp_path))
    assert {"header", "poses", "from", "to", "length", "places", "contradicted"} == set(message)
    for key in ("from", "to", "length", "places", "contradicted"):
        assert f"`{key}`" in NAV2
