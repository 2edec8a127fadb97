"""docs/fashion_shop.md: its Python and its commands print the lines that it shows (needs the files of `obp`)."""

import re
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.page_block import run_block

PAGE = (Path(__file__).parents[1] / "docs" / "fashion_shop.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(python|sh)\n(.*?)^```", PAGE, flags=re.S | re.M)


@pytest.mark.slow
def test_blocks_print_what_the_page_shows(tmp_path):
    if find_spec("obp") is None:
        pytest.skip("obp, whose package has the logs, is not installed")
    shown = [line for block in BLOCKS for line in run_block(*block, tmp_path).splitlines()]
    assert len(shown) > 15
    assert not [line for line in shown if f"    {line}\n" not in PAGE]
