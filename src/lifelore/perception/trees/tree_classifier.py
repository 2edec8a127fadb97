"""`TreeClassifier`: a scikit-learn estimator of extremely randomised trees, stored as arrays."""

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.ensemble import ExtraTreesClassifier
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from lifelore.perception.trees.tree_ensemble import TreeEnsemble


class TreeClassifier(ClassifierMixin, BaseEstimator):
    """Extremely randomised trees whose fitted state is a `TreeEnsemble`.

    Parameters
    ----------
    n_trees : int
    min_leaf : int
        Least training rows in a leaf.
    feature_share : float or "sqrt"
        Share of the columns tried at each split.
    balanced : bool
        Weight classes by the inverse of their frequency.
    random_state : int, optional
    """

    def __init__(
        self,
        n_trees: int = 200,
        min_leaf: int = 2,
        feature_share: float | str = "sqrt",
        balanced: bool = False,
        random_state: int | None = 0,
    ) -> None:
        self.n_trees = n_trees
        self.min_leaf = min_leaf
        self.feature_share = feature_share
        self.balanced = balanced
        self.random_state = random_state

    def fit(self, X: Any, y: Any) -> Self:
        """Train on rows ``(n, d)`` and their classes ``(n,)``."""
        X, y = validate_data(self, X, y)
        check_classification_targets(y)
        self.classes_, codes = np.unique(y, return_inverse=True)
        forest = ExtraTreesClassifier(
            n_estimators=self.n_trees,
            min_samples_leaf=self.min_leaf,
            max_features=self.feature_share,  # type: ignore[arg-type]
            class_weight="balanced" if self.balanced else None,
            random_state=self.random_state,
        )
        self.ensemble_ = TreeEnsemble.from_forest(forest.fit(X, codes))
        return self

    def predict_proba(self, X: Any) -> NDArray[np.float64]:
        """Share of each of ``classes_``, ``(n, n_classes)``, rows sum to 1."""
        check_is_fitted(self)
        rows: Any = validate_data(self, X, reset=False)
        return self.ensemble_.predict_proba(rows)

    def predict(self, X: Any) -> NDArray[Any]:
        """The likeliest class of each row, ``(n,)``."""
        shares = self.predict_proba(X)
        return self.classes_[shares.argmax(axis=1)]
