"""Runs every kernel under the separator on small clouds: ``python separator_kernels_run.py OUT.npz``.

Started by the tests in processes of their own, compiled and as plain Python.
"""

import sys

import numpy as np


def all_arrays() -> dict[str, np.ndarray]:
    """Every array that the kernels leave behind, by name."""
    from lifelore.perception.separation.far_field import far_field, far_field_cells
    from lifelore.perception.separation.gaussian import kernel_row, kernel_sums
    from lifelore.perception.separation.separator import separate
    from lifelore.perception.separation.separator_smo import ascend

    random, out = np.random.default_rng(0), {}
    points, sources, weights = random.uniform(0, 0.5, (3, 30)), random.normal(size=(3, 9)), random.normal(size=9)
    out["row"], out["sums"] = np.empty(30), np.empty(30)
    kernel_row(points, 3, out["row"])
    kernel_sums(points, sources, weights, np.arange(30), out["sums"])
    out["far sums"], out["far error"] = far_field(
        points, far_field_cells(points, np.array([0, 13, 30])), sources, weights, 4
    )
    side = np.where(points[0] > 0.25, 1.0, -1.0)
    beta, slope = np.zeros(30), side.copy()
    steps = ascend(points, np.minimum(side, 0), np.maximum(side, 0), beta, slope, 1e-3, 500)
    out |= {"steps": np.array(steps), "beta": beta, "slope": slope}
    for tolerance in (1e-2, 1e-4):
        first = random.uniform(0, 0.1, (40, 3))
        found = separate(first, first[:30] + np.array([0.08, 0, 0]), length=0.1, cost=2.0, tolerance=tolerance)
        out[f"alpha {tolerance}"] = np.concatenate([found.alpha_first, found.alpha_second])
        out[f"support {tolerance}"] = np.concatenate([found.support_first, found.support_second])
        out[f"rest {tolerance}"] = np.array([found.bias, found.max_violation])
    return out


if __name__ == "__main__":
    np.savez(sys.argv[1], **all_arrays())  # type: ignore[arg-type]
