"""data/reference_impacts.json: its script makes it, and vcor agrees with it."""

import json
import re

import pytest
from places import ROOT

IMPACTS = json.loads((ROOT / "data/reference_impacts.json").read_text("utf-8"))["impacts"]
COUNTS = {"paper": 16, "exact, thin plate": 10, "layer": 8, "exact": 6}
# The largest difference of cor between both methods that the page states
STATED = dict(re.findall(r"^\| `([^`]+)` .* \| (\S+) \|$", (ROOT / "docs/reproducing_the_paper.md").read_text("utf-8"), re.M))


@pytest.fixture(scope="module")
def made(script, tmp_path_factory):
    """The impacts, made again."""
    path = tmp_path_factory.mktemp("impacts") / "made.json"
    assert script(ROOT / "data/make_reference_impacts.py", path)[1:] == ("", [])
    return json.loads(path.read_text("utf-8"))["impacts"]


def test_the_file_is_that_of_the_script(made):
    """Inputs and values; those that vcor solves within their errors."""
    assert {kind: sum(one["mechanics"] == kind for one in IMPACTS) for kind in COUNTS} == COUNTS
    for one, other in zip(IMPACTS, made, strict=True):
        assert [one[key] for key in ("name", "inputs", "case")] == [other[key] for key in ("name", "inputs", "case")]
        assert one["results"].keys() == other["results"].keys()
        for name, result in one["results"].items():
            again = other["results"][name]
            error = 2 * (result.get("error", 0.0) + again.get("error", 0.0))
            assert abs(result["value"] - again["value"]) <= error, (one["name"], name)


def test_a_second_method_agrees(made):
    for one in [*IMPACTS, *made]:
        assert one["second"]["difference_of_cor"] <= float(STATED[one["mechanics"]]), one["name"]
        assert one["second"].get("largest_difference", 0.0) <= 1e-9, one["name"]
