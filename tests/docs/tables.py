"""Tables of a page that a script of docs makes, each between its name and `end` in comments."""

import re

NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?")


def tables(text):
    """The tables of a page by name."""
    return dict(re.findall(r"<!-- (\w+) -->\n(.*?)\n<!-- end -->", text, re.DOTALL))


def compare(page, made):
    """How many tables a page has; they are those that its script made, to one unit of the last digit."""
    shown, found = tables(page), tables(made)
    assert shown.keys() == found.keys()
    assert len(shown) == page.count("<!-- end -->")
    for name, text in shown.items():
        assert NUMBER.sub("#", text) == NUMBER.sub("#", found[name]), name
        for one, other in zip(NUMBER.findall(text), NUMBER.findall(found[name]), strict=True):
            unit = 10.0 ** -len(one.partition(".")[2])
            assert abs(float(one) - float(other)) <= 1.001 * unit, (name, one, other)
    return len(shown)
