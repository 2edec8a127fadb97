"""docs/novelty.md: its Python runs as it stands."""

import re
from pathlib import Path

PAGE = (Path(__file__).parents[1] / "docs" / "novelty.md").read_text(encoding="utf-8")


def test_the_examples_run(capsys):
    code = "".join(re.findall(r"```python\n(.*?)```", PAGE, flags=re.S))
    exec(compile(code, "novelty.md", "exec"), {"__name__": "page"})
    known, new, probability = capsys.readouterr().out.splitlines()
    assert float(probability) > 0.9
    assert known.startswith("False None")
    assert new.startswith("True")
