"""The benchmark of recognition, small; and the page that cites it."""

import json
from pathlib import Path

import pytest

from benchmarks import bench
from benchmarks.lives import recognition
from lifelore.domains.buildings.office import office_map

ROOT = Path(__file__).parents[2]


def test_a_building_is_recognised_and_others_are_not(monkeypatch):
    monkeypatch.setattr(recognition, "TASKS", 4)
    monkeypatch.setattr(recognition, "VISITS", 1)
    monkeypatch.setattr(recognition, "EDITS", {"turned by 90°": recognition.EDITS["turned by 90°"]})
    monkeypatch.setattr(
        recognition,
        "RESAVED",
        {name: recognition.RESAVED[name] for name in ("the same map", "padded by 7 pixels")},
    )
    small = {"width_m": 16.0, "height_m": 12.0}
    monkeypatch.setattr(recognition, "office_map", lambda seed, *_, **more: office_map(seed, **small, **more))
    monkeypatch.setattr(recognition, "map_from_settings", lambda _: office_map(1, **small))
    steps = []
    result = bench("recognition", repeats=1, progress=lambda *step: steps.append(step[:2]))
    assert steps == [(1, 3), (2, 3), (3, 3)]
    by_name = {row["name"]: row for row in result["rows"]}
    assert by_name["steps of a task, padded by 7 pixels"]["ratio"] == 1.0
    assert by_name["false recognitions among 2 other offices"]["value"] == 0
    assert by_name["missed of 1 offices turned by 90°"]["value"] == 0


def test_the_page_says_what_the_file_holds():
    page = (ROOT / "docs" / "courier.md").read_text()
    rows = {
        row["name"]: row for row in json.loads((ROOT / "results" / "bench_recognition.json").read_text())["rows"]
    }
    for name in recognition.RESAVED:
        row = rows[f"steps of a task, {name}"]
        empty = rows[f"steps of a task, {name}, empty memory"]["value"]
        agree = rows[f"places that agree, {name}"]["value"]
        low, high = row["ci95"]
        line = f"| {name} | {int(100 * agree)} % | {row['value']:,.0f} [{low:,.0f}, {high:,.0f}] | {empty:,.0f} |"
        assert line in page, line
    for name, row in rows.items():
        if name.startswith(("false recognitions", "missed of")):
            assert f"| {name} | {row['value']:.0f} |" in page, name


@pytest.mark.parametrize("name", ["kernels", "buildings"])
def test_other_benchmarks_take_no_map(name):
    from lifelore.core.errors import InputError

    with pytest.raises(InputError, match="courier and recognition"):
        bench(name, map="x.yaml")
