"""The search for starts: its correlation beside a plain count of cells, and a turned table."""

import numpy as np
from scipy import fft

from lifelore.perception.registration import start_search
from lifelore.perception.registration.height_map import UNSEEN, HeightMap
from lifelore.perception.registration.start_search import AGAINST, LAYER, Start, find_starts, turned


def drawn_map(rng: np.random.Generator, shape: tuple[int, int]) -> HeightMap:
    heights = rng.choice([UNSEEN, 0.0, 0.03, 0.05, 0.075], shape)
    return HeightMap(heights, np.zeros(2, np.int64))


def counted(still: HeightMap, moving: HeightMap, dx: int, dy: int) -> float:
    """The score of a shift, cell by cell."""
    score = 0.0
    for x in range(moving.heights.shape[0]):
        for y in range(moving.heights.shape[1]):
            i, j = x + dx, y + dy
            if not (0 <= i < still.heights.shape[0] and 0 <= j < still.heights.shape[1]):
                continue
            first, second = still.heights[i, j], moving.heights[x, y]
            if UNSEEN in (first, second) or first == second == 0.0:
                continue
            # A height between two layers is in both: two hats overlap as the heights are alike.
            hats = [np.maximum(0.0, 1.0 - np.abs(h / LAYER - np.arange(4))) * (h > 0.0) for h in (first, second)]
            score += (1 + AGAINST) * float(hats[0] @ hats[1]) - AGAINST
    return score


def test_the_correlation_is_the_count_of_every_shift() -> None:
    rng = np.random.default_rng(3)
    still, moving, sides = drawn_map(rng, (5, 4)), drawn_map(rng, (3, 4)), (9, 9)
    spectra = [fft.rfft2(start_search._layers(map, 4), sides) for map in (still, moving)]
    scores = fft.irfft2(start_search._spectrum(spectra[0], spectra[1].conj()), sides)
    for dx in range(-2, 5):
        for dy in range(-3, 4):
            np.testing.assert_allclose(scores[dx, dy], counted(still, moving, dx, dy), atol=1e-4)


def test_a_turned_table_is_found_first(blocks_seen) -> None:
    still = blocks_seen()
    found = find_starts(still, blocks_seen(turned(np.radians(-70.0))))
    # The middles of the objects lie at both origins, by boxes that the turn changes.
    first = found[0]
    assert abs(np.degrees(first.turn) - 70.0) <= 4.0
    assert np.hypot(first.x, first.y) < 0.1
    assert all(start.score <= first.score for start in found)


def test_starts_are_alike_where_turn_and_shift_are_near() -> None:
    start = Start(1.0, 0.02, 0.0, 0.0)
    assert start.is_like(Start(0.5, 2 * np.pi - 0.02, 0.03, 0.0))
    assert not start.is_like(Start(0.5, 0.3, 0.0, 0.0))
    assert not start.is_like(Start(0.5, 0.02, 0.03, 0.03))
    np.testing.assert_allclose(Start(1.0, np.pi / 2, 2.0, 3.0).motion @ [1, 0, 0, 1], [2, 4, 0, 1], atol=1e-12)
