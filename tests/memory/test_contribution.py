import numpy as np
import pytest

from lifelore.core import Record, StoreError
from lifelore.memory.contribution import Contribution
from lifelore.memory.record_blob import pack
from lifelore.memory.record_rules import checked_records


def make(stamp=77):
    record = Record("k", "y", 1, "add", np.array([2, 1]), np.array([20, 10]), {"unit": "m"})
    return Contribution.packed(("r", "p", 3), stamp, '{"goal":[1,2]}', pack(checked_records([record])))


def test_records_come_back():
    (record,) = make().records()
    assert (record.slots.tolist(), record.values.tolist(), record.about) == ([1, 2], [10, 20], {"unit": "m"})


def test_equal_contributions_have_equal_digests():
    assert make() == make()
    assert make().digest != make(78).digest


@pytest.mark.parametrize(
    "change", [{"robot": "s"}, {"process": "q"}, {"seq": 4}, {"stamp": 78}, {"task": "{}"}, {"digest": "0" * 64}]
)
def test_any_change_is_noticed(change):
    with pytest.raises(StoreError, match="SHA-256"):
        make()._replace(**change).records()


def test_the_order_is_total():
    assert make().order == (77, "r", "p", 3)
    assert make().identity == ("r", "p", 3)
