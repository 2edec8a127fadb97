"""`lifelore reproduce`: the thesis's claims, which stand beside the package in a checkout of the repository."""

import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

CHECKOUT = Path(__file__).parents[3]
"""The root of the repository where the package is installed from a checkout (`pip install --editable`)."""


def reproduce_verb() -> Callable[..., None]:
    """The verb of the checkout that this package belongs to; elsewhere one that says where to find it."""
    if not (CHECKOUT / "reproduction" / "command.py").is_file():
        return without_checkout
    if str(CHECKOUT) not in sys.path:
        sys.path.append(str(CHECKOUT))
    return import_module("reproduction.command").reproduce


def without_checkout() -> None:
    """Run claims of the thesis and compare the results (in a checkout of the repository only)."""
    from lifelore.core.errors import InputError

    raise InputError(
        "reproduce runs in a checkout of the repository, which holds the claims and their results; clone it, and "
        "run `make setup` and `.venv/bin/lifelore reproduce` there"
    )
