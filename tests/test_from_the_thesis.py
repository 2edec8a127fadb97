"""The page from the thesis to the code: it is complete, its names exist, and its blocks run in its order."""

import re
from importlib import import_module
from pathlib import Path

import pytest

import lifelore
from lifelore.domains import ENVIRONMENTS
from tests.page_block import run_block

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "from_the_thesis.md").read_text("utf-8")
ROWS = [line.strip("| ").split(" | ") for line in PAGE.splitlines() if line.startswith("| ")]
ROOMS = ("core", "perception", "action", "interaction", "domains", "agent")
NAMES = {name for room in ROOMS for name in import_module(f"lifelore.{room}").__all__} | set(lifelore.__all__)

SECTIONS = set(Path(__file__).with_name("thesis_sections.txt").read_text("utf-8").split())
"""The numbered sections of the thesis."""
DEFINITIONS = {f"3.2.{n}" for n in range(1, 9)} | {"4.3.1", "4.3.2", "4.3.3", "4.3.4", "4.4.1", "4.4.2", "4.4.3"}
"""Definitions, the theorem and the propositions."""
EQUATIONS = {f"3.{n}" for n in range(1, 17)} | {f"4.{n}" for n in range(1, 10)}
ALGORITHMS = {str(n) for n in range(1, 10)}
FIGURES = {f"{chapter}.{n}" for chapter, last in ((1, 1), (2, 10), (3, 23), (4, 20)) for n in range(1, last + 1)}


def numbered(label: str, text: str) -> set[str]:
    """The numbers behind a label such as "Eq." in a text, with ranges such as "Eq. 3.2 – 3.5" spelt out."""
    found = set()
    for part in re.findall(rf"{label} ((?:[\d.]*\d)(?:(?:, | – )[\d.]*\d)*)", text):
        for one in part.split(", "):
            first, *rest = one.split(" – ")
            stem, _, low = first.rpartition(".")
            last = int(rest[0].rpartition(".")[2]) if rest else int(low)
            found |= {f"{stem}.{n}".lstrip(".") for n in range(int(low), last + 1)}
    return found


def test_every_algorithm_equation_and_definition_has_its_row():
    items = "\n".join(row[0] for row in ROWS)
    assert numbered("Alg.", items) == ALGORITHMS
    assert numbered("Eq.", items) == EQUATIONS
    assert numbered("Def.", items) | numbered("Thm.", items) | numbered("Prop.", items) == DEFINITIONS
    assert {f"`{name}`" for name in ENVIRONMENTS} == {row[2] for row in ROWS if row[-1].startswith("`lifelore/")}


def test_every_name_of_a_row_can_be_imported_from_a_room():
    names = [name for row in ROWS for name in re.findall(r"`([A-Za-z]\w+)`", row[1])]
    assert len(names) > 60
    assert not [name for name in names if name not in NAMES]


def test_every_attribute_that_the_page_names_exists():
    homes = [import_module(f"lifelore.{room}") for room in ROOMS]
    owners = {name: getattr(home, name) for home in homes for name in home.__all__}
    named = {
        (name.title() if name.islower() else name, part)
        for name, part in re.findall(r"`([A-Za-z]+)\.([a-z_]+)", PAGE)
    }
    assert {("Scene", "networks"), ("LongLivedAgent", "curiosity")} <= named
    assert not [(name, part) for name, part in named if name in owners and not hasattr(owners[name], part)]


def test_a_docstring_cites_what_the_thesis_has():
    wrong = []
    for file in sorted((ROOT / "src" / "lifelore").rglob("*.py")):
        for cited in re.findall(r"Thesis: ((?:[^\"\n]|\n(?! *\n))*)", file.read_text("utf-8")):
            for kind, known in (
                ("§", SECTIONS),
                (r"Alg(?:orithm|\.) ", ALGORITHMS),
                (r"Eq(?:uation|\.) ", EQUATIONS),
                (r"Def(?:inition|\.) ", DEFINITIONS),
                (r"Fig(?:ure|\.) ", FIGURES),
            ):
                wrong += [
                    f"{file.name}: {kind}{n}"
                    for n in re.findall(kind + r"(\d+(?:\.\d+)*)", cited)
                    if n not in known
                ]
    assert not wrong


@pytest.mark.slow
def test_the_blocks_run_in_the_order_of_the_page(tmp_path):
    code = "\n".join(re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.S | re.M))
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    said = run_block("python", code, tmp_path)
    for words in ("contact points", "relation='on'", "Advice(advise=True", "[0. 1.] B", "Discrete(4)"):
        assert words in said
