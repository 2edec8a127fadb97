"""Signals from a finite alphabet: probability tables, and bins of real-valued signals.

Read in this order: `signal_table`, `signal_bins`.
"""
