"""What a result says it was made on."""

import pytest

from reproduction.engine.provenance import provenance, versions
from reproduction.engine.registry import claim_of
from reproduction.engine.source_key import foreign_modules

MODULE = claim_of("C3.1").run_cell.__module__


def test_every_library_that_the_code_imports_has_a_version():
    simulated = claim_of("C5.8").run_cell.__module__
    assert "mujoco" in foreign_modules(simulated) - foreign_modules(MODULE)
    assert not foreign_modules(MODULE) & {"json", "lifelore", "collections"}
    assert {"python", "lifelore", "numpy", "scipy", "numba"} <= set(versions(MODULE))
    pytest.importorskip("mujoco", reason="needs the extra sim")
    assert "mujoco" in versions(simulated)
    assert "mujoco" not in versions(MODULE)


def test_outside_data_have_a_hash_of_names_and_contents(tmp_path, monkeypatch):
    monkeypatch.delenv("LIFELORE_DATA", raising=False)
    assert provenance(MODULE, ["osd"])["data"] == {"osd": None}

    def hashed(name: str, text: str) -> str:
        folder = tmp_path / f"{name} {text}" / "osd" / "inner"
        folder.mkdir(parents=True)
        (folder / name).write_text(text, encoding="utf-8")
        monkeypatch.setenv("LIFELORE_DATA", str(folder.parents[1]))
        return provenance(MODULE, ["osd"])["data"]["osd"]

    found = [hashed("a", "x"), hashed("a", "y"), hashed("b", "x")]
    assert len(set(found)) == 3
    assert None not in found
