"""The numbers of docs/numbers.toml are those that the pages show, and no other number of prose stands on two pages."""

import re
import tomllib

from places import ROOT

#: Numbers that are given, not computed: they may stand anywhere
GIVEN = {
    "3.11": "version of Python",
    "3.85": "m/s, velocity of the alumina spheres of Kharaz et al.",
    "9.80665": "m/s2, standard gravity",
    "12.5": "mm, thickness of the test pieces of the rebound tests",
}
#: Pages that are made from the tables of the program
MADE = {"commands.md", "input.md", "output.md"}
#: A decimal number of its own, no part of a name or a version
NUMBER = re.compile(r"(?<![\w.,])\d+\.\d+(?![\w]|\.\d)")


def test_the_numbers_of_the_pages(script):
    assert script(ROOT / "docs/make_numbers.py", "--check") == ("", "", [])


def prose(text):
    """A page without blocks, tables, comments, code, formulas and links."""
    for pattern in (r"^```.*?^```$", r"<!--.*?-->", r"^\|.*?$", r"`[^`]*`", r"\$[^$]*\$"):
        text = re.sub(pattern, "", text, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"\]\([^)]*\)|https?://\S+|(?:doi|arXiv):\S+", "", text)


def numbers(text):
    """Numbers of three digits and more in the prose of a page."""
    return {found for found in NUMBER.findall(prose(text)) if len(found.replace(".", "").lstrip("0")) >= 3}


def written(pages):
    """Which numbers of which pages docs/make_numbers.py writes."""
    found = set()
    for entry in tomllib.loads((ROOT / "docs/numbers.toml").read_text("utf-8")).values():
        for page, text in entry.get("shown", []):
            before, after = map(re.escape, re.split(r"\{.*?\}", text, maxsplit=1))
            for value in re.findall(rf"{before}[+-]?(\d+\.\d+){after}", pages.get(page, "")):
                found.add((page, value))
    return found


def repeated(pages):
    """Numbers of prose on more than one page that no script writes there."""
    places = {}
    for page, text in pages.items():
        for number in numbers(text) - GIVEN.keys():
            places.setdefault(number, set()).add(page)
    known = written(pages)
    return {
        (number, page)
        for number, found in places.items()
        for page in found
        if len(found) > 1 and (page, number) not in known
    }


def test_no_number_stands_on_two_pages():
    """Each fact has one place: where a number changes, one page does."""
    paths = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    pages = {str(path.relative_to(ROOT)): path.read_text("utf-8") for path in paths if path.name not in MADE}
    assert repeated(pages) == set()


def test_a_repeated_number_is_seen():
    table = "| 0.123 |\n```\n0.123\n```\n`0.123` $0.123$ [a](0.123.md) 2.0.123 12.5 1.2"
    assert repeated({"a": table, "b": "0.123 and 12.5 and 1.2"}) == set()
    assert repeated({"a": "It is 0.123.", "b": "(0.123)"}) == {("0.123", "a"), ("0.123", "b")}
