"""Whether a computation should start Numba for its compiled kernel or run the NumPy twin of the kernel.

Importing Numba and loading a kernel takes about half a second. A choice for a single user takes milliseconds
without either. The functions between an outcome and a choice therefore exist twice, as a kernel and in NumPy, and
both give the same bits.
"""

import sys

NUMBERS_WORTH_A_START = 1 << 20
"""Size of the work, in numbers, above which Numba is started; NumPy takes about 10 ns for each number."""


def kernel_pays(numbers: int) -> bool:
    """Whether to run the kernel over so many numbers: always where Numba is loaded, else where they are many."""
    return "numba" in sys.modules or numbers > NUMBERS_WORTH_A_START
