"""The room's front door: cheap to import, complete, and honest about its names."""

import subprocess
import sys

import pytest

import lifelore.domains as domains


def test_every_public_name_can_be_imported_and_every_home_is_public():
    for name in domains.__all__:
        assert getattr(domains, name) is not None
        assert name in dir(domains)
    assert set(domains._HOME) | {"ENVIRONMENTS"} == set(domains.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        domains.nothing  # noqa: B018


@pytest.mark.slow
def test_importing_registers_and_loads_nothing_heavy():
    code = (
        "import sys, gymnasium; before = set(sys.modules); import lifelore.domains; "
        "new = {name.split('.')[0] for name in set(sys.modules) - before}; "
        "assert 'lifelore/Building-v0' in gymnasium.registry; print(' '.join(sorted(new)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["lifelore"]
