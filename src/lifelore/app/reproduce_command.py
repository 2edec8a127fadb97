"""`lifelore reproduce`: the thesis's claims, which stand beside the package in a checkout of the repository."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Annotated

import typer

CHECKOUT = Path(__file__).parents[3]
"""The root of the repository where the package is installed from a checkout (`pip install --editable`)."""


def add_reproduce(app: typer.Typer) -> None:
    """Add the verb of the checkout that this package belongs to; elsewhere one that says where to find it."""
    if (CHECKOUT / "reproduction" / "command.py").is_file():
        if str(CHECKOUT) not in sys.path:
            sys.path.append(str(CHECKOUT))
        app.command("reproduce")(import_module("reproduction.command").reproduce)
    else:
        app.command("reproduce", context_settings={"ignore_unknown_options": True})(without_checkout)


def without_checkout(
    claims: Annotated[list[str] | None, typer.Argument(metavar="[CLAIM|FIGURE]...", help="As there.")] = None,
) -> None:
    """Run claims of the thesis and compare the results (in a checkout of the repository only)."""
    from lifelore.core.errors import InputError

    raise InputError(
        "reproduce runs in a checkout of the repository, which holds the claims and their results; clone it, and "
        "run `make setup` and `.venv/bin/lifelore reproduce` there"
    )
