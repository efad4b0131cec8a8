"""Materials that a page offers: those of examples/materials with their sources, a rigid one."""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass
from pathlib import Path

from ..case import Case, read
from ..material_files import material_case

#: In an installed package, and beside its source
_FOLDERS = (
    Path(__file__).parent.parent / "lib" / "materials",
    Path(__file__).parents[4] / "examples" / "materials",
)


#: A ball that is far stiffer than what it strikes
_RIGID = """
&material name = 'rigid as steel', model = 'rigid', density = 7850.0 /
"""


@dataclass(frozen=True)
class Offered:
    """A material of the library."""

    #: Its file; None: the rigid one
    path: Path | None
    #: Where its values come from
    source: str

    def read(self) -> Case:
        """Its group."""
        return Case(_RIGID, name="rigid.nml") if self.path is None else read(self.path)


@functools.cache
def offered() -> dict[str, Offered]:
    """Materials by their names."""
    made = {"rigid as steel": Offered(None, "Does not deform; the density is that of steel.")}
    for folder in _FOLDERS:
        if not folder.is_dir():
            continue
        for path in sorted(folder.glob("*.nml")):
            _, names, _ = material_case(path)
            head = re.match(r"(?:!.*\n)*", path.read_text(encoding="utf-8"))
            words = re.sub(r"\s*!\s*", " ", head[0] if head else "").strip()
            made[names[0]] = Offered(path, words)
        break
    return made
