"""Bytes as values of a record, there and back."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lifelore.memory.byte_words import bytes_of, words_of


@given(st.binary(max_size=100), st.binary(max_size=50))
def test_bytes_there_and_back_whatever_lies_behind(content, older):
    words = words_of(content)
    assert words.dtype == np.int64
    assert len(words) == -(-len(content) // 8)
    assert bytes_of(np.concatenate([words, words_of(older)]), len(content)) == content
