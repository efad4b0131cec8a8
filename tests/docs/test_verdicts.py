"""How often each verdict is right: the sentences are those of the table that was measured."""

import sys

from places import ROOT


def test_sentences_of_the_verdicts():
    """Help, legend, FAQ and the page of validity say what its table says."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    import verdicts

    table = verdicts.table_of_page()
    found = verdicts.shares(table)
    assert 95 <= found["good"] < 100 and 90 <= found["caution"] < 100
    for path, text, right in verdicts.places(table):
        assert text == right, path


def test_table_of_the_verdicts():
    """Each class of the script has its row, of impacts enough to say so."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    import verdicts

    rows = [line.split("|")[1:] for line in verdicts.table_of_page().splitlines()[2:]]
    assert [row[0].strip() for row in rows] == list(verdicts.CLASSES)
