"""Claims of our own: benefits that the thesis does not claim, filed and judged as its claims are."""
