"""The planted faults: each can be planted in the sources as they are now."""

from tests.mutants.__main__ import FAULTS, wrong_texts


def test_the_text_of_each_fault_is_there_once():
    assert list(wrong_texts(FAULTS)) == []
