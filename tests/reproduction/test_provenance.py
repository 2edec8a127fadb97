"""What a result says it was made on."""

from reproduction.engine.provenance import provenance, versions


def test_libraries_have_a_version():
    assert {"python", "lifelore", "numpy", "scipy", "numba"} <= set(versions())


def test_outside_data_have_a_hash_of_names_and_contents(tmp_path, monkeypatch):
    monkeypatch.delenv("LIFELORE_DATA", raising=False)
    assert provenance(["osd"])["data"] == {"osd": None}

    def hashed(name: str, text: str) -> str:
        folder = tmp_path / f"{name} {text}" / "osd" / "inner"
        folder.mkdir(parents=True)
        (folder / name).write_text(text, encoding="utf-8")
        monkeypatch.setenv("LIFELORE_DATA", str(folder.parents[1]))
        return provenance(["osd"])["data"]["osd"]

    found = [hashed("a", "x"), hashed("a", "y"), hashed("b", "x")]
    assert len(set(found)) == 3
    assert None not in found
