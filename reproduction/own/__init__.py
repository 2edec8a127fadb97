"""Claims of our own: benefits that users were promised, filed and judged like the thesis's."""
