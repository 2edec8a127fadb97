"""The features of the modified factory in the words of the chapter's figures."""

from collections.abc import Sequence

FEATURE_WORDS = {
    "PosUM": "N", "PosML": "W", "PosMR": "E", "PosDM": "S", "PosMM": "own cell",
    "PosUL": "NW", "PosUR": "NE", "PosDL": "SW", "PosDR": "SE",
    "Items": "items", "Noise1": "noise 1", "Noise2": "noise 2",
}  # fmt: skip
"""A cell around the robot goes by its direction from the robot's own cell."""


def features_in_words(names: Sequence[str]) -> list[str]:
    """The features as ticks name them."""
    return [FEATURE_WORDS[name] for name in names]
