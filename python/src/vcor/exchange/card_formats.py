"""Cards of finite element programs: what they hold of a material, and each format both ways."""

from __future__ import annotations

import dataclasses
import itertools
import math
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from .._library import InputError, UsageError, printable
from .._text import option
from ..arguments import written
from ..units import GAS

#: Sizes of the units of length, mass and time [m], [kg], [s]
UNITS = {
    "SI": (1.0, 1.0, 1.0),
    "mm-t-s": (1e-3, 1e3, 1.0),
    "mm-kg-ms": (1e-3, 1.0, 1e-3),
    "mm-g-ms": (1e-3, 1e-3, 1e-3),
    "cm-g-us": (1e-2, 1e-3, 1e-6),
}
#: Columns of a number in the formats with columns, and the most that Abaqus takes
_WIDTH = 20
#: 0 C [K], and the temperature below which one is none in kelvin
ZERO_C, _COLDEST = 273.15, 150.0
#: Relative difference of ratios that are meant to be the same, which cards have to a few digits
_SAME = 1e-4
_CONSTANTS = {"wlf": ("reference_temperature", "wlf_c1", "wlf_c2"),
              "arrhenius": ("reference_temperature", "activation_energy")}  # fmt: skip
Line = tuple[int, str]
Terms = list[tuple[float, float]]
Shift = Mapping[str, str | float]


@dataclass(frozen=True)
class Card:
    """A material of which E(t) is a constant and a sum of exponentials.

    In SI units unless `units` says otherwise; `str` of it is a &material group.
    """

    name: str
    poisson_ratio: float
    equilibrium_modulus: float
    moduli: tuple[float, ...]
    times: tuple[float, ...]
    density: float | None = None
    #: Keys of &material that shift the times with temperature
    shift: Shift = dataclasses.field(default_factory=dict)
    #: Remarks on what is left out or changed
    remarks: tuple[str, ...] = ()
    units: str = "SI"

    @property
    def glassy_modulus(self) -> float:
        """Modulus at time zero."""
        return math.fsum([self.equilibrium_modulus, *self.moduli])

    @property
    def terms(self) -> Terms:
        """Moduli and times."""
        return list(zip(self.moduli, self.times, strict=True))

    @property
    def ratios(self) -> list[float]:
        """Terms over the modulus at time zero: of E, G and K alike."""
        return [modulus / self.glassy_modulus for modulus in self.moduli]

    @property
    def shear(self) -> float:
        """G/E."""
        return 0.5 / (1 + self.poisson_ratio)

    @property
    def bulk(self) -> float:
        """K/E."""
        return 1 / (3 * (1 - 2 * self.poisson_ratio))

    @property
    def constants(self) -> list[float]:
        """Reference temperature and constants of the shift; none: empty."""
        return [float(value) for key, value in self.shift.items() if key != "shift"]

    def within(self, units: str) -> Card:
        """The same material in other units."""
        if units not in UNITS:
            raise UsageError(f"unknown units '{units}', known: {', '.join(UNITS)}")
        length, mass, time = (a / b for a, b in zip(UNITS[self.units], UNITS[units], strict=True))
        pressure, shift = mass / (length * time**2), dict(self.shift)
        if "activation_energy" in shift:
            shift["activation_energy"] = float(shift["activation_energy"]) * pressure * length**3
        return dataclasses.replace(
            self, units=units, shift=shift,
            equilibrium_modulus=self.equilibrium_modulus * pressure,
            moduli=tuple(modulus * pressure for modulus in self.moduli),
            times=tuple(one * time for one in self.times),
            density=None if self.density is None else self.density * mass / length**3,
        )  # fmt: skip

    def text(self, code: str, units: str = "SI", *, celsius: bool = False) -> str:
        """Card of a program, one of `FORMATS`, in one of `UNITS`; refused if it cannot hold it.

        With `celsius` its temperatures are degrees Celsius.
        """
        if code not in FORMATS:
            raise UsageError(f"unknown program '{code}', known: {', '.join(FORMATS)}")
        form, card = FORMATS[code], self.within(units)
        if celsius:
            if self.shift.get("shift") != "wlf":
                raise UsageError(f"{self.name}: {option('celsius', True)} is for the WLF shift, "
                                 "expected kelvin, without it")  # fmt: skip
            shifted = {"reference_temperature": self.constants[0] - ZERO_C}
            card = dataclasses.replace(card, shift={**card.shift, **shifted})
        if flaw := form.flaw(self):
            raise InputError(f"{self.name}: {flaw}")
        size = 1 / Card("", 0, 1, (), ()).within(units).equilibrium_modulus
        # what is read back is a line each, whatever its length; notes are wrapped
        head = [f"vcor card for {code} in units {units}: moduli in {size:g} Pa, temperatures in "
                f"{'C' if celsius else 'K'}",
                f"material '{self.name}'"]  # fmt: skip
        head += [row for note in self.notes(code) for row in textwrap.wrap(note, 76)]
        return "\n".join([*(form.comment + row for row in head), *form.write(card)]) + "\n"

    def notes(self, code: str) -> list[str]:
        """Notes on the card of a program."""
        form, notes, nu = FORMATS[code], list(self.remarks), self.poisson_ratio
        if nu == 0.5 and form.incompressible:
            notes.append(f"Poisson's ratio 0.5 needs {form.incompressible}")
        if not form.bulk:
            notes.append(
                "the bulk modulus of this card is that of time zero and does not relax: Poisson's "
                f"ratio grows from {nu:.6g} to {_ratio_after(nu, 1 - sum(self.ratios)):.6g}, in "
                "vcor it is constant"
            )
        return notes + list(filter(None, [form.shifts.get(str(self.shift.get("shift")))]))

    def __str__(self) -> str:
        """The card as a &material group, its remarks as comments."""
        keys = {
            "name": self.name, "model": "prony", "density": self.density,
            "poisson_ratio": self.poisson_ratio, "equilibrium_modulus": self.equilibrium_modulus,
            "moduli": self.moduli, "times": self.times, **self.shift,
        }  # fmt: skip
        given = {key: _rounded(value) for key, value in keys.items() if value is not None}
        rows = [f"   {key} = {written(value, key)}" for key, value in given.items()]
        # only lists of numbers are wrapped: a text is one line
        body = [line for row in rows for line in ([row] if "'" in row else
                textwrap.wrap(row, 98, subsequent_indent=" " * 6))]  # fmt: skip
        head = [f"! {line}" for text in self.remarks for line in textwrap.wrap(printable(text), 96)]
        return "\n".join([*head, "&material", *body, "/"]) + "\n"


@dataclass(frozen=True)
class Format:
    """A format, and what it can hold."""

    comment: str
    write: Callable[[Card], list[str]]
    read: Callable[[Source], Card]
    #: Shift laws that it has, with a remark on each
    shifts: Mapping[str, str] = dataclasses.field(default_factory=dict)
    #: Whether the bulk modulus can relax
    bulk: bool = True
    #: Most terms, the constant one counted if `constant`
    terms: int = 100
    constant: bool = False
    #: Elements that take Poisson's ratio 0.5; empty: none do
    incompressible: str = ""
    #: Whether it needs a density
    dense: bool = True
    #: Whether it takes a material that relaxes to nothing
    fluid: bool = False
    #: Poisson's ratio that the program takes for another
    forbidden: float | None = None
    #: Most letters of the name, how it must not begin, and what it must not contain; 0: the name is
    #: in a comment alone
    title: int = 0
    marks: str = ""
    quote: str = ""

    def name_flaw(self, name: str) -> str:
        """Why the program would take the name for something else, empty if it would not."""
        if printable(name) != name:
            return "its name has a control character, expected a text that can be read on one line"
        if not self.title:
            return ""
        if len(name.rstrip()) > self.title:
            return f"the card holds names of {self.title} letters, expected a shorter one"
        if not name.strip() or name.startswith(tuple(self.marks)):
            return f"the name '{name}' begins with '{name[:1]}', which the program reads as " \
                   "something else; expected another one"  # fmt: skip
        if self.quote and self.quote in name:
            return f"the card cannot hold a name with {self.quote}, expected another one"
        return ""

    def flaw(self, card: Card) -> str:
        """Why the card cannot hold a material, empty if it can."""
        if flaw := self.name_flaw(card.name):
            return flaw
        n = len(card.moduli) + (self.constant and card.equilibrium_modulus > 0)
        shift, nu = str(card.shift.get("shift", "")), card.poisson_ratio
        if n > self.terms:
            return f"the card holds {self.terms} terms, found {n}; expected a shorter series"
        if nu == self.forbidden or nu == 0.5 and not self.incompressible:
            return (
                f"the card cannot hold Poisson's ratio {nu:g}, expected "
                f"{option('poisson_ratio', 0.495)}"
            )
        if self.dense and card.density is None:
            return "the card needs a density, expected the key density"
        if card.equilibrium_modulus == 0 and not self.fluid:
            return "the card cannot hold a fluid, expected equilibrium_modulus > 0"
        if shift and (shift not in self.shifts or "vertical_shift" in card.shift):
            what = "vertical shift" if shift in self.shifts else f"shift '{shift}'"
            return (f"the card cannot hold a {what}, expected {option('use_shift', False)}: at "
                    "reference_temperature")  # fmt: skip
        return ""


@dataclass
class Source:
    """A file that holds a card, and what the user says of it."""

    path: str
    text: str
    material: str | None = None
    units: str = ""
    modulus: float | None = None
    poisson_ratio: float | None = None
    use_shift: bool = True
    celsius: bool = False

    def __post_init__(self) -> None:
        """Split the lines, and take name, units and scale of temperatures of the head of vcor."""
        # no other character ends a line of these programs
        self.lines = [(i, line.rstrip()) for i, line in enumerate(self.text.split("\n"), 1)]
        made = head_of(self.text)
        if made is None and not self.units and re.search(r"(?i)vcor card", self.text):
            self.fail(0, f"the head that vcor wrote is damaged or old, expected {option('units')}")
        given = made[2] if made else "SI"
        self.name = Path(self.path).stem
        if made and (title := re.search(r"(?m)^\S{1,2} material '(.*)'$", self.text)):
            self.name = title[1]
        if made and self.units not in ("", given):
            self.fail(0, f"the card is in units {given}, found {option('units', self.units)}")
        self.units = self.units or given
        if self.units not in UNITS:
            raise UsageError(
                f"{self.path}: unknown units '{self.units}', known: {', '.join(UNITS)}"
            )
        #: Scale of the temperatures, C or K; empty: that is not stated
        self.scale = "C" if self.celsius else ""
        if made:
            self.scale = made[3]
            if self.celsius and self.scale == "K":
                self.fail(0, "the temperatures of the card are in kelvin, found "
                             f"{option('celsius', True)}")  # fmt: skip
        scale = "degrees Celsius" if self.celsius else "kelvin"
        self.remarks = [] if made else [f"the card is read in units {self.units}, and {scale}"]

    def once(self, found: Sequence[tuple[str, int]]) -> None:
        """Refuse names of materials that are there twice: only one of them would be read."""
        names = [name for name, _ in found]
        for name, line in found:
            if names.count(name) > 1:
                self.fail(line, f"found several materials '{name}', expected different names")

    def fail(self, line: int, message: str) -> NoReturn:
        """Refuse the card."""
        raise InputError(f"{self.path}:{line}: {message}" if line else f"{self.path}: {message}")

    def kelvin(self, reference: float, zero: float | None = None) -> float:
        """Reference temperature in K; `zero` is absolute zero in the scale of the card."""
        if zero is not None:
            return reference - zero
        if self.scale == "C":
            return reference + ZERO_C
        if not self.scale and reference < _COLDEST:
            self.remarks = [
                f"the card is read in units {self.units}",
                f"its reference temperature, {reference:g}, is not in K: taken as degrees Celsius,"
                f" {reference + ZERO_C:g} K; {option('celsius', True)} states that, "
                f"{option('use_shift', False)} leaves it out",
            ]
            return reference + ZERO_C
        return reference

    def number(self, line: int, text: str, *, sums: bool = False) -> float:
        """A number, 0 where there is none; with `sums` also such as 273-5."""
        text = text.strip().lower().replace("d", "e")
        parts = re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?", text)
        value = math.fsum(map(float, parts))
        if "".join(parts) != text or len(parts) > 1 and not sums or not math.isfinite(value):
            self.fail(line, f"found '{text}', expected a number")
        return value

    def columns(self, line: Line, *widths: int) -> list[float]:
        """Numbers in columns of these widths, or between commas; 0 where there is none."""
        i, text = line
        ends = list(itertools.accumulate(widths))
        words = [text[end - width : end] for end, width in zip(ends, widths, strict=True)]
        rest = text[ends[-1] :].strip()
        if "," in text:
            words = text.split(",")
            words, rest = words[: len(widths)], "".join(words[len(widths) :])
        if rest:
            self.fail(i, f"found '{rest}' beyond the {len(widths)} numbers of this line")
        return [self.number(i, word) for word in words] + [0.0] * (len(widths) - len(words))

    def blocks(self, mark: str, comments: tuple[str, ...]) -> list[tuple[int, str, list[Line]]]:
        """Lines that begin with a mark, without it, each with the lines after it."""
        found: list[tuple[int, str, list[Line]]] = []
        for i, text in self.lines:
            if text.startswith(mark) and not text.startswith(comments):
                found.append((i, text.removeprefix(mark), []))
            elif found and not text.startswith(comments):
                found[-1][2].append((i, text))
        return found

    def choose(self, names: Sequence[str]) -> str:
        """The material that is meant, of those in the file."""
        if len(names) == 1 and self.material is None:
            return names[0]
        if not names:
            self.fail(0, "found no viscoelastic material")
        if self.material not in names and str(self.material).strip('"') in names:
            # as the deck has it
            return str(self.material).strip('"')
        if self.material not in names:
            what = f"material '{self.material}'" if self.material else f"{len(names)} materials"
            raise UsageError(f"{self.path}: found {what}, expected {option('material')} with one "
                             f"of {', '.join(names)}")  # fmt: skip
        return str(self.material)

    def elastic(self, modulus: float | None, ratio: float | None) -> tuple[float, float]:
        """Modulus and Poisson's ratio of the card, or those of the options."""
        modulus = modulus or self.modulus
        ratio = self.poisson_ratio if ratio is None else ratio
        if modulus is None or ratio is None:
            self.fail(0, f"the card has no elastic constants, expected {option('modulus')} (at "
                         "time zero, in the units of the card) and "
                         f"{option('poisson_ratio')}")  # fmt: skip
        return modulus, self.ratio(0, ratio)

    def ratio(self, line: int, value: float) -> float:
        """Poisson's ratio, refused where no material has it."""
        if not -1 < value <= 0.5:
            self.fail(line, f"found Poisson's ratio {value:g}, expected in (-1, 0.5]")
        return value

    # fmt: off
    def card(
        self, line: int, shear: Terms, rest: float, bulk: Terms, ratio: float, *,
        density: float | None = None, shift: Shift | None = None, name: str | None = None,
    ) -> Card:
        """The material: shear moduli and times, the long-time one, K_i over K, ratio at time 0."""
        shear = [(term, time) for term, time in shear if term != 0]
        bulk = [(term, time) for term, time in bulk if term != 0]
        if not shear or rest < 0 or min(min(one) for one in shear) <= 0:
            self.fail(line, "expected moduli and times > 0 that leave a long-time modulus >= 0")
        total = math.fsum([rest, *(term for term, _ in shear)])
        self.ratio(line, ratio)
        remarks, given = list(self.remarks), self.poisson_ratio
        if given is None and ratio < 0.5 and not bulk:
            remarks.append(
                "the bulk modulus of the card does not relax: its Poisson's ratio grows from "
                f"{ratio:.6g} to {_ratio_after(ratio, rest / total):.6g}, this group has the first "
                f"at all times; {option('poisson_ratio')} gives another at the same shear moduli"
            )
        elif given is None and ratio < 0.5 and not (len(shear) == len(bulk) and all(
            abs(a / total - b) <= _SAME * b and abs(s - t) <= _SAME * t
            for (a, s), (b, t) in zip(shear, bulk, strict=True)
        )):
            self.fail(line, "shear and bulk moduli relax in different ways: Poisson's ratio is "
                            f"not constant, expected {option('poisson_ratio')} for the shear "
                            "moduli alone")
        shift = dict(shift or {}) if self.use_shift else {}
        remarks += [str(shift.pop("remark"))] if "remark" in shift else []
        ratio = ratio if given is None else given
        moduli = tuple(2 * (1 + ratio) * term for term, _ in shear)
        return Card(name or self.name, ratio, 2 * (1 + ratio) * rest, moduli,
                    tuple(time for _, time in shear), density or None, shift, tuple(remarks),
                    self.units).within("SI")
    # fmt: on


def head_of(text: str) -> re.Match[str] | None:
    """Program, units and scale of temperatures in the head of a card, None if vcor wrote none."""
    return re.match(
        r"\S{1,2} vcor card for (\S+) in units (\S+): .*, temperatures in ([CK])\s", text
    )


def _ratio(bulk: float, shear: float) -> float:
    """Poisson's ratio."""
    return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))


def _ratio_after(ratio: float, part: float) -> float:
    """Poisson's ratio when the shear modulus is this part of what it was, and K as it was."""
    return _ratio(2 * (1 + ratio), 3 * (1 - 2 * ratio) * part)


def _gas(units: str) -> float:
    """Gas constant in these units."""
    length, mass, time = UNITS[units]
    return GAS / (mass * length**2 / time**2)


def _number(value: float) -> str:
    """A number with 15 digits, fewer where the columns end."""
    texts = (f"{value:.{digits}g}" for digits in range(15, 0, -1))
    return next(text for text in texts if len(text) <= _WIDTH)


def _rounded(value: str | float | tuple[float, ...]) -> str | float | tuple[float, ...]:
    """Numbers without the last digit, which conversions leave behind."""
    if isinstance(value, tuple):
        return tuple(float(f"{one:.15g}") for one in value)
    return value if isinstance(value, (str, bool)) else float(f"{value:.15g}")


def _row(*values: float | str | None) -> str:
    """Columns of numbers or texts; None is left blank."""
    texts = ["" if one is None else one if isinstance(one, str) else _number(one) for one in values]
    return "".join(f"{text:>{_WIDTH}}" for text in texts).rstrip()


def _lines(mark: str, names: str, *values: float | str | None) -> list[str]:
    """Names of columns as a comment, and a row of them if there are values."""
    return [mark + _row(*names.split())[1:], *([_row(*values)] if values else [])]


def _law(law: str, *constants: float) -> dict[str, str | float]:
    """Keys of a shift law."""
    return {"shift": law, **dict(zip(_CONSTANTS[law], constants, strict=True))}


# --------------------------------------------------------------------------------------- Abaqus


def _write_abaqus(card: Card) -> list[str]:
    """Lines of *MATERIAL: *DENSITY, *ELASTIC, *VISCOELASTIC, TIME=PRONY, *TRS."""
    law, gas = str(card.shift.get("shift", "")), _number(_gas(card.units))
    lines = [f"*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0., UNIVERSAL GAS={gas}"] * (law == "arrhenius")
    name = card.name if re.fullmatch(r"[A-Za-z]\w*", card.name) else f'"{card.name}"'
    lines.append(f"*MATERIAL, NAME={name}")
    lines += [] if card.density is None else ["*DENSITY", f"{_number(card.density)},"]
    terms = zip(card.ratios, card.ratios, card.times, strict=True)
    rows = [(card.glassy_modulus, card.poisson_ratio), *terms, card.constants]
    texts = [", ".join(map(_number, row)) for row in rows]
    lines += ["*ELASTIC, MODULI=INSTANTANEOUS", texts[0], "*VISCOELASTIC, TIME=PRONY", *texts[1:-1]]
    return lines + [f"*TRS, DEFINITION={law.upper()}", texts[-1]] * bool(law)


def _read_abaqus(source: Source) -> Card:
    """The material of *MATERIAL: *ELASTIC or *HYPERELASTIC, *VISCOELASTIC as PRONY, *TRS."""
    blocks = []
    for i, head, lines in source.blocks("*", ("**",)):
        # a line of keywords goes on after a comma at its end
        while head.endswith(",") and lines:
            head += lines.pop(0)[1].strip()
        word, *pairs = head.split(",")
        options = dict(re.sub(r"\s", "", pair).upper().partition("=")[::2] for pair in pairs)
        title = re.search(r'(?i)\bname\s*=\s*("[^"]*"|[^,]*)\s*([^,]*)', head)
        name = title[1].strip() if title else ""
        if title and title[2]:
            source.fail(i, f"found '{title[2]}' after the name {name}, expected a comma")
        name = name[1:-1] if name.startswith('"') else name
        blocks.append((word.strip().upper(), i, options, lines, name))
    starts = [k for k, block in enumerate(blocks) if block[0] == "MATERIAL"] + [len(blocks)]
    source.once([(blocks[a][4], blocks[a][1]) for a in starts[:-1]])
    parts = {blocks[a][4]: blocks[a:b] for a, b in itertools.pairwise(starts)}
    viscous = [n for n, part in parts.items() if any(one[0] == "VISCOELASTIC" for one in part)]
    name = source.choose(viscous)
    found = {one[0]: one for one in blocks if one[0] == "PHYSICAL CONSTANTS"}
    found |= {one[0]: one for one in parts[name]}

    def rows(keyword: str, *counts: int) -> list[list[float]]:
        """Numbers of the lines after a keyword, 0 in a blank field."""
        lines = found[keyword][3] if keyword in found else []
        cells = [(i, text.rstrip(", ").split(",")) for i, text in lines if text.strip(", ")]
        table = [[source.number(i, word) for word in row] for i, row in cells]
        if not table or any(len(row) not in counts for row in table):
            source.fail(found.get(keyword, parts[name][0])[1],
                        f"expected *{keyword} with lines of {counts[0]} numbers")  # fmt: skip
        return table

    kinds = [one for one in found if one in ("ELASTIC", "HYPERELASTIC", "HYPERFOAM")]
    if "ELASTIC" in kinds:
        _, line, options, *_ = found["ELASTIC"]
        if not (given := options.get("TYPE", "ISOTROPIC")).startswith("ISO"):
            source.fail(line, f"found *ELASTIC, TYPE={given}, expected ISOTROPIC")
        constants = rows("ELASTIC", 2, 3)
        if len(constants) > 1:
            source.fail(line, f"found *ELASTIC at {len(constants)} temperatures, expected one")
        ratio = source.ratio(line, constants[0][1])
        start = constants[0][0] / (2 * (1 + ratio))
    elif "HYPERELASTIC" in kinds:
        _, line, options, lines, _ = found["HYPERELASTIC"]
        start, ratio = _hyperelastic(source, line, options, lines)
    else:
        line = found[kinds[0]][1] if kinds else parts[name][0][1]
        source.fail(line, f"found {'*HYPERFOAM' if kinds else 'no elastic constants'}, expected "
                          "*ELASTIC or *HYPERELASTIC")  # fmt: skip
    moduli = options.get("MODULI", "LONGTERM")
    if moduli not in ("LONGTERM", "INSTANTANEOUS"):
        source.fail(line, f"found MODULI={moduli}, expected LONG TERM or INSTANTANEOUS")
    _, line, options, *_ = found["VISCOELASTIC"]
    given = ", ".join("=".join(filter(None, pair)) for pair in options.items())
    if options.get("TIME") != "PRONY" or options.get("TYPE", "ISOTROPIC") != "ISOTROPIC":
        source.fail(line, f"found *VISCOELASTIC, {given or 'nothing'}; expected TIME=PRONY of a "
                          "solid, with ratios and times")  # fmt: skip
    terms = rows("VISCOELASTIC", 3, 4)
    part = 1 - math.fsum(row[0] for row in terms)
    if moduli == "LONGTERM":
        if not 0 < part < 1:
            source.fail(line, f"found ratios of {1 - part:g} in all, expected less than 1")
        ratio = ratio if any(row[1] for row in terms) else _ratio_after(ratio, 1 / part)
        start /= part
    shift = {}
    if "TRS" in found and source.use_shift:
        _, i, options, *_ = found["TRS"]
        physical = found["PHYSICAL CONSTANTS"][2] if "PHYSICAL CONSTANTS" in found else {}
        law, gas = options.get("DEFINITION", "WLF"), _gas(source.units)
        if law not in ("WLF", "ARRHENIUS"):
            source.fail(i, f"found DEFINITION={law}, expected WLF or ARRHENIUS; or "
                           f"{option('use_shift', False)}")  # fmt: skip
        reference, *values = rows("TRS", 3 if law == "WLF" else 2)[0]
        stated = physical.get("ABSOLUTEZERO")
        if law == "ARRHENIUS":
            values[0] *= gas / source.number(i, physical.get("UNIVERSALGAS", repr(gas)))
        zero = None if stated is None else source.number(i, stated)
        shift = _law(law.lower(), source.kelvin(reference, zero), *values)
    return source.card(
        line, [(start * row[0], row[2]) for row in terms], start * part,
        [(row[1], row[2]) for row in terms], ratio, shift=shift, name=name,
        density=rows("DENSITY", 1, 2)[0][0] if "DENSITY" in found else None,
    )  # fmt: skip


#: Laws of *HYPERELASTIC by constants: kind of their polynomial, and its order if that is not N
_HYPERELASTIC = {
    "NEOHOOKE": ("reduced", 1), "YEOH": ("reduced", 3), "REDUCEDPOLYNOMIAL": ("reduced", 0),
    "MOONEY-RIVLIN": ("whole", 1), "POLYNOMIAL": ("whole", 0), "OGDEN": ("ogden", 0),
}  # fmt: skip
#: Numbers in a line of Abaqus
_IN_LINE = 8


def _hyperelastic(
    source: Source, line: int, options: Mapping[str, str], lines: list[Line]
) -> tuple[float, float]:
    """Shear modulus and Poisson's ratio of *HYPERELASTIC at small strains.

    A polynomial in (I1 - 3) and (I2 - 3) has G = 2 (C10 + C01), the strain energy of Ogden
    sum of 2 mu_i/alpha_i^2 (...) has G = sum of mu_i; D1 is that of (J - 1)^2/D1: K = 2/D1.
    """
    form = ", ".join(one for one in options if one not in ("MODULI", "N")) or "POLYNOMIAL"
    if form not in _HYPERELASTIC:
        source.fail(line, f"found *HYPERELASTIC, {form}, expected constants of NEO HOOKE, "
                          "MOONEY-RIVLIN, YEOH, POLYNOMIAL, REDUCED POLYNOMIAL or OGDEN, or "
                          "*ELASTIC")  # fmt: skip
    kind, order = _HYPERELASTIC[form]
    n = order or source.number(line, options.get("N", "1"))
    if n not in range(1, 7):
        source.fail(line, f"found *HYPERELASTIC, N={n:g}, expected a whole number from 1 to 6")
    n = int(n)
    first = {"reduced": n, "whole": n * (n + 3) // 2, "ogden": 2 * n}[kind]
    cells: list[float] = []
    table = [(i, text.rstrip(", ").split(",")) for i, text in lines if text.strip(", ")]
    for k, (i, row) in enumerate(table):
        # each line but the last one has eight numbers, 0 where there is none
        cells += [0.0] * (_IN_LINE * k - len(cells)) + [source.number(i, word) for word in row]
    if len(table) > math.ceil((first + n) / _IN_LINE):
        source.fail(line, f"found *HYPERELASTIC, {form} with {len(table)} lines, expected the "
                          f"{first + n} constants at one temperature")  # fmt: skip
    if not first <= len(cells) <= first + n + 1:
        source.fail(line, f"found {len(cells)} numbers of *HYPERELASTIC, {form}, expected "
                          f"{first + n}: {first} and {n} of the volume")  # fmt: skip
    c10, c01 = [*cells, 0.0][:2]
    says, value, part = {
        "reduced": ("C10", c10, 2),
        "whole": ("C10 + C01", c10 + c01, 2),
        "ogden": ("the sum of mu", math.fsum(cells[:first:2]), 1),
    }[kind]
    if form != "NEOHOOKE":
        source.remarks.append(f"*HYPERELASTIC, {form} is read at small strains: G is {part} times "
                              f"{says}")  # fmt: skip
    return _volume(source, line, (says, value), ("D1", [*cells[first:], 0.0][0]), part * value)


def _volume(
    source: Source, line: int, first: tuple[str, float], second: tuple[str, float], shear: float
) -> tuple[float, float]:
    """Shear modulus and Poisson's ratio of a hyperelastic solid, by two of its constants.

    The second one, D, is that of (J - 1)^2/D: the bulk modulus is 2/D.
    """
    (what, one), (which, d) = first, second
    if not (one > 0 and d >= 0):
        source.fail(line, f"found {what} = {one:g} and {which} = {d:g}, expected {what} > 0 and "
                          f"{which} >= 0")  # fmt: skip
    if d == 0:
        source.remarks.append(f"{which} = 0: the material is incompressible, Poisson's ratio 0.5")
    return shear, _ratio(2 / d, shear) if d else 0.5


# ---------------------------------------------------------------------------------------- Ansys

_TN = "the shift of kind TN is taken as ln A = H/R (1/Tr - 1/T), unconfirmed: check it"


def _write_ansys(card: Card, number: str = "1") -> list[str]:
    """Lines of commands MP and TB for material `number`."""
    values = {"DENS": card.density, "EX": card.glassy_modulus, "PRXY": card.poisson_ratio}
    lines = [f"MP,{key},{number},{_number(one)}" for key, one in values.items() if one is not None]
    pairs = list(map(_number, itertools.chain(*zip(card.ratios, card.times, strict=True))))
    rows = [f"TBDATA,{i + 1},{','.join(pairs[i : i + 3])}" for i in range(0, len(pairs), 3)]
    for kind in ("SHEAR", "BULK"):
        lines += [f"TB,PRONY,{number},1,{len(card.times)},{kind}", *rows]
    if constants := card.constants:
        wlf = card.shift["shift"] == "wlf"
        constants[1] /= 1 if wlf else _gas(card.units)
        lines.append(f"TB,SHIFT,{number},1,{len(constants)},{'WLF' if wlf else 'TN'}")
        lines.append(f"TBDATA,1,{','.join(map(_number, constants))}")
    return lines


def _write_mpl(card: Card) -> list[str]:
    """Lines of a material library: those of Ansys for the material _MATL."""
    begin = ["/NOP", "TBDEL,ALL,_MATL", "MPDEL,ALL,_MATL"]
    return [*begin, *_write_ansys(card, "_MATL"), "/GO"]


def _read_ansys(source: Source) -> Card:
    """The material of commands MP and TB: PRONY with its SHIFT, and elastic constants."""
    properties: dict[tuple[str, str], Line] = {}
    tables: dict[tuple[str, str], tuple[int, float, list[str]]] = {}
    current: list[str] = []
    at = 0
    commands = [(i, one) for i, text in source.lines for one in text.split("!")[0].split("$")]
    for i, command in commands:
        words = [word.strip() for word in command.split(",")] + [""] * 6
        what, label, number = words[0].upper(), words[1].upper()[:4], words[2] or "1"
        if what in ("MP", "MPDATA"):
            # MPDATA has the location of its first number before it
            value, *more = words[3:] if what == "MP" else words[4:]
            if any(source.number(i, word) for word in more):
                source.fail(i, f"found {label} that depends on temperature, expected a constant")
            properties[number, label] = i, value
        elif what == "TBTEMP":
            if any(current):
                source.fail(i, "found constants at several temperatures, expected one")
            at = 0
        elif what == "TB":
            current, at = [], 0
            if label in ("PRON", "SHIF", "HYPE"):
                word = words[5].upper()
                kind = word[:4] if label == "PRON" else f"{label} {word}"
                tables[number, kind] = i, source.number(i, words[4]), current
        elif what == "TBDATA":
            # without a location it goes on after the last one
            first = int(source.number(i, label)) - 1 if label else at
            if not 0 <= first <= len(current):
                source.fail(i, f"found TBDATA,{label}, expected {len(current) + 1}")
            given = words[2:]
            while given and not given[-1]:
                given.pop()
            current[first : first + len(given)] = given
            at = first + len(given)
    name = source.choose([number for number, kind in tables if kind == "SHEA"])

    def terms(kind: str) -> Terms:
        """Ratios and times."""
        at, n, texts = tables.get((name, kind), (0, 0.0, []))
        numbers = [source.number(at, text) for text in texts]
        n = n or len(numbers) / 2
        if len(numbers) != 2 * n:
            source.fail(at, f"found {len(numbers)} constants of TB,PRONY, expected {2 * n:g}")
        return list(zip(numbers[::2], numbers[1::2], strict=True))

    def constant(*labels: str) -> float | None:
        """The first of these properties that there is."""
        lines = [properties[name, one] for one in labels if (name, one) in properties]
        return source.number(*lines[0], sums=True) if lines else None

    def elastic() -> tuple[float, float]:
        """Shear modulus at once and Poisson's ratio, by EX or by a hyperelastic solid."""
        for (number, kind), (line, count, texts) in tables.items():
            if number != name or not kind.startswith("HYPE"):
                continue
            if constant("EX") is not None:
                source.fail(line, "found TB,HYPER and MP,EX, expected one of them")
            return _hyper_of_ansys(source, line, kind.partition(" ")[2], count, texts)
        modulus, ratio = source.elastic(constant("EX"), constant("PRXY", "NUXY"))
        return modulus / (2 * (1 + ratio)), ratio

    shift = {}
    for (number, kind), (line, _, texts) in tables.items():
        if number == name and kind.startswith("SHIF ") and source.use_shift:
            wlf = kind == "SHIF WLF"
            if not wlf and kind != "SHIF TN":
                source.fail(line, f"found TB,SHIFT of kind {kind[5:]}, of which the meaning is not "
                                  "in the card; expected WLF or TN, or "
                                  f"{option('use_shift', False)}")  # fmt: skip
            values = [source.number(line, text, sums=True) for text in texts]
            if len(values) != (3 if wlf else 2):
                source.fail(line, f"found {len(values)} constants of TB,SHIFT")
            values[1] *= 1 if wlf else _gas(source.units)
            values[0] = source.kelvin(values[0])
            shift = _law("wlf" if wlf else "arrhenius", *values)
            shift |= {} if wlf else {"remark": _TN}
    start, ratio = elastic()
    shear = terms("SHEA")
    rest = start * (1 - math.fsum(part for part, _ in shear))
    return source.card(
        tables[name, "SHEA"][0], [(start * part, time) for part, time in shear], rest,
        terms("BULK"), ratio, density=constant("DENS"), shift=shift,
    )  # fmt: skip


def _hyper_of_ansys(
    source: Source, line: int, kind: str, count: float, texts: list[str]
) -> tuple[float, float]:
    """Shear modulus and Poisson's ratio of TB,HYPER at small strains.

    Neo-Hooke has G = mu, polynomials in (I1 - 3) and (I2 - 3) have G = 2 (C10 + C01), the strain
    energy of Ogden, sum of mu_i/alpha_i (...), has G = sum of mu_i alpha_i/2; d of (J - 1)^2/d
    follows the other constants: K = 2/d.
    """
    values = [source.number(line, text) for text in texts]
    n = int(count or 1)
    found = kind[:4]
    # how many constants stand before those of the volume
    before = {"NEO": 1, "NEOH": 1, "MOON": int(count or 2), "YEOH": n, "OGDE": 2 * n,
              "POLY": n * (n + 3) // 2}  # fmt: skip
    if found not in before:
        source.fail(line, f"found TB,HYPER of kind {kind or 'none'}, expected NEO, MOONEY, YEOH, "
                          "OGDEN or POLY with constants, or MP,EX")  # fmt: skip
    first, volumes = before[found], n if found in ("YEOH", "OGDE", "POLY") else 1
    if not first <= len(values) <= first + volumes:
        source.fail(line, f"found {len(values)} constants of TB,HYPER,,,,{kind}, expected "
                          f"{first + volumes}: {first} and {volumes} of the volume")  # fmt: skip
    one, other = [*values, 0.0][:2]
    if found in ("NEO", "NEOH"):
        says, value, part = "mu", one, 1.0
    elif found == "YEOH":
        says, value, part = "C10", one, 2.0
    elif found == "OGDE":
        pairs = zip(values[:first:2], values[1:first:2], strict=True)
        says, value, part = "the sum of mu alpha", math.fsum(a * b for a, b in pairs), 0.5
    else:
        says, value, part = "C10 + C01", one + other, 2.0
    if part != 1:
        source.remarks.append(f"TB,HYPER,,,,{kind} is read at small strains: G is {part:g} times "
                              f"{says}")  # fmt: skip
    return _volume(source, line, (says, value), ("d", [*values[first:], 0.0][0]), part * value)


# -------------------------------------------------------------------------------------- LS-DYNA

_DYNA_WLF = (
    "the sign of a in the WLF shift of LS-DYNA is unconfirmed, a = C1 ln 10 is taken: check one "
    "element at two temperatures"
)
#: Numbers in the first line of a card, by the names of its keyword
_DYNA = {"GENERAL_VISCOELASTIC": 8, "076": 8, "76": 8, "VISCOELASTIC": 6, "006": 6, "6": 6}


def _write_general(card: Card) -> list[str]:
    """Lines of *MAT_GENERAL_VISCOELASTIC: terms of shear and bulk modulus by decay rates."""
    g, k, constants = card.shear, card.bulk, [*card.constants, 0.0, 0.0, 0.0][:3]
    if card.shift:
        constants[1] *= math.log(10) if card.shift["shift"] == "wlf" else 1 / _gas(card.units)
    terms = [(modulus, 1 / time) for modulus, time in card.terms]
    terms += [(card.equilibrium_modulus, 0.0)] * (card.equilibrium_modulus > 0)
    return [
        "*MAT_GENERAL_VISCOELASTIC_TITLE+",
        card.name,
        *_lines("$", "mid ro bulk pcf ef tref a b",
                "1", card.density, k * card.glassy_modulus, 0.0, 0.0, *constants),
        *_lines("$", "lcid nt bstart tramp lcidk ntk bstartk trampk", *["0"] * 8),
        *_lines("$", "gi betai ki betaki"),
        *(_row(g * modulus, rate, k * modulus, rate) for modulus, rate in terms),
    ]  # fmt: skip


def _write_one_term(card: Card) -> list[str]:
    """Lines of *MAT_VISCOELASTIC: one term of shear, a constant bulk modulus."""
    moduli = (card.shear * card.glassy_modulus, card.shear * card.equilibrium_modulus)
    return [
        "*MAT_VISCOELASTIC_TITLE+",
        card.name,
        *_lines("$", "mid ro bulk g0 gi beta",
                "1", card.density, card.bulk * card.glassy_modulus, *moduli, 1 / card.times[0]),
    ]  # fmt: skip


def _read_lsdyna(source: Source) -> Card:
    """The material of *MAT_GENERAL_VISCOELASTIC (076) or *MAT_VISCOELASTIC (006)."""
    cards, others, long = [], [], False
    for i, head, lines in source.blocks("*", ("$",)):
        word = (head.upper().split() or [""])[0]
        if word == "KEYWORD":
            long = re.search(r"LONG\s*=\s*[YK]", head.upper()) is not None
        kind = word.removeprefix("MAT_").rstrip("+-%").removesuffix("_TITLE")
        if word.startswith("MAT_") and kind in _DYNA:
            width = 20 if word.endswith("+") or long and not word.endswith("-") else 10
            title = lines.pop(0)[1].strip() if "_TITLE" in word and lines else source.name
            cards.append((title, i, _DYNA[kind], lines, width))
        elif word.startswith("MAT_"):
            others.append((i, word))
    source.once([(title, i) for title, i, *_ in cards])
    if not cards and others:
        i, word = others[0]
        source.fail(i, f"found *{word}, expected *MAT_GENERAL_VISCOELASTIC (076) or "
                       "*MAT_VISCOELASTIC (006)")  # fmt: skip
    found = {title: (i, count, lines, width) for title, i, count, lines, width in cards}
    name = source.choose(list(found))
    line, count, lines, width = found[name]
    if len(lines) < (1 if count == 6 else 3):
        source.fail(line, "the card is cut off")
    _, density, bulk, *rest = source.columns(lines[0], *[width] * count)
    if count == 6:
        return _one_term(source, lines[0][0], density, bulk, *rest, name=name)
    if any(source.columns(lines[1], *[width] * 8)[::4]):
        source.fail(lines[1][0], "found a load curve (LCID, LCIDK) in the second line of the card, "
                                 "which may be blank, expected rows of moduli and rates after "
                                 "it")  # fmt: skip
    rows = [(i, source.columns((i, text), *[width] * 4)) for i, text in lines[2:]]
    if flawed := [i for i, row in rows if min(row) < 0]:
        source.fail(flawed[0], "expected moduli and rates >= 0")
    parts = [[row[:2] for _, row in rows], [row[2:] for _, row in rows]]
    ends = [math.fsum(modulus for modulus, rate in part if rate == 0) for part in parts]
    terms = [[(modulus, 1 / rate) for modulus, rate in part if rate > 0] for part in parts]
    whole = [math.fsum(modulus for modulus, _ in part) for part in parts]
    if not (whole[1] or bulk > 0):
        source.fail(lines[0][0], f"found bulk = {bulk:g}, expected a number > 0")
    _, _, reference, a, b = rest
    shift = {}
    if a:
        reference = source.kelvin(reference)
    if a and b:
        shift = _law("wlf", reference, abs(a) / math.log(10), b) | {"remark": _DYNA_WLF}
    elif a:
        shift = _law("arrhenius", reference, a * _gas(source.units))
    shares = [(modulus / whole[1], time) for modulus, time in terms[1]]
    return source.card(lines[0][0], terms[0], ends[0], shares, _ratio(whole[1] or bulk, whole[0]),
                       density=density, shift=shift, name=name)  # fmt: skip


def _one_term(
    source: Source, line: int, density: float, bulk: float, g0: float, g: float, beta: float,
    *, name: str,
) -> Card:  # fmt: skip
    """Material of a card with one term."""
    if not (beta > 0 and bulk > 0 and g0 > g >= 0):
        source.fail(line, "expected K > 0, G0 > GI >= 0 and BETA > 0, and no curves")
    return source.card(line, [(g0 - g, 1 / beta)], g, [], _ratio(bulk, g0), density=density,
                       name=name)  # fmt: skip


# ----------------------------------------------------------------------------------- OpenRadioss


def _write_ogden(card: Card) -> list[str]:
    """Lines of /MAT/LAW42, linear by one term of exponent 2, with the terms in /VISC/PRONY."""
    g, k = card.shear, card.bulk
    return [
        "/MAT/LAW42/1",
        card.name,
        *_lines("#", "RHO_I", card.density),
        _lines("#", "Nu sigma_cut funIDbulk Fscale_bulk")[0] + "         M    I_form",
        _row(card.poisson_ratio),
        *_lines("#", "Mu_1", g * card.equilibrium_modulus),
        *_lines("#", "Mu_6", 0.0),
        *_lines("#", "alpha_1", 2.0),
        *_lines("#", "alpha_6", 0.0),
        "/VISC/PRONY/1",
        "#        M                           K_v      Itab    Ishape",
        f"{len(card.times):10d}{_row(None, 0.0)[10:]}{0:10d}{0:10d}",
        *_lines("#", "G_i Beta_i K_i Beta_ki"),
        *(_row(g * modulus, 1 / time, k * modulus, 1 / time) for modulus, time in card.terms),
    ]


def _write_boltzman(card: Card) -> list[str]:
    """Lines of /MAT/LAW34: one term of shear, a constant bulk modulus."""
    moduli = (card.shear * card.glassy_modulus, card.shear * card.equilibrium_modulus)
    return [
        "/MAT/LAW34/1",
        card.name,
        *_lines("#", "RHO_I", card.density),
        *_lines("#", "K", card.bulk * card.glassy_modulus),
        *_lines("#", "G_0 G_l Beta", *moduli, 1 / card.times[0]),
        *_lines("#", "P_0 Phi Gamma_0", 0.0, 0.0, 0.0),
    ]


def _read_openradioss(source: Source) -> Card:
    """The material of /MAT/LAW34, one Maxwell term, or of /MAT/LAW42 with /VISC/PRONY."""
    blocks: dict[tuple[str, str, str], tuple[int, list[Line]]] = {}
    for i, head, lines in source.blocks("/", ("#", "$")):
        kind, law, number, *_ = [*head.upper().split("/"), "", ""]
        if kind in ("MAT", "VISC") and (kind, law, number) in blocks:
            source.fail(i, f"found a second /{kind}/{law}/{number}")
        blocks[kind, law, number] = i, lines
    laws = {"LAW34": 1, "BOLTZMAN": 1, "LAW42": 0, "OGDEN": 0}
    source.once(
        [
            ((lines or [(0, "")])[0][1].strip(), i)
            for (kind, law, _), (i, lines) in blocks.items()
            if kind == "MAT" and law in laws
        ]
    )
    found = {(lines or [(0, "")])[0][1].strip(): (i, laws[law], number, lines[1:])
             for (kind, law, number), (i, lines) in blocks.items()
             if kind == "MAT" and law in laws}  # fmt: skip
    name = source.choose(list(found))
    line, one_term, number, lines = found[name]
    visc, rows = blocks.get(("VISC", "PRONY", number), (0, []))
    if len(lines) < (3 if one_term else 6) or not (one_term or rows):
        source.fail(line, "the card is cut off, expected /MAT/LAW34, or /MAT/LAW42 and /VISC/PRONY")
    density = source.columns(lines[0], 20, 20)[0]
    if one_term:
        bulk, *_ = source.columns(lines[1], 20)
        return _one_term(source, lines[2][0], density, bulk, *source.columns(lines[2], 20, 20, 20),
                         name=name)  # fmt: skip
    ratio, _, _, _, _, order, _ = source.columns(lines[1], 20, 20, 10, 10, 20, 10, 10)
    if ratio in (0, 0.5) or order:
        source.fail(lines[1][0], "expected M = 0 and a Nu that is neither 0.5 nor 0, read as 0.495")
    five = [20] * 5
    mu, alpha = (source.columns(lines[k], *five) + source.columns(lines[k + 1], *five)
                 for k in (2, 4))  # fmt: skip
    n, _, kv, tables, _ = source.columns(rows[0], 10, 10, 20, 10, 10)
    if kv or tables or len(rows) <= n:
        source.fail(visc, f"found {len(rows) - 1} of {n:g} terms, expected all, no K_v, no Itab")
    values = [(i, source.columns((i, text), *[20] * 4)) for i, text in rows[1 : int(n) + 1]]
    if flawed := [i for i, (_, rate, k, rate_k) in values if rate <= 0 or k and rate_k <= 0]:
        source.fail(flawed[0], "expected rates > 0")
    shear = [(g, 1 / rate) for _, (g, rate, _, _) in values]
    bulk_terms = [(k, 1 / rate) for _, (_, _, k, rate) in values if k]
    rest = math.fsum(a * b for a, b in zip(mu, alpha, strict=True)) / 2
    k_0 = math.fsum([rest * 2 * (1 + ratio) / (3 * (1 - 2 * ratio)), *(k for k, _ in bulk_terms)])
    g_0 = math.fsum([rest, *(g for g, _ in shear)])
    shares = [(k / k_0, time) for k, time in bulk_terms]
    ratio = ratio if shares else _ratio(k_0, g_0)
    return source.card(lines[1][0], shear, rest, shares, ratio, density=density, name=name)


# --------------------------------------------------------------------------------------- COMSOL


def _write_comsol(card: Card) -> list[str]:
    """Lines of a table of branches, shear modulus and relaxation time, with constants above."""
    values = {
        "density": card.density, "shear_modulus": card.shear * card.equilibrium_modulus,
        "bulk_modulus": card.bulk * card.glassy_modulus, **card.shift,
    }  # fmt: skip
    return [
        *(f"% {key} = {one if isinstance(one, str) else _number(one)}"
          for key, one in values.items() if one is not None),
        "% branch, shear modulus, relaxation time",
        *(f"{i} {_number(card.shear * modulus)} {_number(time)}"
          for i, (modulus, time) in enumerate(card.terms, 1)),
    ]  # fmt: skip


def _read_comsol(source: Source) -> Card:
    """The material of a table of branches, with elastic constants and a shift in its remarks."""
    given = {key: (i, value) for i, text in source.lines
             for key, value in re.findall(r"^%\s*(\w+) = (\S+)$", text)}  # fmt: skip
    values = {key: source.number(*line) for key, line in given.items() if key != "shift"}
    rows = [(i, text.split()) for i, text in source.lines if text and not text.startswith("%")]
    if flawed := [i for i, row in rows if len(row) != 3]:
        source.fail(flawed[0], "expected three columns: branch, shear modulus, relaxation time")
    shear = [(source.number(i, row[1]), source.number(i, row[2])) for i, row in rows]
    relaxing = math.fsum(modulus for modulus, _ in shear)
    if "shear_modulus" in values and "bulk_modulus" in values:
        rest = values["shear_modulus"]
        ratio = _ratio(values["bulk_modulus"], rest + relaxing)
    else:
        modulus, ratio = source.elastic(None, None)
        rest = modulus / (2 * (1 + ratio)) - relaxing
    shift = {}
    if "shift" in given:
        line, law = given["shift"]
        if not set(_CONSTANTS.get(law, [law])) <= set(values):
            source.fail(line, f"found shift = {law}, expected wlf or arrhenius with its constants")
        reference, *constants = (values[key] for key in _CONSTANTS[law])
        shift = _law(law, source.kelvin(reference), *constants)
    return source.card(rows[0][0] if rows else 0, shear, rest, [], ratio,
                       density=values.get("density"), shift=shift)  # fmt: skip


_SHIFTS = {"wlf": "", "arrhenius": ""}
_MIXED = "hybrid or mixed elements, or Poisson's ratio 0.495"
#: Formats by name
FORMATS = {
    "abaqus": Format("** ", _write_abaqus, _read_abaqus, _SHIFTS, dense=False,
                     incompressible=_MIXED, title=80, quote='"'),
    "ansys": Format("! ", _write_ansys, _read_ansys, _SHIFTS | {"arrhenius": _TN}, dense=False,
                    incompressible=_MIXED),
    "ansys-mpl": Format("! ", _write_mpl, _read_ansys, _SHIFTS | {"arrhenius": _TN},
                        dense=False, incompressible=_MIXED),
    "lsdyna": Format("$ ", _write_general, _read_lsdyna, _SHIFTS | {"wlf": _DYNA_WLF}, terms=18,
                     constant=True, fluid=True, title=80, marks="*$ "),
    "lsdyna-006": Format("$ ", _write_one_term, _read_lsdyna, bulk=False, terms=1, fluid=True,
                         title=80, marks="*$ "),
    "openradioss": Format("# ", _write_ogden, _read_openradioss, forbidden=0.0,
                          title=100, marks="/#$ "),
    "openradioss-law34": Format("# ", _write_boltzman, _read_openradioss, bulk=False, terms=1,
                                fluid=True, title=100, marks="/#$ "),
    "comsol": Format("% ", _write_comsol, _read_comsol, _SHIFTS, bulk=False, dense=False),
}  # fmt: skip
