"""Files of &material groups alone, such as `vcor fit` writes, and cases: what both have."""

from __future__ import annotations

import os
import re

from ._library import InputError
from ._text import read_text
from .case import Case

#: An impact on a material
IMPACT = """
&impact velocity = 1.0 /
&sphere radius = 1.0, mass = 1.0, material = '{0}' /
&plate material = '{0}', waves = 'none' /
"""


def material_case(
    path: str | os.PathLike[str], material: str | None = None
) -> tuple[Case, list[str], bool]:
    """A case, or &material groups with an impact on one of them; names, whether it has its own."""
    text = read_text(path)
    quoted = r"'(?:[^']|'')*'|\"(?:[^\"]|\"\")*\""
    # what is in a comment or in another text is none
    found = re.finditer(rf"(?i)!.*|\bname\s*=\s*({quoted})|{quoted}", text)
    names = [one[1][1:-1].replace(one[1][0] * 2, one[1][0]) for one in found if one[1]]
    if not names:
        raise InputError(f"{os.fspath(path)}: there is no material with a name in this file")
    has_impact = re.search(r"(?im)^\s*&impact\b", text) is not None
    text += "" if has_impact else IMPACT.format((material or names[0]).replace("'", "''"))
    return Case(text, name=os.fspath(path)), names, has_impact
