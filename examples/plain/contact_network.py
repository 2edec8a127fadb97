"""Contact point networks and spatial relations of two objects (thesis §2.3, Algorithm 1).

A support vector machine separates the two clouds. Clusters of its support vectors are the contact points of each
object, and a minimum spanning tree joins them. A displacement between contact points gets the relation that its
nearest neighbours among labelled displacements vote for. Scikit-learn solves the support vector machine.

    python examples/plain/contact_network.py
"""

import numpy as np
from sklearn.svm import SVC

LENGTH, COST = 0.06, 10.0  # kernel length in metres and C; the thesis gives neither
LINKAGE, LEAST = 0.025, 7  # support vectors closer than this are one contact; smaller clusters are discarded


def support_vectors(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Support vectors of either object under a Gaussian kernel (lines 2 and 3)."""
    points, side = np.concatenate([first, second]), np.repeat([0, 1], [len(first), len(second)])
    svm = SVC(C=COST, kernel="rbf", gamma=1 / (2 * LENGTH**2)).fit(points, side)
    return points[svm.support_[svm.support_ < len(first)]], points[svm.support_[svm.support_ >= len(first)]]


def clusters(points: np.ndarray) -> list[np.ndarray]:
    """Connected components of points at most `LINKAGE` apart, without those below `LEAST` (line 5)."""
    near = np.linalg.norm(points[:, None] - points, axis=2) <= LINKAGE
    left, found = set(range(len(points))), []
    while left:
        member, waiting = set(), [left.pop()]
        while waiting:
            i = waiting.pop()
            member.add(i)
            joined = left.intersection(np.flatnonzero(near[i]).tolist())
            left -= joined
            waiting += joined
        found.append(points[sorted(member)])
    return [cluster for cluster in found if len(cluster) >= LEAST]


def spanning_tree(nodes: np.ndarray) -> list[tuple[int, int]]:
    """Edges of the minimum weighted spanning tree by Euclidean distance (line 6; Prim)."""
    inside, edges = [0] if len(nodes) else [], []
    while len(inside) < len(nodes):
        outside = [k for k in range(len(nodes)) if k not in inside]
        _, i, k = min((np.linalg.norm(nodes[i] - nodes[k]), i, k) for i in inside for k in outside)
        inside.append(k)
        edges.append((i, k))
    return edges


def contact_networks(first: np.ndarray, second: np.ndarray):
    """Nodes and edges of both objects' networks (lines 2 to 8)."""
    networks = []
    for vectors in support_vectors(first, second):
        nodes = np.array([cluster.mean(axis=0) for cluster in clusters(vectors)]).reshape(-1, 3)
        networks.append((nodes, spanning_tree(nodes)))
    return networks


def displacements(first_nodes: np.ndarray, second_nodes: np.ndarray) -> np.ndarray:
    """d_mn = χ_m - χ_n of all pairs of contact points, (M N, 3) (line 11)."""
    return (first_nodes[:, None] - second_nodes).reshape(-1, 3)


def vote(query: np.ndarray, known: np.ndarray, labels: list[str], k: int = 3) -> tuple[str, float]:
    """The most common label among the k nearest labelled displacements, and its share (lines 12 and 13)."""
    nearest = [labels[i] for i in np.linalg.norm(known - query, axis=1).argsort(kind="stable")[:k]]
    name = max(sorted(set(nearest)), key=nearest.count)
    return name, nearest.count(name) / len(nearest)


def box(corner, size, spacing=0.006) -> np.ndarray:
    """Points on the faces of a box; corner and size in metres."""
    axes = [np.arange(0, length + 1e-9, spacing) for length in size]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    ends = [axis[[0, -1]] for axis in axes]
    on_face = np.any([np.isin(grid[:, i], ends[i]) for i in range(3)], axis=0)
    return grid[on_face] + corner


def main() -> None:
    generator, known, labels = np.random.default_rng(0), [], []
    lower = box((0, 0, 0), (0.06, 0.06, 0.06))
    for _ in range(4):  # labelled pairs: another box on the first, or beside it
        x, y = generator.uniform(-0.02, 0.02, 2)
        for corner, label in (((x, y, 0.063), "on"), ((0.063, y, 0.0), "adjacent")):
            (first, _), (second, _) = contact_networks(box(corner, (0.06, 0.06, 0.06)), lower)
            for d in displacements(first, second):
                known.append(d)
                labels.append(label)
    for corner in ((0.01, 0.01, 0.064), (0.064, 0.005, 0.0)):
        (first, edges), (second, _) = contact_networks(box(corner, (0.06, 0.06, 0.06)), lower)
        votes = [vote(d, np.array(known), labels) for d in displacements(first, second)]
        print(f"{len(first)} and {len(second)} contact points, {len(edges)} edges:", *votes)


if __name__ == "__main__":
    main()
