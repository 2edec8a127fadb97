"""Which claims are built: the folder ``chapterN/cN_MM_name`` holds claim CN.M."""

import re
from functools import cache
from pathlib import Path

from lifelore.core.errors import NotFoundError
from reproduction.engine.claim import Claim
from reproduction.engine.ledger import entries

CLAIMS = Path(__file__).parents[1]
_FOLDER = re.compile(r"c(\d+)_(\d+)_[a-z0-9_]+$")


@cache
def claim_folders() -> dict[str, Path]:
    """The folder of each claim that can be run, by its id, in the ledger's order; imports none of them."""
    found = {}
    for folder in CLAIMS.glob("chapter*/c*_*"):
        name = _FOLDER.match(folder.name)
        if name and (folder / "claim.toml").is_file():
            found[f"C{int(name[1])}.{int(name[2])}"] = folder
    return {entry.id: found[entry.id] for entry in entries() if entry.id in found}


def built_ids() -> tuple[str, ...]:
    """Ids of the claims that can be run, in the ledger's order; imports none of them."""
    return tuple(claim_folders())


@cache
def claim_of(claim_id: str) -> Claim:
    """The claim of an id such as ``C3.1``.

    Raises
    ------
    NotFoundError
        No such claim, or one that is not built yet.
    """
    folders = claim_folders()
    if claim_id not in folders:
        known = any(e.id == claim_id for e in entries())
        state = "is not built yet" if known else "is not in the ledger"
        raise NotFoundError(f"claim '{claim_id}' {state}; built are {', '.join(folders)}")
    folder = folders[claim_id]
    return Claim.load(claim_id, folder, f"reproduction.{folder.parent.name}.{folder.name}")


def list_claims() -> list[dict]:
    """All claims of the ledger: ``{"claim", "where", "reports", "built"}`` each."""
    built = claim_folders()
    return [{"claim": e.id, "where": e.where, "reports": e.reports, "built": e.id in built} for e in entries()]
