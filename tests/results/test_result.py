"""A new kind of result is one class: what it declares is its record, HTML, table, data set and picture."""

from dataclasses import dataclass

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu import Chain, InputError, __version__, load, save
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields
from symfpu.results.grid import Grid, Variable
from symfpu.results.result import Gridded
from tests.elements import read
from tests.store.test_saved_file import same


@dataclass(frozen=True, eq=False)
class Spread(Gridded):
    """Of energies in time."""

    chain: Chain
    times: np.ndarray
    sizes: np.ndarray

    def _answer(self):
        return "it grows"

    def _fields(self):
        yield from chain_fields(self.chain)
        yield Field("largest", 2.0, "largest size", "2.0 units")
        yield Field("slope", float("nan"))

    def _grid(self):
        sizes = Variable(("time",), self.sizes, "size")
        return Grid({"time": self.times}, {"size": sizes}, attributes(self, self.chain), ("time",))


@pytest.fixture
def spread():
    return Spread(Chain(4, alpha="0.3"), np.array([0.0, 1.0]), np.array([1.0, 2.0]))


def test_its_record_has_its_fields(spread):
    law = {"N": 4, "alpha": "0.3", "beta": "0"}
    assert spread.record() == {"kind": "Spread", "symfpu_version": __version__, **law, "largest": 2.0, "slope": "nan"}


def test_its_html_has_its_answer_and_what_has_a_label(spread):
    page = read(spread._repr_html_())
    assert page.text.split("\n") == ["", "Spread: it grows", "chainN=4, alpha=0.3largest size2.0 units", ""]
    assert page.images == []


def test_it_is_a_table_and_a_data_set(spread):
    assert spread.to_frame().to_dict("list") == {"time": [0.0, 1.0], "size": [1.0, 2.0]}
    assert spread.to_xarray()["size"].dims == ("time",)


def test_it_is_kept_in_a_file(spread, tmp_path):
    back = load(save(tmp_path / "spread", spread))
    assert type(back) is Spread
    assert same(back, spread)


def test_without_a_picture_it_says_where_pictures_are(spread):
    with pytest.raises(InputError, match=r"see symfpu\.plots"):
        spread.plot(Figure().add_subplot())
