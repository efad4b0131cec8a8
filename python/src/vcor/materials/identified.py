"""Results of an identification: parameters, their errors, and a verdict on the model."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import _text
from .._library import Floats
from ..case import Case

#: Remark on a datum
DATUM = ("source", "quantity", "at", "temperature", "value", "sigma", "model", "residual")


@dataclass(frozen=True)
class Estimate:
    """A parameter that was identified, in SI units."""

    address: str
    unit: str
    value: float
    #: Standard error; nan at a bound: the interval shows what is known
    standard_error: float
    #: Profile intervals that hold the value with 68 and 95 %; an open end is 0 or inf
    interval_68: tuple[float, float]
    interval_95: tuple[float, float]


@dataclass(frozen=True)
class Tangent:
    """Loss tangent of an impact at pi/t0, which decides what it loses."""

    #: Velocity [m/s] and temperature [K], nan if there is none
    velocity: float
    temperature: float
    #: pi/t0 [rad/s]
    frequency: float
    value: float
    standard_error: float


@dataclass(frozen=True)
class Identified:
    """Parameters with their errors, and the data."""

    case: Case
    estimates: tuple[Estimate, ...]
    #: Covariance of the logarithms of the parameters
    covariance: Floats
    #: Sum of the squares of (model - datum)/sigma; its degrees of freedom
    chi2: float
    dof: int
    #: Relative error of the data, estimated, with its floor; None: they have errors of their own
    relative_error: float | None
    #: Combinations of parameters from the best to the worst determined, with the relative error
    combinations: tuple[tuple[str, float], ...]
    eigenvalues: Floats
    aic: float
    bic: float
    #: Whether the model follows the data: they scatter as their errors say, or these are estimated
    follows: bool
    #: DATUM of each datum
    data: tuple[dict[str, Any], ...]
    #: Times that the data see [s], of a material with a shift at its reference temperature
    window: tuple[float, float]
    #: The measurement that would help most: quantity, velocity [m/s], and by how much
    advice: str
    #: Prediction: velocity, cor or cor_sphere, and the ends of its 95 % band
    band: dict[str, list[float]] = field(repr=False)
    #: Of the measured impact of median velocity at each temperature, or of that of the case
    loss_tangents: tuple[Tangent, ...] = ()
    model: str = ""
    #: Where the model of the impact does not hold, in words
    validity: str = "good"
    #: Which columns of the files were taken for what
    taken: tuple[str, ...] = ()
    #: Files whose misfits are not noise: neighbours are correlated
    alike: tuple[str, ...] = ()
    #: Exact impacts that a correction of thin mechanics was fitted to and tested with, 0: all were
    #: solved; how many of them it does not know, and its error there, root mean square in parts of
    #: the errors of the data
    solved: int = 0
    fresh: int = 0
    correction: float = 0.0
    #: Whether frequencies of moduli were given in Hz, in which the figure has them, not in rad/s
    hertz: bool = field(default=False, repr=False)

    def __getitem__(self, address: str) -> float:
        """Value of a parameter."""
        return {one.address: one.value for one in self.estimates}[address]

    def as_dict(self) -> dict[str, Any]:
        """All results as they are written to JSON."""
        values = np.array([one.value for one in self.estimates])
        known = [math.nan if math.isnan(one.standard_error) else 1.0 for one in self.estimates]
        covariance = self.covariance * np.outer(known, known)
        deviations = np.sqrt(np.diag(covariance))
        rows = [dataclasses.asdict(one) for one in self.estimates]
        keys = ("combination", "relative_error")
        return _text.document(
            model=self.model,
            parameters=[{"name": row.pop("address"), **row} for row in rows],
            covariance=covariance * np.outer(values, values),
            correlation=covariance / np.outer(deviations, deviations),
            fisher={
                "eigenvalues": self.eigenvalues,
                "combinations": [dict(zip(keys, one, strict=True)) for one in self.combinations],
            },
            chi2=self.chi2,
            degrees_of_freedom=self.dof,
            relative_error=self.relative_error,
            follows=self.follows,
            misfits_alike=list(self.alike),
            aic=self.aic,
            bic=self.bic,
            window=self.window,
            validity=self.validity,
            solved=self.solved,
            fresh=self.fresh,
            correction=self.correction,
            loss_tangents=[dataclasses.asdict(one) for one in self.loss_tangents],
            next=self.advice,
            data=self.data,
            band=self.band,
        )
