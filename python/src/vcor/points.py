"""Measured points that figures show over results.

Their files, and what quantities are called there, are for the layer of materials. The package puts
its functions here, as it puts `plot` into `Case`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

#: Tables of files, with the arguments `columns`, `units` and `where` of `vcor.read_data`
read: Callable[..., list[pd.DataFrame]]
#: Name of a quantity as vcor has it, whatever it is called
plain_name: Callable[[str], str]
