"""Units of measured data: how much of which SI unit they are."""

from __future__ import annotations

import math
import re
import unicodedata

#: 0 C [K]
ZERO_C = 273.15
#: 1 Hz [rad/s]
TURN = 2 * math.pi
#: Gas constant [J/(mol K)]
GAS = 8.31446261815324
PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
_POWERS = {prefix: 10.0**power for power, prefix in PREFIXES.items()}
#: By SI unit: units that take a prefix, in SI units, and the prefixes
_SCALED = {
    "s": ({"s": 1.0}, "nµm"), "rad/s": ({"rad/s": 1.0, "Hz": TURN}, "mkMG"),
    "m": ({"m": 1.0}, "nµmk"), "Pa": ({"Pa": 1.0}, "kMG"),
    "N": ({"N": 1.0, "gf": 9.80665e-3}, "nµmkM"),
    "J": ({"J": 1.0}, "nµmkM"), "W": ({"W": 1.0}, "nµmkM"), "kg": ({"g": 1e-3}, "µmk"),
    "m/s": ({"m/s": 1.0}, "µmk"), "J/mol": ({"J/mol": 1.0}, "k"), "N s": ({"N s": 1.0}, "nµmk"),
    "Pa s": ({"Pa s": 1.0}, "µmkM"),
}  # fmt: skip
_OTHERS = {
    "s": {"min": 60.0, "h": 3600.0, "d": 86400.0},
    "rad/s": {"1/s": 1.0, "rpm": math.pi / 30},
    "m": {"cm": 0.01, "in": 0.0254, "ft": 0.3048},
    "Pa": {"N/m2": 1.0, "N/mm2": 1e6, "N/cm2": 1e4, "bar": 1e5, "psi": 6894.757293168361,
           "ksi": 6894757.293168361, "dyn/cm2": 0.1, "kgf/cm2": 98066.5, "kgf/mm2": 9.80665e6},
    "N": {"lbf": 4.4482216152605, "dyn": 1e-5},
    "kg": {"t": 1e3, "lb": 0.45359237, "oz": 0.028349523125},
    "m/s": {"cm/s": 0.01, "km/h": 1 / 3.6, "ft/s": 0.3048, "in/s": 0.0254, "mph": 0.44704},
    "m/s2": {"m/s2": 1.0, "cm/s2": 0.01, "mm/s2": 1e-3, "g": 9.80665, "gn": 9.80665},
    "1": {"1": 1.0, "-": 1.0, "%": 0.01},
    "kg/m3": {"kg/m3": 1.0, "g/cm3": 1e3},
    "1/s": {"1/s": 1.0},
    "rad": {"rad": 1.0, "deg": math.pi / 180},
    "K": {"K": 1.0, "C": 1.0, "F": 5 / 9},
}  # fmt: skip
_OFFSETS = {"C": ZERO_C, "F": ZERO_C - 160 / 9}
#: Units in words, and other spellings
_SPELLINGS = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sek": "s", "秒": "s", "msec": "ms",
    "milliseconds": "ms", "usec": "µs", "minutes": "min", "minute": "min", "分": "min",
    "hours": "h", "hour": "h", "newton": "N", "newtons": "N", "pascal": "Pa", "pascals": "Pa",
    "°c": "C", "degc": "C", "deg c": "C", "celsius": "C", "grad c": "C", "oc": "C", "ºc": "C",
    "kelvin": "K", "°k": "K", "°f": "F", "degf": "F", "hertz": "Hz", "°": "deg", "º": "deg",
    "degrees": "deg", "degree": "deg", "radians": "rad", "percent": "%", "pct": "%",
    "g/cc": "g/cm3", "ns": "ns", "n.s": "N s", "n s": "N s", "pa.s": "Pa s", "pas": "Pa s",
    "meter": "m", "meters": "m", "metres": "m", "kph": "km/h", "dimensionless": "1",
    "rads": "rad/s", "mps": "m/s", "kn": "kN",
}  # fmt: skip
#: Units that names may end with, in lower case, as programmers write them
_SUFFIXES = {
    **{unit.lower(): unit for unit in (
        "Hz", "kHz", "Pa", "kPa", "MPa", "GPa", "s", "ms", "µs", "min", "m", "cm", "mm", "µm", "N",
        "kN", "mN", "K", "kg", "g", "mg", "deg", "rad", "Hz")},
    "us": "µs", "um": "µm", "c": "C", "degc": "C", "celsius": "C", "kelvin": "K", "sec": "s",
    "rad s": "rad/s", "rads": "rad/s", "radps": "rad/s", "rad/s": "rad/s", "m s": "m/s",
    "m/s": "m/s", "mps": "m/s", "mm s": "mm/s", "cm s": "cm/s", "m s2": "m/s2", "pct": "%",
    "percent": "%",
}  # fmt: skip


def plain_unit(unit: str) -> str:
    """A unit as this module spells it: without brackets, powers as digits, one stroke."""
    text = unicodedata.normalize("NFKC", unit).replace("μ", "µ").replace("−", "-").strip()
    while len(text) > 1 and text[0] + text[-1] in ("[]", "()"):
        text = text[1:-1].strip()
    text = text.replace("^", "").replace("**", "").replace("⋅", "·")
    if text.lower() in _SPELLINGS:
        return _SPELLINGS[text.lower()]
    text = re.sub(r"\s*/\s*", "/", text)
    # rad s-1, m s-2, N·m-2
    if found := re.fullmatch(r"(.+?)[\s·.*]+([A-Za-z]+)-([12])", text):
        text = f"{found[1]}/{found[2]}{found[3].replace('1', '')}"
    elif found := re.fullmatch(r"([A-Za-z]+)-1", text):
        text = f"1/{found[1]}"
    text = re.sub(r"/(sec|second)$", "/s", text)
    text = re.sub(r"/(sec|s)2$", "/s2", text)
    text = re.sub(r"[\s·.*]+", " ", text)
    text = re.sub(r"^u(?=[smNAg]$|Pa$|N )", "µ", text)
    return {"": "", "Ns": "N s", "mNs": "mN s", "m s2": "m/s2"}.get(text, text)


def size(unit: str, si: str) -> tuple[float, float] | None:
    """A unit of a quantity as factor and offset to the SI unit, None if it is another unit."""
    return _size(plain_unit(unit), si)


def _size(unit: str, si: str) -> tuple[float, float] | None:
    """The same of a unit as this module spells it."""
    if unit == si:
        return 1.0, 0.0
    if unit in _OTHERS.get(si, {}):
        return _OTHERS[si][unit], _OFFSETS.get(unit, 0.0)
    scaled, prefixes = _SCALED.get(si, ({}, ""))
    for base, factor in scaled.items():
        prefix = unit.removesuffix(base)
        if unit.endswith(base) and len(prefix) < 2 and prefix in prefixes:
            return _POWERS[prefix] * factor, 0.0
    return None


def quantities_of(unit: str) -> list[str]:
    """SI units of the quantities that a unit may belong to."""
    plain = plain_unit(unit)
    return [si for si in {**_SCALED, **_OTHERS} if _size(plain, si)]


def suffix_unit(text: str) -> str:
    """Unit that the end of a name stands for, empty if it is none."""
    return _SUFFIXES.get(text.lower().replace("_", " ").strip(), "")


def examples(si: str) -> str:
    """Some units of a quantity, for messages."""
    return {
        "s": "s, ms, µs, min, h", "rad/s": "Hz, kHz, rad/s", "Pa": "Pa, kPa, MPa, GPa, N/mm2",
        "K": "C or K", "m": "m, cm, mm", "m/s": "m/s, mm/s, km/h", "N": "N, mN, kN",
        "m/s2": "m/s2 or g", "1": "1 or %", "rad": "deg or rad", "kg": "kg, g, mg",
    }.get(si, f"{si} or a multiple of it")  # fmt: skip
