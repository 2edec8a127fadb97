"""Which claims are built: a module named after a claim of the ledger (``c3_1`` for C3.1) holds it, as `CLAIM`."""

import pkgutil
from functools import cache
from importlib import import_module
from pathlib import Path

from lifelore.core.errors import NotFoundError
from lifelore.experiments.claim import Claim
from lifelore.experiments.ledger import entries


def built_ids() -> tuple[str, ...]:
    """Ids of the claims that can be run, in the ledger's order; imports none of them."""
    found = {module.name for module in pkgutil.iter_modules([str(Path(__file__).parent)])}
    return tuple(e.id for e in entries() if module_name(e.id) in found)


def module_name(claim_id: str) -> str:
    """Name of the module that would hold a claim: ``C3.1`` to ``c3_1``."""
    return claim_id.lower().replace(".", "_")


@cache
def claim_of(claim_id: str) -> Claim:
    """The claim of an id such as ``C3.1``.

    Raises
    ------
    NotFoundError
        No such claim, or one that is not built yet.
    """
    if claim_id not in built_ids():
        known = any(e.id == claim_id for e in entries())
        state = "is not built yet" if known else "is not in the ledger"
        raise NotFoundError(f"claim '{claim_id}' {state}; built are {', '.join(built_ids())}")
    return import_module(f"lifelore.experiments.{module_name(claim_id)}").CLAIM


def list_claims() -> list[dict]:
    """All claims of the ledger: ``{"claim", "where", "reports", "built"}`` each."""
    built = built_ids()
    return [{"claim": e.id, "where": e.where, "reports": e.reports, "built": e.id in built} for e in entries()]
