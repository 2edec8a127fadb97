"""Whether a compiled kernel is worth the start of the compiler.

Importing Numba and loading a kernel takes about half a second; a choice for one user takes milliseconds without
either. So the functions between an outcome and a choice exist twice, as a kernel and in NumPy, with the same bits.
"""

import sys

WORTH_STARTING = 1 << 20
"""Numbers from which the kernel runs though the compiler is not loaded; NumPy takes about 10 ns for each."""


def kernel_pays(numbers: int) -> bool:
    """Whether the kernel and not its NumPy twin should go over so many numbers."""
    return "numba" in sys.modules or numbers > WORTH_STARTING
