"""Materials of a case: moduli against time and frequency."""

from __future__ import annotations

from ctypes import byref, c_double
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import Handle, call, numbers


class _HasHandle(Protocol):
    """A case."""

    _pointer: Handle


class Material:
    """A material of a case.

    Parameters
    ----------
    case
        The case; changes of its values count.
    name
        Name of the material.
    """

    def __init__(self, case: _HasHandle, name: str) -> None:
        """Take the material `name` of a case.

        InputError: the case has none, or no complete one.
        """
        self._case = case
        self.name = name
        self.relaxation([])

    def relaxation(self, times: ArrayLike) -> NDArray[np.float64]:
        """Relaxation modulus E(t) [Pa] at times >= 0 [s], in their shape."""
        t = numbers(times, "times", np.inf, "numbers")
        moduli = np.empty(t.size)
        call("vcor_relaxation", self._case._pointer, self.name, t.size, t.ravel(), moduli)
        return moduli.reshape(t.shape)

    def complex_modulus(self, frequencies: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus E' + i E'' [Pa] at angular frequencies >= 0 [rad/s], in their shape."""
        w = numbers(frequencies, "frequencies", np.inf, "numbers")
        storage, loss = np.empty(w.size), np.empty(w.size)
        given = self._case._pointer, self.name, w.size, w.ravel()
        call("vcor_complex_modulus", *given, storage, loss)
        return (storage + 1j * loss).reshape(w.shape)

    def time_factor(self) -> float:
        """Shift factor a_T at `impact.temperature` [1]; 1 for a material without a shift."""
        factor = c_double()
        call("vcor_time_factor", self._case._pointer, self.name, byref(factor))
        return factor.value

    def time_factors(self, temperatures: ArrayLike) -> NDArray[np.float64]:
        """Shift factors a_T at temperatures > 0 [K], in their shape; 1 without a shift.

        InputError: the law of the shift does not hold at one of them.
        """
        t = numbers(temperatures, "temperatures", np.inf, "numbers")
        factors = np.empty(t.size)
        given = self._case._pointer, self.name, t.size, t.ravel()
        call("vcor_time_factors", *given, factors)
        return factors.reshape(t.shape)
