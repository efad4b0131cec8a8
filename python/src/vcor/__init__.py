"""Coefficient of restitution of viscoelastic spheres and plates.

All numbers are in SI units; results are `xarray.Dataset` objects with units in their attributes.
"""

import importlib
from typing import TYPE_CHECKING, Any

from . import points
from ._library import (
    DataRangeWarning,
    Error,
    FileError,
    InputError,
    NoResultWarning,
    NumericalError,
    UnitWarning,
    UsageError,
    ValidityWarning,
    __version__,
)
from .case import Case, read
from .material import Material

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .exchange.cards import card, read_card
    from .exchange.codes import pair
    from .exchange.export import export
    from .exchange.mixture import mixture
    from .materials.data import read_data
    from .materials.fit import Fit, fit
    from .materials.identification import identify
    from .materials.master import master
    from .page import Live
    from .results import open  # noqa: A004  (vcor.open reads as vcor.read does)
    from .uncertainty import propagate, sensitivities
    from .uncertainty_sweep import bands

__all__ = [
    "Case",
    "DataRangeWarning",
    "Error",
    "FileError",
    "Fit",
    "InputError",
    "Material",
    "NoResultWarning",
    "NumericalError",
    "UnitWarning",
    "UsageError",
    "ValidityWarning",
    "__version__",
    "bands",
    "card",
    "export",
    "fit",
    "identify",
    "master",
    "mixture",
    "open",
    "pair",
    "propagate",
    "read",
    "read_card",
    "read_data",
    "sensitivities",
]

# Messages of the interpreter name an error as users import it
for _kind in (
    DataRangeWarning, Error, FileError, InputError, NoResultWarning, NumericalError, UnitWarning,
    UsageError, ValidityWarning,
):  # fmt: skip
    _kind.__module__ = "vcor"


def _plot(self: Case, kind: str | None = None, **options: Any) -> "Figure":
    """Solve the case and draw it; needs Matplotlib.

    Parameters
    ----------
    kind
        "history" or "loop", of a case with &sweep groups "sweep" or "map"; None: the first that
        fits.
    options
        Those of `vcor.plot.figure`.
    """
    made: Figure = importlib.import_module("vcor.plot").figure(self, kind=kind, **options)
    return made


def _of_data(name: str) -> Any:
    """A function of `vcor.materials.data`, which is imported with the first call."""

    def call(*arguments: Any) -> Any:
        return getattr(importlib.import_module("vcor.materials.data"), name)(*arguments)

    return call


Case.plot = _plot
points.read, points.plain_name = _of_data("read_points"), _of_data("plain_name")


def _page(self: Case, *, port: int | None = None) -> "Live":
    """Open a live page of the case, below the cell of a notebook; needs Bokeh.

    Parameters
    ----------
    port
        Port on 127.0.0.1; None: a free one.

    Returns
    -------
    vcor.page.Live
        The page, with `url` for a browser of this machine; `stop` ends it.
    """
    made: Live = importlib.import_module("vcor.page").live(self, port=port)
    return made


Case.page = _page

#: Names that need scipy or read files, by their modules; imported when they are used
_LATER = {
    "Fit": "materials.fit",
    "bands": "uncertainty_sweep",
    "card": "exchange.cards",
    "export": "exchange.export",
    "fit": "materials.fit",
    "identify": "materials.identification",
    "master": "materials.master",
    "mixture": "exchange.mixture",
    "open": "results",
    "pair": "exchange.codes",
    "propagate": "uncertainty",
    "read_card": "exchange.cards",
    "read_data": "materials.data",
    "sensitivities": "uncertainty",
}


def __dir__() -> list[str]:
    return [*__all__, "page", "plot"]


def __getattr__(name: str) -> Any:
    """Import a part of the package when it is used first."""
    if name in ("page", "plot"):
        return importlib.import_module(f"vcor.{name}")
    if name not in _LATER:
        raise AttributeError(f"module 'vcor' has no attribute '{name}'")
    found = getattr(importlib.import_module(f"vcor.{_LATER[name]}"), name)
    globals()[name] = found
    return found
