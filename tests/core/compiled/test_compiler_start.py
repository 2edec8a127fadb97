"""Small work runs in NumPy, large work starts the compiler."""

from lifelore.core.compiled import compiler_start


def test_large_work_starts_the_compiler(monkeypatch):
    monkeypatch.setattr(compiler_start, "sys", type("Sys", (), {"modules": {}}))
    assert not compiler_start.kernel_pays(compiler_start.NUMBERS_WORTH_A_START)
    assert compiler_start.kernel_pays(compiler_start.NUMBERS_WORTH_A_START + 1)
