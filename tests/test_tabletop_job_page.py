"""docs/tabletop_job.md: its Python runs as printed, its tables are those of the code."""

import re
from pathlib import Path

import pytest

from lifelore.domains.tabletop_job.job_types import GRIPPERS, JOB_TYPES, USERS
from tests.page_block import run_block

PAGE = (Path(__file__).parents[1] / "docs" / "tabletop_job.md").read_text(encoding="utf-8")


def cells(name: str) -> list[float]:
    (line,) = (line for line in PAGE.splitlines() if line.startswith(f"| {name} |"))
    return [float(cell) for cell in line.strip("|").split("|")[1:]]


@pytest.mark.parametrize("user", USERS, ids=lambda user: user.name)
def test_the_table_of_users(user):
    expected = [-user.waiting, -user.spill, -user.knock, user.brisk, user.put_aside, user.other_handed]
    assert cells(user.name) == expected


@pytest.mark.parametrize("gripper", GRIPPERS, ids=lambda gripper: gripper.name)
def test_the_table_of_grippers(gripper):
    assert cells(gripper.name) == [1000 * gripper.thickness, gripper.strength, gripper.grip]
    assert f"there are {len(JOB_TYPES)}" in PAGE


@pytest.mark.sim
def test_the_example_runs(tmp_path):
    pytest.importorskip("mujoco", reason="needs the extra sim")
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.S)
    picked, best = run_block("python", code, tmp_path).splitlines()
    assert picked == "True () [ 3  7  9 10]"
    assert best.endswith("['pick', 'hand over briskly']")
