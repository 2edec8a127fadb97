import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.baselines import ClusteredUCB
from lifelore.interaction.baselines.clustered_ucb import clusters_of_policies


def test_both_levels_by_hand():
    player = ClusteredUCB(4, clusters=[0, 0, 1, 1], prior_means=[0.5, 0.4, 0.1, 0.6], exploration=0)
    assert [part.tolist() for part in player._representatives()] == [[[2.0, 2.0]], [[0.45, 0.35]]]
    assert player.select() == 0
    best = ClusteredUCB(
        4, clusters=[0, 0, 1, 1], prior_means=[0.5, 0.4, 0.1, 0.6], exploration=0, representative="max"
    )
    assert best._representatives()[1].tolist() == [[0.5, 0.6]]
    assert best.select() == 3


@pytest.mark.parametrize("representative", ["mean", "max"])
def test_a_naive_twin_chooses_the_same(representative):
    generator = np.random.default_rng(1)
    clusters, start = [0, 1, 1, 2, 0], [0.31, 0.52, 0.43, 0.64, 0.25]
    player = ClusteredUCB(
        5, clusters=clusters, prior_means=start, representative=representative, exploration=0.5, seed=2
    )
    sums, counts = list(start), [1] * 5

    def bound(mean, pulls, total):
        return mean + 0.5 * (2 * np.log(total) / pulls) ** 0.5

    for paid in generator.random((60, 5)):
        worth = []
        for cluster in range(3):
            arms = [arm for arm in range(5) if clusters[arm] == cluster]
            pulls = sum(counts[arm] for arm in arms)
            means = [sums[arm] / counts[arm] for arm in arms]
            mean = max(means) if representative == "max" else sum(sums[arm] for arm in arms) / pulls
            worth.append(bound(mean, pulls, sum(counts)))
        arms = [arm for arm in range(5) if clusters[arm] == worth.index(max(worth))]
        total = sum(counts[arm] for arm in arms)
        best = max(arms, key=lambda arm: bound(sums[arm] / counts[arm], counts[arm], total))
        assert player.select() == best
        player.update(best, paid[best])
        sums[best] += paid[best]
        counts[best] += 1


def test_without_a_prior_each_cluster_is_played_before_any_twice():
    player = ClusteredUCB(4, clusters=[0, 1, 1, 2], seed=0, representative="max")
    seen = []
    for _ in range(3):
        seen.append(int(player.clusters[policy := player.select()]))
        player.update(policy, 0.9)
    assert sorted(seen) == [0, 1, 2]


def test_a_cluster_each_is_flat_ucb1(library):
    from lifelore.interaction.baselines import UCB1

    flat = UCB1.from_library(library, seed=1)
    two = ClusteredUCB.from_library(library, clusters=range(4), seed=1)
    for paid in np.random.default_rng(0).random((50, 4)):
        policy = two.select()
        assert flat.select() == policy
        flat.update(policy, paid[policy])
        two.update(policy, paid[policy])


def test_policies_that_do_alike_come_together():
    mean = np.array([[1.0, 0.0, 0.99, 0.02, 0.5], [0.0, 1.0, 0.01, 0.98, 0.5]])
    labels = clusters_of_policies(mean, 3)
    assert labels[0] == labels[2] != labels[1] == labels[3]
    assert len(set(labels.tolist())) == 3
    assert clusters_of_policies(mean).max() + 1 == 3  # ⌈√5⌉
    assert clusters_of_policies([[1.0]]).tolist() == [0]
    # Identical policies cannot be told apart, however many clusters are wanted.
    assert clusters_of_policies(np.ones((2, 4)), 2).max() == 0


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"clusters": [0, 1, 3]}, "numbered from 0 without gaps"),
        ({"clusters": [0, 1]}, "clusters must be 3 whole numbers"),
        ({"clusters": [0.0, 1.0, 1.0]}, "clusters must be 3 whole numbers"),
        ({"clusters": [0, 1, 1], "representative": "median"}, "representative must be one of mean, max"),
    ],
)
def test_bad_settings(settings, said):
    with pytest.raises(InputError, match=said):
        ClusteredUCB(3, **settings)
    with pytest.raises(InputError, match="n_clusters must lie between 1 and 2"):
        clusters_of_policies(np.eye(2), 3)
