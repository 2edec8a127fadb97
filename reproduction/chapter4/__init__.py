"""Claims of chapter 4: interaction: Bayesian policy reuse and BEAT.

One folder a claim; the files beside the folders serve several claims.
"""
