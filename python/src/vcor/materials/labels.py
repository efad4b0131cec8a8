"""Temperatures in words: lines above a set of points, names of sheets, and heads of columns."""

from __future__ import annotations

import math
import re
import unicodedata
from dataclasses import dataclass

from ..units import size

#: Dashes that a word processor writes for a hyphen; a minus sign (U+2212) is never one
_DASHES = dict.fromkeys(range(0x2010, 0x2016), "-")
#: Temperature without a unit below which it is not in kelvin
COLDEST = 150.0
#: Difference of two statements of one temperature [K]
_ALIKE = 0.6
#: A number with its unit, as -20 °C, 253 K, 20.0 ± 0.1 °C or 68 °F; the sign may stand apart
TEMPERATURE = (
    r"(?P<sign>[-+−]\s*)?(?<!\d)(?<!\d[.,])(?P<digits>\d+(?:[.,]\d+)?)\s*"
    r"(?:(?:±|\+/-|\+-)\s*\d+(?:[.,]\d+)?\s*)?(?:(?:°|[Dd]eg(?:rees?|\.)?|[Gg]rad)\s*"
    r"(?P<degrees>(?i:celsius|kelvin|[CKF]))|(?P<unit>(?i:celsius|kelvin|[CK])|F))"
    r"(?![\w°^·]|/\s*(?:min|s|h)\b)"
)
_TEMPERATURE = re.compile(TEMPERATURE)
#: The quantity in the languages of the instruments, with an index or what kind it is
_NAME = (
    r"(?:[Tt]emp[ée]ratur[ae]?|TEMPERATURE?|[Tt]emp\.?|TEMP|T|温度|溫度)"
    r"(?:_?(?:set|soll|ist|nom|sample|probe|test))?(?:_?\d{1,2})?"
)
#: The unit before the number: T [°C] = -20, Temperature (K): 253, T/°C -20, T in °C; -20
_UNIT_FIRST = re.compile(
    rf"(?<![^\W\d_])(?P<name>{_NAME})\s*(?:\[|\(|/|,?\s+in\s+)\s*(?:°|deg\.?\s*)?(?P<unit>[CKF])(?:\s*[\])])?"
    r"(?P<mark>[\s,;:=]*)(?P<number>[-+−]?\s*\d+(?:[.,]\d+)?)\W*$"
)
#: The name and a number without a unit
_WITHOUT = re.compile(rf"(?:\W*{_NAME})\s*[\s,;:=]\s*(?P<number>[-+−]?\s*\d+(?:[.,]\d+)?)\W*")
#: Words of a line that does nothing but state the temperature of what follows
_WORDS = {
    "a", "à", "abschnitt", "actual", "at", "At", "bei", "block", "curve", "data", "daten",
    "etape", "étape", "feuille", "for", "freq", "frequency", "frequenz", "hoja", "interval",
    "intervall", "isotherm", "isothermal", "isotherme", "kurve", "measurement", "messung",
    "mesure", "muestra", "no", "No", "nominal", "nr", "Nr", "number", "of", "paso", "point",
    "probe", "relaxation", "run", "sample", "schritt", "segment", "série", "serie", "set",
    "setpoint", "sheet", "soll", "stage", "step", "stress", "sweep", "tabelle", "table", "target",
    "test", "the", "value",
}  # fmt: skip
#: How a line begins that states it among other things
_STEP = re.compile(
    r"\W*(step|sweep|interval|frequency sweep|schritt|abschnitt|sheet|set|stress relax"
    r"|relaxation|étape|paso|block|isotherm)",
    re.IGNORECASE,
)
#: Longest line or head that is taken apart: some expressions take the square of the length
LONGEST = 300


@dataclass(frozen=True)
class Label:
    """A temperature that a line states."""

    #: [K], nan: the line states none, or one that is not sure
    kelvin: float = math.nan
    #: Why it is not sure, for a message
    flaw: str = ""
    #: Whether it has a unit, or needs none
    has_unit: bool = True
    #: Whether the line says nothing else
    alone: bool = True
    #: Line of the file
    line: int = 0

    def __bool__(self) -> bool:
        return math.isfinite(self.kelvin) or bool(self.flaw)


#: No temperature is stated
UNLABELLED = Label()


def unified(text: str) -> str:
    """A text with one kind of hyphen, degree sign, letters and digits."""
    text = unicodedata.normalize("NFKC", text.replace("º", "°").replace("˚", "°"))
    text = text.translate(_DASHES)
    return re.sub(r"(?<![^\W\d_])(?:minus|moins|menos)\s*(?=\d)", "−", text, flags=re.IGNORECASE)


def read_label(text: str, *, among_others: bool = False) -> Label:
    """The temperature that a line states.

    Parameters
    ----------
    text
        The line; its cells with blanks between them.
    among_others
        Whether a line that begins as the title of a step may say more than the temperature; of
        other lines the flaw says so.
    """
    if len(text) > LONGEST or not any(map(str.isdigit, text)):
        return UNLABELLED
    # lines across the page are no signs
    text = re.sub(r"-{3,}|={2,}|_{3,}", " ", unified(text))
    text = re.sub(r"[;\t]+|(?<!\d),+|,+(?!\d)", " ", text).strip()
    if found := _UNIT_FIRST.search(text):
        rest, mark = text[: found.start()], found["mark"].rstrip() or found["mark"][:1]
        text = f"{rest}{found['name']}{mark}{found['number']} {found['unit']}"
    several = list(_TEMPERATURE.finditer(text))
    if not several:
        return _without_unit(text)
    told = [_told(text, one) for one in several]
    first = told[0]
    same = first and all(one and abs(one.kelvin - first.kelvin) < _ALIKE for one in told[1:])
    rest = _TEMPERATURE.sub(" \0 ", text)
    if first and same and (_is_bare(rest) or (among_others and _STEP.match(text))):
        return first
    if not among_others:
        return UNLABELLED
    flaw = f"found '{text[:60]}' above points, expected their temperature alone, as T = 20 °C"
    return Label(flaw=flaw, alone=False)


def _told(text: str, found: re.Match[str]) -> Label | None:
    """A temperature in a text with what is before it; None: the end of a range."""
    sign, before = found["sign"] or "", text[: found.start()]
    bare = before.rstrip()
    if re.search(r"\d\s*(?:to|bis|à|a|hasta|and|und|\.\.+|…|~|until|,)$", bare):
        return None
    # the end of a range, unless it is the number of a step that stands before it
    step = re.search(r"[^\W\d_][\s_.#]*\d+$", bare)
    if sign and sign[0] in "-−" and bare[-1:].isdigit() and not step:
        return None
    if sign.startswith("-"):
        attached, apart = sign == "-", bare != before or not before
        marked = bare[-1:] in ("=", ":", "~", "(", "[", "@", "<")
        if not marked and not (attached and (apart or bare[-1:] in ("_", ",", ";", "/", "|"))):
            return _unsure(found[0], before)
    value = float(found["digits"].replace(",", "."))
    unit = (found["degrees"] or found["unit"])[0].upper()
    factor, offset = size(unit, "K") or (1.0, 0.0)
    kelvin = (-value if sign and sign[0] in "-−" else value) * factor + offset
    if not kelvin > 0:
        return Label(flaw=f"found '{found[0].strip()}', expected a temperature above 0 K")
    return Label(kelvin)


def _unsure(text: str, before: str) -> Label:
    """A temperature whose mark is a minus sign or a dash."""
    sure = text.replace("-", "").strip()
    return Label(
        flaw=f"found '{(before[-30:] + text).strip()}', whose mark may be a minus sign or a "
        f"dash, expected T = -{sure} or T = {sure}"
    )


def _without_unit(text: str) -> Label:
    """A temperature without a unit: in kelvin, if it can be."""
    if not (found := _WITHOUT.fullmatch(text)):
        return UNLABELLED
    value = float(re.sub(r"\s", "", found["number"]).replace(",", ".").replace("−", "-"))
    if value >= COLDEST:
        return Label(value)
    flaw = f"found '{text.strip()}' without a unit, expected °C or K behind the number"
    return Label(flaw=flaw, has_unit=False)


def _is_bare(rest: str) -> bool:
    """Whether a text has nothing but the words of a label, each with a number behind it at most."""
    before = False
    for token in re.findall(r"[^\W\d_]+|\d+|\S", rest):
        if token.isdigit():
            if not before:
                return False
            before = False
        elif token[0].isalpha():
            before = token in _WORDS or re.fullmatch(_NAME, token) is not None
            before |= len(token) > 2 and token.casefold() in _WORDS
            if not before:
                return False
    return True
