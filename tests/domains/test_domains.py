"""The room's front door is cheap to import; its names are checked with those of all rooms."""

import subprocess
import sys

import pytest


@pytest.mark.slow
def test_importing_registers_and_loads_nothing_heavy():
    code = (
        "import sys, gymnasium; before = set(sys.modules); import lifelore.domains; "
        "new = {name.split('.')[0] for name in set(sys.modules) - before}; "
        "assert 'lifelore/Building-v0' in gymnasium.registry; print(' '.join(sorted(new)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["lifelore"]
