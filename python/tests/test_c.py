"""The C interface with what no caller should give it: a code and a line, never a crash."""

import math
from ctypes import byref, c_char_p, c_double, c_int, c_void_p

import pytest
from conftest import PAPER

from vcor import _library

USAGE, INPUT = 2, 3
CASE = str(PAPER / "sls.nml").encode()
RUBBER = (
    b"&material name = 'rubber', model = 'elastic', modulus = 1e7, density = 1e3, "
    b"poisson_ratio = 0.4 /"
)


def called(name, *arguments):
    """Code and message of a function, called as C does: without the checks of the package."""
    function = _library._library[name]  # a function of its own, without argtypes
    error = _library._ErrorStruct()
    code = function(*arguments, byref(error))
    assert code == error.code
    return code, error.message.decode()


@pytest.fixture
def case():
    pointer = c_void_p()
    assert called("vcor_read", None, CASE, byref(pointer))[0] == 0
    yield pointer
    _library._library.vcor_free(pointer)


def doubles(*values):
    return (c_double * len(values))(*values)


def names(*values):
    return (c_char_p * len(values))(*values)


def materials():
    """Another &material group; the case does not read it, and nothing is computed with it here."""
    pointer = c_void_p()
    called("vcor_read", b"&material name = 'unused', model = 'rigid' /", b"m.nml", byref(pointer))
    return pointer


def dump(case):
    """Bytes of a case, or of none for the names of the functions alone."""
    text = c_void_p()
    called("vcor_dump", case, byref(text))
    return (_library.take_text(text) or "").encode()


def arguments(case):
    """Names of the arguments of each function, with what may be given."""
    text, column, count, number = c_void_p(), _library.ColumnStruct(), c_int(), c_double()
    velocity, cor = names(b"impact.velocity"), names(b"cor")
    return {
        "vcor_read": {"text?": None, "name": CASE, "self": byref(c_void_p())},
        "vcor_copy": {"case": case, "copy": byref(c_void_p())},
        "vcor_dump": {"case": case, "text": byref(text)},
        "vcor_load": {"text": dump(case), "self": byref(c_void_p())},
        "vcor_name": {"case": case, "name": byref(text)},
        "vcor_add_materials": {"case": case, "materials": materials()},
        "vcor_replace_material": {
            "case": case, "material": b"rubber", "text": RUBBER, "source?": None,
        },
        "vcor_remove_sweeps": {"case": case},
        "vcor_set": {"case": case, "address": b"impact.velocity", "value": b"2.0"},
        "vcor_unset": {"case": case, "address": b"impact.gravity"},
        "vcor_get": {"case": case, "address": b"impact.velocity", "value": byref(text)},
        "vcor_describe": {"case": case, "address": b"impact.velocity", "column": byref(column)},
        "vcor_catalogue": {"text": byref(text)},
        "vcor_case_text": {"case": case, "complete?": 0, "text": byref(text)},
        "vcor_save": {"case": case, "path": b"saved.nml", "complete?": 0},
        "vcor_axis": {
            "case": case, "index?": 0, "column": byref(column), "n": byref(count),
            "values": byref(text),
        },
        "vcor_settle": {"case": case},
        "vcor_solve": {
            "case": case, "m?": 1, "addresses": velocity, "n?": 1, "values": doubles(1.0),
            "k?": 1, "columns": cor, "results": doubles(0.0), "threads?": 1,
        },
        "vcor_impact": {
            "case": case, "m?": 1, "addresses": velocity, "values": doubles(1.0), "k?": 1,
            "columns": cor, "results": doubles(0.0), "units?": None, "validity?": None,
            "beyond_data?": None,
        },
        "vcor_warnings": {
            "case": case, "m?": 1, "addresses": velocity, "n?": 1, "values": doubles(1.0),
            "text": byref(text),
        },
        "vcor_beyond_data": {
            "case": case, "m?": 1, "addresses": velocity, "n?": 1, "values": doubles(1.0),
            "statuses": doubles(0.0), "contact_times": doubles(1e-3), "cors": doubles(0.5),
            "text": byref(text),
        },
        "vcor_history": {"case": case, "rows": byref(count), "values": byref(text)},
        "vcor_bounces": {"case": case, "rows": byref(count), "values": byref(text)},
        "vcor_relaxation": {
            "case": case, "material": b"rubber", "n?": 1, "times": doubles(1.0),
            "moduli": doubles(0.0),
        },
        "vcor_complex_modulus": {
            "case": case, "material": b"rubber", "n?": 1, "frequencies": doubles(1.0),
            "storage": doubles(0.0), "loss": doubles(0.0),
        },
        "vcor_time_factor": {"case": case, "material": b"rubber", "factor": byref(number)},
        "vcor_time_factors": {
            "case": case, "material": b"rubber", "n?": 1, "temperatures": doubles(300.0),
            "factors": doubles(0.0),
        },
        "vcor_verify": {"case": case, "results": doubles(*[0.0] * 200)},
        "vcor_exact": {"case": case, "cor_sphere": byref(number)},
    }  # fmt: skip


def test_all_functions_are_here(case):
    header = set(_library._ARGUMENTS)
    assert header == set(arguments(case))


@pytest.mark.parametrize("name", list(arguments(None)))
def test_null_is_refused_by_name(case, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given = arguments(case)[name]
    assert called(name, *given.values())[0] == 0
    for argument in given:
        if argument.endswith("?"):
            continue
        code, line = called(name, *(given | {argument: None}).values())
        assert code == USAGE
        expected = "the case" if argument == "case" else f"the argument {argument}"
        assert line.startswith(f"{expected} is NULL")


def test_error_may_be_null(case):
    function = _library._library["vcor_set"]
    assert function(case, b"impact.velocity", b"2.0", None) == 0
    assert function(case, b"impact.velocity", b"fast", None) == USAGE


def test_other_functions(case):
    _library._library.vcor_free(None)
    column_of = _library._library["vcor_column_of"]
    column = _library.ColumnStruct()
    assert column_of(0, 0, None) == 0
    for table, index in ((0, -1), (0, 2**31 - 1), (-(2**31), 0), (7, 0)):
        assert column_of(table, index, byref(column)) == 0
    assert column_of(0, 0, byref(column)) == 1


@pytest.mark.parametrize(("key", "value", "words"), [
    ("m?", -1, "a negative number"), ("n?", -1, "a negative number"),
    ("k?", -(2**31), "a negative number"), ("threads?", -5, "found -5 threads"),
    ("threads?", 2**31 - 1, "expected 1 to 1024"), ("addresses", names(None), "addresses[i]"),
    ("columns", names(None), "columns[i]"), ("addresses", names(b""), "expected"),
])  # fmt: skip
def test_numbers_of_a_table(case, key, value, words):
    code, line = called("vcor_solve", *(arguments(case)["vcor_solve"] | {key: value}).values())
    assert code == USAGE
    assert words in line


def test_what_there_is_to_say_about_an_impact(case):
    """The texts that are asked for, numbers in another unit and the status also on failure."""

    def solved(velocity, *asked):
        results, texts = doubles(0.0, 0.0), {name: c_void_p() for name in asked}
        places = [byref(texts[name]) if name in texts else None for name in ("u", "v", "b")]
        code, line = called("vcor_impact", case, 1, names(b"impact.velocity"), doubles(velocity), 2,
                            names(b"status", b"cor"), results, *places)  # fmt: skip
        said = {name: _library.take_text(text) for name, text in texts.items()}
        return code, line, said, list(results)

    assert called("vcor_set", case, b"solver.end_time", b"1e-6") == (0, "")
    code, line, said, (status, cor) = solved(1000.0, "u", "v", "b")
    assert (code, status) == (5, 1.0) and math.isnan(cor)
    assert "sls.nml: the bodies do not separate: the plate is free on both sides" in line
    assert said["u"] == "impact.velocity = 1000.0 m/s is more than 300.0: is it in mm/s?"
    assert said["v"] is said["b"] is None
    assert called("vcor_unset", case, b"solver.end_time") == (0, "")
    code, line, said, (status, cor) = solved(10.0, "u", "v", "b")
    assert (code, line, status) == (0, "", 0.0) and 0.43 < cor < 0.44
    assert said["v"].endswith("sls.nml: validity: outside (cor_deviation)")
    assert said["u"] is said["b"] is None
    assert solved(10.0)[2] == {} and solved(10.0)[3] == [status, cor]
    assert called("vcor_set", case, b"rubber.valid_from", b"1e-4") == (0, "")
    assert "cor changes by" in solved(10.0, "b")[2]["b"]
    code, line, _, (status, cor) = solved(-1.0, "u")
    assert (code, status) == (INPUT, 3.0) and "out of range" in line


def test_tables_without_elements(case):
    for m, n, k in ((0, 0, 0), (1, 0, 1), (1, 1, 0)):
        given = {"m?": m, "n?": n, "k?": k}
        given |= {"values": None, "results": None} if n == 0 else {"results": None}
        given |= {"addresses": None} if m == 0 else {}
        given |= {"columns": None} if k == 0 else {}
        table = arguments(case)["vcor_solve"] | given
        assert called("vcor_solve", *table.values()) == (0, "")
    assert called("vcor_relaxation", case, b"rubber", 0, None, None) == (0, "")
    code, line = called("vcor_solve", case, 0, None, 5, None, 0, None, None, 1)
    assert code == USAGE and "several points" in line


def test_nan(case):
    results = doubles(1.0, 1.0, 1.0, 1.0)
    values = doubles(math.nan, math.inf, -math.inf, -0.0)
    code, line = called("vcor_solve", case, 1, names(b"impact.velocity"), 4, values, 1,
                        names(b"cor"), results, 1)  # fmt: skip
    assert code == 0 and line.startswith("4 of 4 points have no result")
    assert all(map(math.isnan, results))
    for bad, words in ((math.nan, "not a number"), (-1.0, "negative")):
        code, line = called("vcor_relaxation", case, b"rubber", 2, doubles(1.0, bad), results)
        assert code == INPUT and words in line
        code, line = called("vcor_complex_modulus", case, b"rubber", 2, doubles(1.0, bad), results,
                            results)  # fmt: skip
        assert code == INPUT and words in line
    assert called("vcor_relaxation", case, b"rubber", 1, doubles(math.inf), results)[0] == 0
    assert results[0] == 3.75e6
    infinite = doubles(math.inf)
    assert (
        called("vcor_complex_modulus", case, b"rubber", 1, infinite, results, results)[0] == INPUT
    )


def test_address_that_does_not_fit_a_column():
    name = "r" * 280
    text = PAPER.joinpath("sls.nml").read_text().replace("rubber", name).encode()
    pointer = c_void_p()
    assert called("vcor_read", text, b"x.nml", byref(pointer))[0] == 0
    column = _library.ColumnStruct()
    code, line = called("vcor_describe", pointer, f"{name}.beta".encode(), byref(column))
    assert code == INPUT
    assert line.endswith("found an address of 285 bytes, expected at most 255, with a shorter name "
                         "of the material")  # fmt: skip
    assert column.name == b""
    _library._library.vcor_free(pointer)
