"""Which claims there are: the folder ``chapterN/cN_MM_name`` holds claim CN.M, ``own/o_MM_name`` holds our OM."""

import re
from functools import cache
from pathlib import Path

from lifelore.core.errors import NotFoundError
from reproduction.engine.claim import Claim

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
CHAPTERS = {
    "2": "Chapter 2: perception",
    "3": "Chapter 3: action",
    "4": "Chapter 4: interaction",
    "5": "Chapter 5: the abstractions together",
    "own": "Claims of our own",
}
"""Title of each page of claims; those of chapter 5 are ideas, which the thesis proposes without numbers."""
_FOLDER = re.compile(r"(c(?P<chapter>\d)|o)_(?P<number>\d+)_[a-z0-9_]+")


@cache
def claim_folders() -> dict[str, Path]:
    """The folder of each claim by its id, in the thesis's order and our own last; imports none of them."""
    found = {}
    for folder in sorted(ROOT.glob("*/*_*_*/")):
        name = _FOLDER.fullmatch(folder.name)
        if name and (folder / "claim.toml").is_file():
            number = int(name["number"])
            found[f"C{name['chapter']}.{number}" if name["chapter"] else f"O{number}"] = folder
    return found


def claim_ids() -> tuple[str, ...]:
    """Ids of all claims, in order; imports none of them."""
    return tuple(claim_folders())


def chapter_of(claim_id: str) -> str:
    """The key of its page in `CHAPTERS`: ``2`` of ``C2.13``, ``own`` of ``O1``."""
    return claim_id[1] if claim_id.startswith("C") else "own"


@cache
def claim_of(claim_id: str) -> Claim:
    """The claim of an id such as ``C3.1``.

    Raises
    ------
    NotFoundError
        No such claim.
    """
    folder = claim_folders().get(claim_id)
    if folder is None:
        raise NotFoundError(
            f"no claim '{claim_id}'; `lifelore reproduce --list` names the claims and their figures"
        )
    return Claim.load(claim_id, folder, f"reproduction.{folder.parent.name}.{folder.name}")


def found_ids(name: str) -> list[str]:
    """The claims that a person means by an id (``C3.4``) or by the number of a figure or table (``3.7``).

    Raises
    ------
    NotFoundError
        No claim has this id or figure.
    """
    if name in claim_folders():
        return [name]
    found = [claim_id for claim_id in claim_ids() if name in claim_of(claim_id).figure]
    if not found:
        raise NotFoundError(
            f"no claim or figure '{name}'; `lifelore reproduce --list` names the claims and their figures"
        )
    return found


def list_claims() -> list[dict]:
    """All claims: ``{"claim", "figure", "title", "sentence"}`` each."""
    claims = [claim_of(claim_id) for claim_id in claim_ids()]
    return [{"claim": c.id, "figure": list(c.figure), "title": c.title, "sentence": c.sentence} for c in claims]
