"""Exports, reading back, validation and lint."""

import json
import warnings

import numpy as np
import pytest

import navwalker as nw


def test_export_and_read(small, tmp_path):
    hybrid = nw.Constellation("delta:53:12/3/1@1000+star:90:8/4/1@1100", name="hybrid")
    manifest = hybrid.export(tmp_path / "out", ["tle", "oem"], scenario=small, check=True)
    assert {one["format"] for one in manifest["files"]} == {"tle", "oem"}
    back = nw.read(tmp_path / "out" / next(one["path"] for one in manifest["files"] if one["format"] == "tle"))
    assert back.satellites == 20
    states = nw.read(tmp_path / "out" / "oem", name="states")
    # The file has the digits of a metre, and the frame's rotation there and back.
    np.testing.assert_allclose(small.positions(states), small.positions(hybrid), atol=1e-3)
    only = nw.read(tmp_path / "out" / "oem", only="NW-A-*")
    assert only.satellites == 12
    assert nw.lint(*(tmp_path / "out" / "oem").iterdir()) == []
    with pytest.raises(nw.FileError, match="not empty|--force"):
        hybrid.export(tmp_path / "out", "tle", scenario=small)


def test_validate(small):
    found = nw.validate("delta:55:6/3/1@925", against="sgp4", scenario=small)
    assert found.passed and bool(found) and json.dumps(found.to_dict())
    assert any(check["gate"] is not None for check in found.checks)
    with pytest.raises(nw.NavwalkerError, match="sgp4"):
        nw.validate("delta:55:6/3/1@925", against="sgp5", scenario=small)


def test_lint(tmp_path):
    file = tmp_path / "bad.tle"
    file.write_text("1 bad\n")
    (finding,) = nw.lint(file)
    assert (finding.line, finding.severity, finding.format) == (1, "error", "tle")


def test_own_descriptions_are_not_worth_a_warning_but_foreign_files_are(tmp_path, small):
    directory = tmp_path / "mixed"
    nw.Constellation("delta:53:4/2/1@1000").export(directory, "tle", scenario=small)
    assert {"manifest.json", "provenance.json"} < {file.name for file in directory.iterdir()}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert nw.read(directory).satellites == 4
    (directory / "notes.txt").write_text("not a constellation\n")
    with pytest.warns(nw.NavwalkerWarning, match="left out: 1 .notes.txt."):
        assert nw.read(directory).satellites == 4


def test_export_without(small, tmp_path):
    """Files have the satellites that are left, under the names that they have among all; a scenario's own outages stay."""
    design = nw.Constellation("delta:55:6/3/1@925")
    left = design.without("NW-P01-S01").export(tmp_path / "left", "oem", scenario=small, check=True)
    assert left["out_of_service"] == 1 and len(left["files"]) == 5
    whole = design.export(tmp_path / "whole", "oem", scenario=small)
    names = [{file["path"] for file in one["files"]} for one in (whole, left)]
    assert names[0] - names[1] == {"oem/NW-P01-S01.oem"}
    own = small.replace(outages_satellites=["NW-P03"])
    both = design.without("NW-P01-S01").export(tmp_path / "both", "tle", scenario=own)
    assert both["out_of_service"] == 3
    with pytest.raises(nw.FileError, match="'NW-P09' is not a satellite"):
        design.without("NW-P09").export(tmp_path / "wrong", "tle", scenario=small)
