"""One target under atheris, in a process of its own: ``python -m fuzz.one NAME CORPUS [libFuzzer options]``."""

import os
import sys
from contextlib import suppress
from pathlib import Path

import atheris  # pyright: ignore[reportMissingModuleSource]

os.environ["NUMBA_DISABLE_JIT"] = "1"  # Numba cannot compile what atheris has instrumented
with atheris.instrument_imports(include=["lifelore", "pypcd4", "trimesh"]):  # type: ignore[attr-defined]
    from fuzz.targets import targets
    from lifelore.core.errors import LifeloreError

name, corpus, *options = sys.argv[1:]
target = targets()[name]
for number, seed in enumerate(target.seeds):
    (Path(corpus) / f"seed{number}").write_bytes(seed)


def one_input(content: bytes) -> None:
    """Read an input; only a refusal may be raised."""
    with suppress(LifeloreError):
        target.read(content)


atheris.Setup([sys.argv[0], *options, corpus], one_input)
atheris.Fuzz()
