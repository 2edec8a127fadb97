"""The errors this package raises; each is also the builtin error that a caller expects.

    LifeloreError
    ├── InputError (ValueError)         an argument, option or file breaks its rule
    ├── NotFoundError (LookupError)     no object has this name
    ├── MissingExtraError (ImportError) an optional package is not installed
    └── StoreError (OSError)            memory or disk refuses: damaged, foreign, newer, full, read-only

The message names the argument, the rule, the value and the next step. The command line prints it as one
line and exits 2.
"""


class LifeloreError(Exception):
    """Base of every error that this package raises on purpose.

    Examples
    --------
    >>> from lifelore import ActionPrior
    >>> try:
    ...     ActionPrior(n_actions=0)
    ... except LifeloreError as error:
    ...     print(error)
    n_actions must be at least 1, got 0
    """


class InputError(LifeloreError, ValueError):
    """An argument, option or file breaks its rule.

    Examples
    --------
    >>> issubclass(InputError, ValueError)
    True
    """


class NotFoundError(LifeloreError, LookupError):
    """No object has this name.

    Examples
    --------
    >>> issubclass(NotFoundError, LookupError)
    True
    """


class MissingExtraError(LifeloreError, ImportError):
    """An optional package is not installed; the message says which extra brings it.

    Examples
    --------
    >>> issubclass(MissingExtraError, ImportError)
    True
    """


class StoreError(LifeloreError, OSError):
    """Memory or disk refuses: damaged, foreign, newer, full or read-only.

    Examples
    --------
    >>> issubclass(StoreError, (LifeloreError, OSError))
    True
    """
