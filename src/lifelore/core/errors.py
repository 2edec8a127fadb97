"""One short tree of errors; each is also the builtin a caller would expect.

    LifeloreError
    ├── InputError (ValueError)         an argument, option or file breaks its rule
    ├── NotFoundError (LookupError)     a named thing does not exist
    ├── MissingExtraError (ImportError) an optional package is not installed
    └── StoreError (OSError)            memory or disk refuses: damaged, foreign, newer, full, read-only

The message names the argument, the rule, what came, and what to do next. The command line prints it
as one line and exits 2.
"""


class LifeloreError(Exception):
    """Base of every error this package raises on purpose."""


class InputError(LifeloreError, ValueError):
    """An argument, option or file breaks its rule."""


class NotFoundError(LifeloreError, LookupError):
    """A named thing does not exist."""


class MissingExtraError(LifeloreError, ImportError):
    """An optional package is not installed; the message says which extra brings it."""


class StoreError(LifeloreError, OSError):
    """Memory or disk refuses: damaged, foreign, newer, full or read-only."""
