"""Starts of a registration: turns and shifts on the table under which two height maps agree, all of them searched.

For each turn, one correlation by FFT gives the score of every shift: cells where both views show objects of the
same height count for it, cells where they contradict each other against it.
"""

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray
from scipy import fft, ndimage

from lifelore.perception.registration.height_map import HeightMap, cells_spanned, height_map, moved_surface
from lifelore.perception.registration.tabletop_view import TabletopView

CELL = 0.015
"""Metres: side of a cell; the refinement finds its way from twice that."""
TURN = np.radians(4.0)
LAYER = 0.03
"""Metres between heights that count as different; a difference of half of it counts half."""
AGAINST = 0.4
"""Weight of a contradicting cell against an agreeing one; at 1, the rims of small objects outweigh their tops."""
STARTS = 8
"""Starts to refine; the true one is the first or second where objects are not alike."""
_MOST_CELLS = 160
_PEAKS = 3
"""Best shifts that a turn proposes."""
_ALIKE_TURN, _ALIKE_SHIFT = np.radians(9.0), 0.04


@dataclass(frozen=True)
class Start:
    """A motion on the table.

    Parameters
    ----------
    score : float
    turn : float
        Radians about the vertical, from 0 to 2π.
    x, y : float
        Metres.
    """

    score: float
    turn: float
    x: float
    y: float

    @property
    def motion(self) -> NDArray[np.float64]:
        """(4, 4) rigid motion."""
        motion = turned(self.turn)
        motion[:2, 3] = self.x, self.y
        return motion

    def is_like(self, other: "Start") -> bool:
        """Whether both lead to the same place."""
        turn = abs((self.turn - other.turn + np.pi) % (2 * np.pi) - np.pi)
        return turn <= _ALIKE_TURN and np.hypot(self.x - other.x, self.y - other.y) <= _ALIKE_SHIFT


def turned(turn: float) -> NDArray[np.float64]:
    """(4, 4) rigid motion: a turn about the vertical."""
    motion = np.eye(4)
    motion[0, :2], motion[1, :2] = (np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))
    return motion


def find_starts(target: TabletopView, source: TabletopView, most: int = STARTS) -> list[Start]:
    """The best motions of `source` onto `target`, the best first, no two alike."""
    cell = max(CELL, float(max(np.ptp(view.surface[:, :2]) for view in (target, source))) / _MOST_CELLS)
    n_layers = int(max(target.objects[:, 2].max(), source.objects[:, 2].max()) / LAYER) + 2
    low, shape = cells_spanned(target.surface, cell)
    widest = int(np.hypot(*np.ptp(source.surface[:, :2], axis=0)) / cell) + 3
    sides = [cast(int, fft.next_fast_len(span + widest, real=True)) for span in shape]
    still = _spectra(_layers(height_map(target.objects, target.table, cell, low, shape), n_layers), sides)
    found = []
    for turn in np.arange(0.0, 2 * np.pi - TURN / 2, TURN):
        objects, table = moved_surface(source, turned(turn))
        corner, span = cells_spanned(np.concatenate([objects, table]), cell)
        layers = _layers(height_map(objects, table, cell, corner, span), n_layers)
        scores = np.asarray(fft.irfft2(_spectrum(still, _spectra(layers, sides).conj()), sides))
        found += [
            Start(score, float(turn), *((shift + low - corner) * cell).tolist())
            for score, shift in _peaks(scores, shape)
        ]
    kept: list[Start] = []
    for start in sorted(found, key=lambda start: -start.score):
        if len(kept) < most and not any(start.is_like(other) for other in kept):
            kept.append(start)
    return kept


def _layers(map: HeightMap, n: int) -> NDArray[np.float32]:
    """(n + 2, nx, ny): weight of each cell in `n` layers of height, then its object, then the bare table."""
    objects = map.objects
    layers = np.empty((n + 2, *objects.shape), np.float32)
    layers[:n] = np.maximum(0.0, 1.0 - np.abs(map.heights / LAYER - np.arange(n)[:, None, None])) * objects
    layers[n], layers[n + 1] = objects, map.seen & ~objects
    return layers


def _spectra(layers: NDArray[np.float32], sides: list[int]) -> NDArray[np.complex64]:
    """Spectrum of each layer, padded to `sides`."""
    return np.asarray(fft.rfft2(layers, sides))


def _spectrum(still: NDArray[np.complex64], moving: NDArray[np.complex64]) -> NDArray[np.complex64]:
    """Spectrum of the scores of all shifts: agreeing cells less `AGAINST` times the contradicting ones."""
    agree = (still[:-2] * moving[:-2]).sum(axis=0)
    both_seen = still[-2] * (moving[-2] + moving[-1]) + still[-1] * moving[-2]
    return (1 + AGAINST) * agree - AGAINST * both_seen


def _peaks(scores: NDArray[np.float32], shape: tuple[int, int]) -> list[tuple[float, NDArray[np.int64]]]:
    """The highest peaks as score and shift in cells, from those that lay one map over the other's edge to none."""
    is_peak = scores == ndimage.maximum_filter(scores, 5, mode="wrap")
    places, values = np.argwhere(is_peak), scores[is_peak]
    best = np.argsort(-values, kind="stable")[:_PEAKS]
    return [(float(values[i]), np.where(places[i] >= shape, places[i] - scores.shape, places[i])) for i in best]
