"""The page on nav2: its commands run as printed, and its parameters fit each other and the exports."""

import csv
import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml

from lifelore.agent.live.output.known_building import NAV2_FILES, ROUTE_FILE
from lifelore.agent.live.output.report import FILES
from lifelore.domains.buildings.occupancy_map import read_occupancy_map
from tests.page_block import run_block

DOCS = Path(__file__).parents[1] / "docs"
NAV2 = (DOCS / "nav2.md").read_text(encoding="utf-8")
(PARAMETERS,) = (yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", NAV2, flags=re.S))


def parameters(node: str) -> dict:
    return PARAMETERS[node]["ros__parameters"]


def test_every_mask_has_its_server_its_info_and_its_filter():
    costmap = PARAMETERS["global_costmap"]["global_costmap"]["ros__parameters"]
    plugins = {"keepout_filter": "KeepoutFilter", "cost_filter": "KeepoutFilter", "speed_filter": "SpeedFilter"}
    assert costmap["filters"] == list(plugins)
    for name in costmap["filters"]:
        assert costmap[name]["plugin"] == f"nav2_costmap_2d::{plugins[name]}"
        topic = costmap[name]["filter_info_topic"]
        (info,) = [p for p in map(parameters, infos()) if p["filter_info_topic"] == topic]
        # nav2's types of filters: 0 keepout zones and weighted areas, 1 percent of the largest speed.
        assert (info["type"], info["base"], info["multiplier"]) == (int(name == "speed_filter"), 0.0, 1.0)
        (server,) = [p for p in map(parameters, servers()) if p["topic_name"] == info["mask_topic"]]
        assert Path(server["yaml_filename"]).name in NAV2_FILES
    assert set(parameters("lifecycle_manager_filters")["node_names"]) == {*infos(), *servers()}


def test_the_route_server_scores_what_the_graph_holds():
    route = parameters("route_server")
    assert Path(route["graph_filepath"]).name == ROUTE_FILE
    assert [route[name]["plugin"] for name in route["edge_cost_functions"]] == [
        f"nav2_route::{name}" for name in route["edge_cost_functions"]
    ]
    for tag in (route["TimeScorer"]["time_tag"], route["PenaltyScorer"]["penalty_tag"], "blocked"):
        assert f"`metadata.{tag}`" in NAV2


def infos() -> list[str]:
    return [name for name in PARAMETERS if name.endswith("_info_server")]


def servers() -> list[str]:
    return [name for name in PARAMETERS if name.endswith("_mask_server")]


def test_the_table_names_files_that_are_written():
    rows = re.findall(r"^\| (`.*?`) \|", NAV2.split("## What do the masks")[0], flags=re.M)
    named = {name for row in rows for name in re.findall(r"`([^`]+)`", row)}
    assert named == {"paths.csv", *NAV2_FILES}
    assert named <= set(FILES)


@pytest.mark.slow
def test_the_commands_run_as_printed(tmp_path):
    shutil.copytree(DOCS.parent / "examples", tmp_path / "examples")
    live, nav2, to_dock, to_point = [line for line in NAV2.splitlines() if line.startswith("lifelore ")]
    assert "11:15:00 dock 4.975,12.525: driven" in run_block("sh", live, tmp_path)
    assert set(np.unique(read_occupancy_map(tmp_path / "exports" / "keepout.yaml").state)) <= {0, 1}
    written = (tmp_path / "exports" / "route_graph.geojson").read_bytes()
    assert run_block("sh", nav2, tmp_path).startswith("7 files")
    assert (tmp_path / "exports" / "route_graph.geojson").read_bytes() == written
    run_block("sh", to_point, tmp_path)
    with (tmp_path / "way.csv").open(newline="", encoding="utf-8") as file:
        ends = [(float(row["x"]), float(row["y"])) for row in csv.DictReader(file)]
    assert ends[-1] == (4.975, 12.525)
    message = json.loads(run_block("sh", to_dock.split(" > ")[0], tmp_path))
    assert {"header", "poses", "length"} <= set(message)
    for key in message:
        assert f"`{key}`" in NAV2
