"""Fit of a Prony series with a given number of terms, or with as many as the data support.

Non-negative least squares finds the moduli of times on a fine logarithmic grid; few of them are not
zero, and neighbours, between which a time of the material lies, are merged. Then moduli and times
are refined together in their logarithms, which keeps them positive.

As many terms as the data support: terms are added until the series is closer to the data than any
data are to the truth, or while they reduce the Bayesian information criterion m ln(S/m) + p ln m of
m moduli, p parameters and the sum of squares S (G. Schwarz, Ann. Stat. 6 (1978) 461).
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import nnls

from .._library import Floats, NumericalError
from .._text import option
from .laws import Found
from .samples import Problem, Samples

#: Most terms
MOST_TERMS = 60
#: Times per decade on the grid of the spectrum
PER_DECADE = 8
#: Largest misfit that is below the accuracy of any data
GOOD_ENOUGH = 5e-4
#: If one more term reduces the misfit to this fraction, the data are a series of that number
COMPLETION = 1e-3
#: Relative change of the sum of squares that ends the refinement of series that are compared, which
#: moves the criterion by no more than the number of moduli times it, and of trials of their times
COMPARED, TRIED = 1e-6, 1e-3
#: Steps without success that end the search: a single one may be due to a poor start
MOST_FAILURES = 2
#: Modulus, divided by the smallest datum, below which a term, or equilibrium, is absent
ABSENT = 1e-6
#: Factors from the first time to the shortest, and from the last one to the longest, that a term
#: may have: beyond them one sample alone would show it. Frequencies show terms farther away, which
#: decay only as 1/x
REACH_OF_TIMES, REACH_OF_FREQUENCIES = (4.0, 4.0), (30.0, 33.0)
#: Factors from the data to the softest and hardest term
SOFTEST, HARDEST = 1e-8, 1e4


class Series(Problem):
    """A Prony series; its variables are E_0, if it is free, and the logarithms of moduli, times."""

    def __init__(self, samples: Samples, given: float | None) -> None:
        """Begin without terms; `given` is the equilibrium modulus [Pa], None: free."""
        self.samples, self.given = samples, given
        #: Smallest and largest logarithm of a time
        first, last = REACH_OF_FREQUENCIES if samples.dynamic else REACH_OF_TIMES
        self.ends = math.log(samples.first_time / first), math.log(samples.last_time * last)
        #: Equilibrium modulus [Pa], moduli [Pa] and logarithms of times [s], rising
        self.rest = given or 0.0
        self.moduli, self.times = np.empty(0), np.empty(0)
        self.misfits = samples.logs(np.full(samples.data.shape, 1e-200))
        self.converged, self.vanished = False, False

    @property
    def is_free(self) -> bool:
        """Whether the equilibrium modulus is a variable."""
        return self.given is None and not self.vanished

    def copy(self) -> Series:
        """A series of the same samples, without terms."""
        return Series(self.samples, self.given)

    def terms(self, times: Floats) -> Floats:
        """Moduli of terms of 1 Pa with these logarithms of times at the samples, shape (m, n)."""
        x = np.multiply.outer(self.samples.at, np.exp(times if self.samples.dynamic else -times))
        if self.samples.dynamic:
            return np.concatenate([x**2 / (1 + x**2), x / (1 + x**2)])
        return np.exp(-x)

    def solve_moduli(self, times: Floats) -> None:
        """Take these times, with moduli >= 0 of the least relative misfit."""
        columns = np.column_stack([self.samples.ones, self.terms(times)])
        columns /= self.samples.data[:, None]
        target = np.ones(len(columns))
        if self.given is not None:
            target -= self.given * columns[:, 0]
            columns[:, 0] = 0
        found, _ = nnls(columns, target, maxiter=30 * columns.shape[1])
        self.rest = found[0] if self.given is None else self.given
        self.times, self.moduli = times, found[1:]

    def parts(self, x: Floats) -> tuple[float, Floats, Floats]:
        """Equilibrium modulus, moduli and logarithms of times of the variables."""
        rest = x[0] * self.samples.softest if self.is_free else self.rest
        moduli, times = np.split(x[int(self.is_free) :], 2)
        return float(rest), moduli, times

    def residuals(self, x: Floats) -> Floats:
        """Logarithms of model/data."""
        rest, moduli, times = self.parts(x)
        return self.samples.logs(rest * self.samples.ones + self.terms(times) @ np.exp(moduli))

    def jacobian(self, x: Floats) -> Floats:
        """Their derivatives."""
        rest, moduli, times = self.parts(x)
        terms = self.terms(times) * np.exp(moduli)
        model = np.maximum(rest * self.samples.ones + terms.sum(axis=1), 1e-200)
        y = np.multiply.outer(self.samples.at, np.exp(times if self.samples.dynamic else -times))
        slopes = y
        if self.samples.dynamic:
            slopes = np.concatenate([2 / (1 + y**2), (1 - y**2) / (1 + y**2)])
        columns = [terms, terms * slopes]
        if self.is_free:
            columns.insert(0, self.samples.softest * self.samples.ones[:, None])
        found: Floats = np.concatenate(columns, axis=1) / model[:, None]
        return found

    def refine(self, tolerance: float = 1e-10, most: int = 300) -> None:
        """Refine moduli and times together; an equilibrium modulus next to 0 is tried at 0."""
        self._iterate(tolerance, most)
        if self.is_free and self.rest < 1e-3 * self.samples.softest:
            other = self.copy()
            other.vanished, other.rest = True, 0.0
            other.moduli, other.times = self.moduli, self.times
            other._iterate(tolerance, most)
            if np.sum(other.misfits**2) <= np.sum(self.misfits**2) * (1 + 1e-6) + 1e-20:
                self.__dict__.update(other.__dict__)

    def _iterate(self, tolerance: float, most: int) -> None:
        """Steps of Gauss and Newton in the logarithms of times and moduli, at most so many."""
        n, size = len(self.times), self.samples.softest
        low, high = (
            math.log(SOFTEST * self.samples.data.min()),
            math.log(HARDEST * self.samples.data.max()),
        )
        self.low = np.repeat([low, self.ends[0]], n)
        self.high = np.repeat([high, self.ends[1]], n)
        x = np.concatenate([np.log(np.maximum(self.moduli, math.exp(low))), self.times])
        if self.is_free:
            self.low, self.high = np.append(0.0, self.low), np.append(math.inf, self.high)
            # non-negative least squares may leave out a modulus that the refinement needs
            x = np.append(max(self.rest / size, 1e-2), x)
        x, _, self.converged = self.minimize(x, tolerance, most)
        self.misfits = self.residuals(x)
        self.rest, moduli, times = self.parts(x)
        order = np.argsort(times)
        self.moduli, self.times = np.exp(moduli)[order], times[order]

    def start_from(self, times: Floats) -> None:
        """Begin with these times, and with moduli that are not 0."""
        self.solve_moduli(times)
        floor = 1e-3 * max(self.moduli.max(initial=0.0), self.samples.softest)
        self.moduli = np.maximum(self.moduli, floor)

    @property
    def is_good(self) -> bool:
        """Whether the series is as close to the data as any data are to the truth."""
        return bool(np.abs(self.misfits).max() <= GOOD_ENOUGH)

    @property
    def criterion(self) -> float:
        """Bayesian information criterion."""
        m = len(self.misfits)
        squares = max(float(np.sum(self.misfits**2)) / m, 1e-32)
        return m * math.log(squares) + (2 * len(self.times) + 1) * math.log(m)

    def variables(self) -> Floats:
        """The variables of the series as it is."""
        x = np.concatenate([np.log(self.moduli), self.times])
        return np.append(self.rest / self.samples.softest, x) if self.is_free else x


def spectrum_of(samples: Samples, given: float | None) -> Series:
    """The spectrum on a grid, with neighbours merged."""
    series = Series(samples, given)
    first, last = series.ends
    n = 1 + math.ceil((last - first) / math.log(10) * PER_DECADE)
    series.solve_moduli(np.linspace(first, last, n))
    kept = series.moduli > 0
    series.times, series.moduli = series.times[kept], series.moduli[kept]
    width = (last - first) / (n - 1)
    while len(series.times) > 1 and np.diff(series.times).min() < 1.5 * width:
        _merge(series)
    return series


def _merge(series: Series) -> None:
    """Merge the two terms that are closest to each other."""
    i = int(np.argmin(np.diff(series.times)))
    both, times = series.moduli[i : i + 2], series.times[i : i + 2]
    series.times = np.delete(series.times, i)
    series.times[i] = both @ times / both.sum()
    series.moduli = np.delete(series.moduli, i)
    series.moduli[i] = both.sum()


def fit_terms(spectrum: Series, terms: int, guide: Series | None = None) -> Series:
    """The best series of so many terms, from the spectrum and from times spread over the data."""
    samples = spectrum.samples
    trials = []
    if guide is not None and len(guide.times) > 3:
        # the middles of equal parts of a series of another number
        at = 0.5 + (np.arange(terms) + 0.5) * len(guide.times) / terms
        spread = np.interp(at, np.arange(1, len(guide.times) + 1), guide.times)
    else:
        first, last = math.log(samples.first_time / 4), math.log(samples.last_time * 4)
        spread = first + (last - first) * (np.arange(terms) + 0.5) / terms
    trials.append(spread)
    if len(spectrum.times) >= terms:
        merged = spectrum.copy()
        merged.times, merged.moduli = spectrum.times.copy(), spectrum.moduli.copy()
        while len(merged.times) > terms:
            _merge(merged)
        trials.append(merged.times)
    found = []
    for times in trials:
        series = spectrum.copy()
        series.start_from(np.clip(times, *spectrum.ends))
        series.refine(TRIED, 60)
        found.append(series)
    best = min(found, key=lambda one: float(np.sum(one.misfits**2)))
    best.refine(COMPARED)
    return best


def _search(spectrum: Series) -> Series:
    """As many terms as the data support."""
    samples = spectrum.samples
    decades = math.log10(samples.last_time / samples.first_time)
    most = min(MOST_TERMS, (len(samples.data) - 2) // 2, 5 + math.ceil(3 * decades))
    best = fit_terms(spectrum, 1)
    failures, n = 0, 1
    while failures < MOST_FAILURES and n < most and not best.is_good:
        n += 1
        trial = fit_terms(spectrum, n, best)
        failures += 1
        if trial.criterion < best.criterion:
            best, failures = trial, 0
    if len(best.times) < most:
        # one more term shows whether the data are a series of that number
        trial = fit_terms(spectrum, len(best.times) + 1)
        if np.sum(trial.misfits**2) < COMPLETION**2 * np.sum(best.misfits**2):
            best = trial
    return best


def fit_series(samples: Samples, terms: int | None, given: float | None) -> tuple[Series, Found]:
    """Fit a Prony series to samples; parameters are E_0, then moduli and times, the fastest first.

    Parameters
    ----------
    samples
        The samples.
    terms
        Number of terms; None: as many as the data support.
    given
        Equilibrium modulus [Pa]; None: found.
    """
    spectrum = spectrum_of(samples, given)
    series = fit_terms(spectrum, terms) if terms else _search(spectrum)
    while True:
        series.refine()
        try:
            return series, _concluded(series)
        except NumericalError:
            # the data may not support the term found last
            if terms or len(series.times) == 1:
                raise
        series = fit_terms(series, len(series.times) - 1)


def _concluded(series: Series) -> Found:
    """Standard errors of a series; refused if the data do not determine its terms."""
    if not series.converged:
        raise NumericalError(
            "the fit of a Prony series does not converge: give another number of terms with "
            f"{option('terms')}"
        )
    n, samples = len(series.times), series.samples
    if series.moduli.min() <= ABSENT * samples.softest:
        raise NumericalError(
            f"the data do not support so many terms: take fewer, or leave {option('terms')} out"
        )
    bound = series.vanished
    series.vanished = False
    x = series.variables()
    inner = np.ones(len(x), dtype=bool)
    if bound:
        inner[0] = False
    at_end = np.concatenate([
        np.zeros(len(x) - n, dtype=bool),
        np.minimum(series.times - series.ends[0], series.ends[1] - series.times) < 1e-3,
    ])  # fmt: skip
    try:
        inverse, variance, structured = series.scatter(
            series.jacobian(x), series.misfits, inner & ~at_end
        )
    except NumericalError as error:
        raise NumericalError(f"{error} of model prony: take fewer, by {option('terms')} or "
                             f"{option('fix')}, or another model") from None  # fmt: skip
    deviations = np.sqrt(np.diag(inverse))
    times = np.exp(series.times)
    # moduli and times of a term follow each other
    order = [0] if series.is_free else []
    order += [len(order) + i + j * n for i in range(n) for j in (0, 1)]
    values = np.concatenate([[series.rest] if series.is_free else [], series.moduli, times])
    sizes = values.copy()
    if series.is_free:
        sizes[0] = samples.softest
    errors = (sizes * deviations * math.sqrt(variance))[order]
    states = np.where(~inner | at_end, "bound", "free")[order]
    correlation = (inverse / np.outer(deviations, deviations))[np.ix_(order, order)]
    if series.given is not None:
        states, errors = np.append("fixed", states), np.append(0.0, errors)
        correlation = np.pad(correlation, ((1, 0), (1, 0)))
        values, order = np.append(series.given, values), [0, *(i + 1 for i in order)]
    return Found(values[order], errors, states.tolist(), correlation, structured)
