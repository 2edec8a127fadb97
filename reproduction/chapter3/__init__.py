"""Claims of chapter 3: action: priors, features, advice.

One folder a claim; the files beside the folders serve several claims.
"""
