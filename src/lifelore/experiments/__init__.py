"""The thesis's claims as measured experiments, and the benchmarks."""
