"""Claims of chapter 5: the abstractions together, and future work.

One folder a claim; the files beside the folders serve several claims.
"""
