"""`lifelore` as a whole: nothing heavy for its help, one line for a mistake, and what every command has."""

import ast
import re
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest
import typer

import lifelore
from lifelore.app import command_line
from lifelore.domains.worlds import domain_names

COMMANDS_PAGE = Path(__file__).parents[2] / "docs" / "commands.md"

HEAVY = ("numba", "sklearn", "matplotlib", "sqlite3", "scipy", "gymnasium", "numpy")
TOLD_WHAT_IT_IMPORTED = """
import sys
from lifelore.app.command_line import run
status = run(sys.argv[1:])
print(status, sorted(sys.modules), file=sys.stderr)
"""


@pytest.mark.parametrize("arguments", [["--help"], ["live", "--help"], ["reproduce", "--help"]], ids=" ".join)
def test_help_imports_nothing_heavy(arguments):
    done = subprocess.run(
        [sys.executable, "-c", TOLD_WHAT_IT_IMPORTED, *arguments], capture_output=True, text=True, check=True
    )
    status, imported = done.stderr.split(" ", 1)
    assert status == "0"
    assert set(HEAVY) & set(ast.literal_eval(imported)) == set()
    assert done.stdout


def test_the_installed_program_is_this_command_line():
    (entry,) = entry_points(group="console_scripts", name="lifelore")
    assert entry.load() is command_line.main


def test_version(ask):
    assert ask("version").out == f"{lifelore.__version__}\n"
    assert ask("--version").out == f"{lifelore.__version__}\n"
    assert ask("version", "--json").document == {"version": lifelore.__version__}


@pytest.mark.parametrize("arguments", [[], ["memory"]], ids=["lifelore", "lifelore memory"])
def test_nothing_asked_is_answered_with_the_help(arguments, ask):
    answer = ask(*arguments)
    assert (answer.status, answer.out) == (2, "")
    assert answer.err.strip() == ask(*arguments, "--help").out.strip()


def test_main_leaves_with_the_status(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["lifelore", "version", "--nonsense"])
    with pytest.raises(SystemExit) as left:
        command_line.main()
    assert left.value.code == 2
    with pytest.raises(SystemExit) as left:
        command_line.main(["version"])
    assert left.value.code == 0


def leaves(command, path: tuple[str, ...] = ()):
    """(path, command) of every command that does something."""
    for name, part in getattr(command, "commands", {}).items():
        yield from leaves(part, (*path, name))
    if not hasattr(command, "commands"):
        yield path, command


@pytest.mark.parametrize("group", [[], ["memory"], ["reuse"]], ids=["lifelore", "memory", "reuse"])
def test_no_sentence_of_a_list_of_commands_is_cut_off(group, ask, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    listed = ask(*group, "--help").out.split("Commands:\n")[1]
    assert len(listed.splitlines()) >= 5
    assert "..." not in listed


def test_help_lists_every_domain(ask):
    for verb in ("live", "teach"):
        shown = " ".join(ask(verb, "--help").out.split())
        assert [name for name in domain_names() if name not in shown.split("--domain")[1][:120]] == []


COMMANDS = dict(leaves(typer.main.get_command(command_line.app)))
LONG_HELP = {("reuse", "fit"): 58, ("reuse", "evaluate"): 62}
"""Lines of the help texts that exceed a screen."""


def test_the_page_of_commands_lists_every_command_and_no_other():
    rows = re.findall(r"^\| *`lifelore ([a-z0-9 -]+)` *\|", COMMANDS_PAGE.read_text("utf-8"), re.MULTILINE)
    assert sorted(rows) == sorted(map(" ".join, COMMANDS))


@pytest.mark.parametrize("path", COMMANDS, ids=" ".join)
def test_every_command_has_json_and_says_what_it_is_on_a_screen(path, ask, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    command = COMMANDS[path]
    assert "--json" in {name for parameter in command.params for name in parameter.opts}
    assert len(command.help.split()) >= 3
    assert all(parameter.help for parameter in command.params if "-" in parameter.opts[0])
    answer = ask(*path, "--help")
    assert (answer.status, answer.err) == (0, "")
    assert "--json" in answer.out
    lines = answer.out.splitlines()
    assert len(lines) <= LONG_HELP.get(path, 41)
    assert max(map(len, lines)) <= 80


@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_output_to_a_full_disk_is_one_line(unbuffered, start, answer, monkeypatch):
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    with open("/dev/full", "w") as full:
        said = answer(start("version", stdout=full))
    assert "the output cannot be written: No space left" in said.refusal


def test_a_reader_that_goes_away_is_no_mistake(start, known):
    process = start("memory", "show", "--memory", known)
    process.stdout.close()
    assert (process.wait(), process.stderr.read()) == (0, "")
