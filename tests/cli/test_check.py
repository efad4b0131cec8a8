"""check: the case with every default, a case file again."""

import pytest
from cases import SLS, case_text, edit
from program import EXAMPLES, INPUT

MODELS = ["elastic", "sls", "prony", "prony_times", "power_law", "cerf", "mittag_leffler"]


def again(vcor, name):
    """What check prints of what check prints is the same, and so are the numbers."""
    once = vcor.succeeds("check", name)
    vcor.write(once, "once.nml")
    twice = vcor.succeeds("check", "once.nml")
    # What was a default is now given
    assert twice == once.replace(" (default)", "")
    vcor.write(twice, "twice.nml")
    assert vcor.succeeds("check", "twice.nml") == twice
    assert vcor.numbers("once.nml") == vcor.numbers(name)
    return once


@pytest.mark.usefixtures("data_files")
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples(vcor, path):
    again(vcor, path)


@pytest.mark.parametrize("model", MODELS)
def test_models(vcor, model):
    vcor.write(case_text(model))
    again(vcor, "case.nml")


def test_writes_no_file(vcor):
    vcor.write(SLS)
    vcor.succeeds("check", "case.nml")
    assert [path.name for path in vcor.folder.iterdir()] == ["case.nml"]


def test_defaults(vcor):
    vcor.write(SLS)
    page = vcor.succeeds("check", "case.nml")
    for line in ("waves = 'relaxing'", "method = 'auto'", "csv = .true.", "stem = 'case'"):
        assert line in page


def test_stem_is_kept(vcor):
    """The printed case writes to the same files, whatever it is called."""
    vcor.write(SLS)
    vcor.write(vcor.succeeds("check", "case.nml"), "other.nml")
    vcor.succeeds("run", "other.nml", "--output", "out")
    assert (vcor.folder / "out" / "case.h5").is_file()


@pytest.mark.parametrize(
    "value", ["0.1", "0.30000000000000004", "1.7976931348623e2", "3.3333333333333335e-1", "1e-50"]
)
def test_numbers_are_kept_to_the_last_bit(vcor, value):
    text, _ = edit(SLS, "impact", "velocity", value)
    vcor.write(text)
    page = vcor.succeeds("check", "case.nml")
    line = next(line for line in page.splitlines() if "velocity =" in line)
    assert float(line.split("=")[1].split("!")[0]) == float(value)


@pytest.mark.parametrize("title", ["It's", 'say "a"', "a ! b", "a / b", "&x", "100 % Öl α", " "])
def test_texts_are_kept(vcor, title):
    quoted = "'" + title.replace("'", "''") + "'"
    text, _ = edit(SLS, "case", "title", quoted)
    vcor.write(text)
    assert quoted in again(vcor, "case.nml")


def test_comes_with_settings(vcor):
    vcor.write(SLS)
    page = vcor.succeeds("check", "case.nml", "--set", "rubber.beta=600", "--set=case.title=new")
    assert "beta = 600.0" in page and "title = 'new'" in page


def test_several_files(vcor):
    vcor.write(SLS, "a.nml")
    vcor.write(case_text("cerf"), "b.nml")
    both = vcor.succeeds("check", "a.nml", "b.nml")
    assert both == vcor.succeeds("check", "a.nml") + vcor.succeeds("check", "b.nml")


def test_one_of_several_is_wrong(vcor):
    """Nothing is printed of the others."""
    vcor.write(SLS, "a.nml")
    text, line = edit(SLS, "sphere", "radius", "0.0")
    vcor.write(text, "b.nml")
    vcor.refuses("check", "a.nml", "b.nml", code=INPUT, at=f"b.nml:{line}")
