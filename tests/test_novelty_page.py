"""docs/novelty.md: its Python runs as it stands."""

import re
from pathlib import Path

from tests.page_block import run_block

PAGE = (Path(__file__).parents[1] / "docs" / "novelty.md").read_text(encoding="utf-8")


def test_the_examples_run(tmp_path):
    code = "".join(re.findall(r"```python\n(.*?)```", PAGE, flags=re.S))
    known, new, probability = run_block("python", code, tmp_path).splitlines()
    assert float(probability) > 0.9
    assert known.startswith("False None")
    assert new.startswith("True")
