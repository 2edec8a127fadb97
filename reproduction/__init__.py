"""The thesis's claims, measured: beside the product, in the same repository, not in the wheel.

`engine` runs claims and writes results; a claim is a folder `chapterN/cN_MM_name`; what several claims of a
chapter share lies in the chapter's folder.
"""
