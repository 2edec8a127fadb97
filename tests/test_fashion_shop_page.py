"""docs/fashion_shop.md: its Python and its commands print the lines that it shows (needs the files of `obp`)."""

import re
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.page_block import run_block

PAGE = (Path(__file__).parents[1] / "docs" / "fashion_shop.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(python|sh)\n(.*?)^```", PAGE, flags=re.S | re.M)


def measured() -> list[tuple[str, str, list[float]]]:
    """Campaign, policy, and estimate, interval, measured rate, interval and effective users of each line shown."""
    number = r"(-?[\d.]+)"
    interval = rf"{number} \[ *{number} +{number} *\]"
    lines = re.findall(
        rf"^    (\w+) (\w+) estimated {interval} measured {interval} {number} effective", PAGE, re.M
    )
    return [(campaign, policy, [float(value) for value in values]) for campaign, policy, *values in lines]


def test_the_page_says_what_its_lines_show():
    found = measured()
    assert len(found) == 6
    for _, policy, (value, low, high, truth, *_, effective) in found:
        assert low <= value <= high
        if policy == "bts":
            assert low <= truth <= high
            assert effective > 2500
    assert min(values[-1] for _, _, values in found) < 20


@pytest.mark.slow
def test_blocks_print_what_the_page_shows(tmp_path):
    if find_spec("obp") is None:
        pytest.skip("obp, whose package has the logs, is not installed")
    shown = [line for block in BLOCKS for line in run_block(*block, tmp_path).splitlines()]
    assert len(shown) > 15
    assert not [line for line in shown if f"    {line}\n" not in PAGE]
