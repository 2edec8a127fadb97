"""What the documents say to type can be typed: names of commands and options exist."""

import re
import shlex
from pathlib import Path

import pytest
import typer

from lifelore.app.command_line import app
from lifelore.app.live_command import setting_keys

ROOT = Path(__file__).parents[2]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), ROOT / "Makefile"])


def commands_in(path: Path) -> list[str]:
    """Each `lifelore …` of a shell block, of a Makefile's recipe, or of a span of code in a line."""
    text = path.read_text(encoding="utf-8").replace("\\\n", " ")
    if path.name == "Makefile":
        lines = [line for line in text.splitlines() if line.startswith("\t")]
        return [f"lifelore{found.group(1)}" for line in lines for found in re.finditer(r"/lifelore( .*)", line)]
    blocks = re.findall(r"^```(?:sh|bash|console|shell)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    lines = [line.removeprefix("$ ") for block in blocks for line in block.splitlines()]
    typed = [line[line.index("lifelore ") :] for line in lines if re.match(r"(\S*/)?lifelore ", line)]
    spans = re.findall(r"`(lifelore [^`]+)`", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE))
    return typed + [" ".join(span.split()) for span in spans]


FOUND = [(path, command) for path in DOCUMENTS for command in commands_in(path)]


def understand(command, arguments: list[str], name: str, typed: bool) -> list[str]:
    """Parse as the program would, running nothing; the names of the commands on the way."""
    if hasattr(command, "commands"):
        if not arguments:
            return []
        first, *rest = arguments
        own = {option for parameter in command.params for option in parameter.opts} | {"--help"}
        assert first in command.commands or first in own, f"'{name}' has no command '{first}'"
        return [] if first in own else [first, *understand(command.commands[first], rest, first, typed)]
    known = {option for parameter in command.params for option in parameter.opts} | {"--help"}
    assert {word.split("=")[0] for word in arguments if word.startswith("-")} <= known
    if typed:
        command.make_context(name, arguments)
    if name == "live":
        domain = next((arguments[i + 1] for i, word in enumerate(arguments) if word == "--domain"), "building")
        changed = [arguments[i + 1].partition("=")[0] for i, word in enumerate(arguments) if word == "--set"]
        assert set(changed) - {"KEY"} <= set(setting_keys(domain).settings)
    return []


@pytest.mark.parametrize(("path", "line"), FOUND, ids=[f"{path.name}: {line}" for path, line in FOUND])
def test_what_is_written_can_be_typed(path, line):
    whole = re.split(r"\|| [<>] | &$", line)[0].replace("…", "").replace("...", "")
    arguments = shlex.split(whole, comments=True)[1:]
    span = path.suffix == ".md" and f"`{line}`" in path.read_text(encoding="utf-8")
    understand(typer.main.get_command(app), arguments, "lifelore", typed=not span)


def test_there_is_something_to_type():
    typed = [line for path, line in FOUND if path.name == "README.md"]
    assert any(line.startswith("lifelore live ") for line in typed)
    assert any(path.name == "Makefile" for path, _ in FOUND)
