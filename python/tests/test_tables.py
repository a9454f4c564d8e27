"""Tables in the forms of other packages."""

import numpy as np
import pytest


@pytest.fixture(scope="module")
def table(small, design):
    return small.evaluate([design, "delta:53:60/6/1@1000+star:90:40/5/1@1100"])


def test_pandas(table):
    frame = table.to_pandas()
    assert list(frame.columns) == table.columns and len(frame) == 2
    assert frame["mean_pdop"][0] == table["mean_pdop"][0]
    assert frame["inclination_deg"].isna().tolist() == [False, True]


def test_polars_and_arrow_take_the_stream(table):
    polars = pytest.importorskip("polars")
    pyarrow = pytest.importorskip("pyarrow")
    frame = polars.DataFrame(table)
    assert frame.equals(table.to_polars())
    assert frame["inclination_deg"].null_count() == 1 and frame["satellites"].dtype == polars.Int64
    arrow = pyarrow.table(table)
    assert arrow.column_names == table.columns and arrow.equals(table.to_arrow())
    assert arrow["mean_pdop"][0].as_py() == table["mean_pdop"][0]


def test_xarray(small, design):
    pytest.importorskip("xarray")
    maps = small.maps(design)
    assert maps["mean_pdop"].dims == ("latitude", "longitude")
    assert maps["mean_pdop"].attrs == {"long_name": "mean PDOP", "units": "1"}
    points = small.by_point(design)
    at = maps["mean_pdop"].sel(latitude=points["latitude_deg"][5], longitude=points["longitude_deg"][5])
    assert float(at) == points["mean_pdop"][5]
    samples = small.samples(design).to_xarray()
    assert samples["pdop"].shape == (len(small.elapsed_s), len(small.points))


def test_previews(table, small, design):
    assert "2 rows" in repr(table) and "<table>" in table._repr_html_()
    metrics = small.evaluate(design)
    assert "mean_pdop" in repr(metrics) and "<td>mean_pdop</td>" in metrics._repr_html_()


def test_names_that_are_missing(table):
    with pytest.raises(KeyError, match="did you mean 'mean_pdop'"):
        table["mean_pdo"]
    assert isinstance(table.mean_pdop, np.ndarray)
