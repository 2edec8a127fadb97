"""Benchmarks of whole lives: the courier, buildings that grow or are saved again, and foreign worlds."""
