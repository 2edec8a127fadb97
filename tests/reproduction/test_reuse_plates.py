"""The pictures of policy reuse are drawn from the worlds and the committed result, and the page shows each."""

from pathlib import Path

from docs.pictures.policy_reuse import plates

ROOT = Path(__file__).parents[2]


def test_every_picture_is_drawn_and_shown():
    page = (ROOT / "docs" / "policy_reuse.md").read_text(encoding="utf-8")
    names = []
    for name, figure in plates(ROOT / "reproduction" / "results"):
        assert figure.axes
        assert f"](pictures/{name}.png)" in page
        assert (ROOT / "docs" / "pictures" / f"{name}.png").stat().st_size < 300_000
        names.append(name)
    assert len(set(names)) == 7
