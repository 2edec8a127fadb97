"""`Estimator`: scikit-learn's conventions for classes with settings, without importing scikit-learn.

With them ``clone``, ``cross_val_score`` and ``GridSearchCV`` of scikit-learn take the class. The constructor
stores each argument under its name and unchanged; learned attributes end with an underscore.
"""

import inspect
from typing import Any, Self

from lifelore.core.errors import InputError


class Estimator:
    """Base of classes whose constructor's arguments are their settings."""

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """The constructor's arguments by name; `deep` makes no difference, as no argument is an estimator."""
        return {name: getattr(self, name) for name in inspect.signature(type(self)).parameters}

    def set_params(self, **params: Any) -> Self:
        """Change arguments of the constructor; they take effect with the next `fit`.

        Raises
        ------
        InputError
            A name is no argument, or a value breaks its rule; then nothing changes.
        """
        known = self.get_params()
        if unknown := sorted(set(params) - set(known)):
            raise InputError(f"params must be among {', '.join(known)}, got {', '.join(unknown)}")
        type(self)(**{**known, **params})  # checks the values
        for name, value in params.items():
            setattr(self, name, value)
        return self

    def __sklearn_tags__(self) -> Any:
        """Tags for scikit-learn: the estimator needs targets, and takes scenes, not arrays."""
        from sklearn.utils import InputTags, Tags, TargetTags

        inputs = InputTags(two_d_array=False, one_d_array=False)
        return Tags(estimator_type=None, target_tags=TargetTags(required=True), input_tags=inputs)
