"""The pages name what exists, and their Python prints the numbers that they show."""

import json
import re
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.page_block import run_block

DOCS = Path(__file__).parents[1] / "docs"
COURIER = (DOCS / "courier.md").read_text(encoding="utf-8")


PAGES = [
    DOCS.parent / "README.md",
    *sorted(path for path in DOCS.rglob("*.md") if "reproduction" not in str(path)),
]
EXAMPLES = sorted([*(DOCS.parent / "examples").glob("*.py"), *(DOCS.parent / "examples" / "plain").glob("*.py")])
ROOMS = sorted(folder.name for folder in (DOCS.parent / "src" / "lifelore").iterdir() if folder.is_dir())


def exists(dotted: str) -> bool:
    """Whether a dotted name below `lifelore` is a module, or an attribute of a module."""
    parent, _, last = f"lifelore.{dotted}".rpartition(".")
    try:
        module = find_spec(parent)
    except ModuleNotFoundError:
        return False
    if module and module.submodule_search_locations and find_spec(f"{parent}.{last}"):
        return True
    return module is not None and hasattr(import_module(parent), last)


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_modules_and_files_named_on_a_page_exist(page):
    text = re.sub(r"^```.*?^```", "", page.read_text("utf-8"), flags=re.S | re.M)
    rooms = "|".join(room for room in ROOMS if not room.startswith("_"))
    dotted = re.findall(rf"`(?:lifelore\.)?((?:{rooms})(?:\.\w+)+)(?:\([^`]*\))?`", text)
    assert not [name for name in dotted if not exists(name)]
    files = re.findall(rf"`((?:{rooms})/[\w/.]+)`", text)
    assert not [name for name in files if not (DOCS.parent / "src" / "lifelore" / name).exists()]


@pytest.mark.parametrize("page", [*PAGES, *EXAMPLES], ids=lambda path: path.stem)
def test_a_page_imports_from_rooms_alone(page):
    """From `lifelore`, a room, what a room exports as a package of its own, or the file of a bridge."""
    modules = re.findall(r"^ *(?:from|import) (lifelore[\w.]*)", page.read_text("utf-8"), flags=re.M)
    deep = [module for module in modules if module.count(".") > 1 and not module.startswith("lifelore.bridges.")]
    assert not [module for module in deep if not getattr(import_module(module), "__all__", ())]


@pytest.mark.slow
def test_transfer_over_lifetimes_is_what_the_page_says(tmp_path):
    (code,) = re.findall(r"```python\n(.*?)```", COURIER, flags=re.S)
    said = dict(line.split(" ", 1) for line in run_block("python", code, tmp_path).splitlines())
    told = re.findall(r"^\| ([a-z]+)[^|]*\| ([+−\d.]+) \[([−\d.]+), ([−\d.]+)\] \|$", COURIER, flags=re.M)
    assert [word for word, *_ in told] == [
        "forward", "backward", "forgetting", "performance", "jumpstart", "asymptote", "transfer", "time"
    ]  # fmt: skip
    names: dict[str, str] = {
        "performance": "performance_maintenance",
        "transfer": "transfer_ratio",
        "time": "threshold_ratio",
    }
    names |= {"forward": "forward_transfer", "backward": "backward_transfer"}
    for word, *numbers in map(list[str], told):
        estimate = json.loads(said[names.get(word, word)].replace("'", '"'))
        ours = [estimate["value"], *estimate["ci95"]]
        # Compiled returns may differ in their last bits from machine to machine, what is rounded by one digit.
        near = 0.015 if "." in numbers[0] and len(numbers[0].split(".")[1]) == 2 else 0.15
        assert [float(number.replace("−", "-")) for number in numbers] == pytest.approx(ours, abs=near)
