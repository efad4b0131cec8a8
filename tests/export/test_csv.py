"""The CSV files as their readers see them."""

import csv
import re

import h5py
import numpy
import pandas
import pytest
from columns import HISTORY, INTEGERS, SUMMARY, TEXTS


def read(path):
    """Read with pandas; before version 3 it needs float_precision="round_trip" for the last bit."""
    return pandas.read_csv(path, comment="#")


def comments(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line.startswith("#")]


def test_names(summary_csv, history_csv):
    # A single impact has no swept parameters
    assert list(read(summary_csv).columns) == list(SUMMARY)
    assert list(read(history_csv).columns) == list(HISTORY)


def test_rows(summary_csv, history_csv):
    assert len(read(summary_csv)) == 1
    history = read(history_csv)
    assert len(history) > 10
    assert history["time"].iloc[0] == 0
    assert history["time"].is_monotonic_increasing


def test_types(summary_csv, history_csv):
    summary = read(summary_csv)
    for name in SUMMARY:
        kind = summary[name].dtype.kind
        if name in TEXTS:
            assert isinstance(summary[name].iloc[0], str)
        else:
            assert kind == ("i" if name in INTEGERS else "f"), name
    assert all(kind.kind == "f" for kind in read(history_csv).dtypes)


@pytest.mark.parametrize("group", ["summary", "history"])
def test_same_bits_as_hdf5(group, summary_csv, history_csv, hdf5):
    table = read(summary_csv if group == "summary" else history_csv)
    with h5py.File(hdf5) as file:
        for name in table:
            if name in TEXTS:
                assert list(table[name]) == list(file[group][name].asstr())
            else:
                assert table[name].to_numpy().tobytes() == file[group][name][:].astype(
                    table[name].dtype
                ).tobytes(), name


def test_numpy_reads_the_same_bits(history_csv):
    table = read(history_csv)
    head = len(comments(history_csv)) + 1
    numbers = numpy.genfromtxt(history_csv, delimiter=",", skip_header=head)
    assert numbers.tobytes() == table.to_numpy().tobytes()
    # By name, once the comments are out of the way
    with open(history_csv, encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    named = numpy.genfromtxt(lines, delimiter=",", names=True)
    assert named.dtype.names == tuple(HISTORY)
    assert named["force"].tobytes() == table["force"].to_numpy().tobytes()


def test_plain_reader(summary_csv):
    with open(summary_csv, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert rows[0] == list(SUMMARY)
    assert {len(row) for row in rows} == {len(SUMMARY)}


def test_numbers_have_17_digits(history_csv):
    number = re.compile(r"-?\d\.\d{16}e[+-]\d{2,3}|nan|-?inf")
    lines = history_csv.read_text(encoding="utf-8").splitlines()
    rows = lines[len(comments(history_csv)) + 1 :]
    for row in rows:
        for field in row.split(","):
            assert number.fullmatch(field), field


def test_bytes(summary_csv, history_csv):
    for path in summary_csv, history_csv:
        content = path.read_bytes()
        assert content.endswith(b"\n")
        assert b"\r" not in content
        assert not content.startswith(b"\xef\xbb\xbf")


def test_comments(summary_csv, history_csv):
    for path, columns in (summary_csv, SUMMARY), (history_csv, HISTORY):
        lines = comments(path)
        assert re.fullmatch(r"# vcor \d+\.\d+\.\d+", lines[0])
        assert lines[1].startswith("# title: ")
        for name, unit in columns.items():
            described = [line for line in lines if line.startswith(f"#   {name} ")]
            assert len(described) == 1, name
            if unit:
                assert described[0].startswith(f"#   {name} [{unit}] "), name
        # Comments come first and nowhere else
        whole = path.read_text(encoding="utf-8").splitlines()
        assert whole[: len(lines)] == lines


def test_case_can_be_taken_out(summary_csv, hdf5):
    lines = comments(summary_csv)
    case = [line[2:] for line in lines[lines.index("# case:") + 1 :]]
    with h5py.File(hdf5) as file:
        assert "\n".join(case).strip() == file.attrs["case"].strip()
    assert "&impact" in "\n".join(case)
