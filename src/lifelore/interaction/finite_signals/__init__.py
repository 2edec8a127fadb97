"""Signals from a finite alphabet: probability tables, and bins of real-valued signals.

Read in this order: `signal_table`, `simulated_table`, `normal_distribution`, `signal_bins`.
"""
