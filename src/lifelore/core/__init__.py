"""The common language: MDPs and policies as arrays, kernels for them, random streams, errors, metrics."""
