"""A live page: the Bokeh document of one browser tab, with a case of its own."""

from __future__ import annotations

import base64
import contextlib
import functools
import html
import logging
import math
import re
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from bokeh.document import Document
from bokeh.models import (
    Button,
    Column,
    ColumnDataSource,
    CustomJS,
    Div,
    InlineStyleSheet,
    RadioButtonGroup,
    Row,
    Select,
    TextAreaInput,
    TextInput,
)

from .. import _library
from .._library import Error, InputError, NumericalError, UsageError
from ..case import Case
from ..material_files import material_case
from . import measured, take_away
from .answer import (
    Answer,
    Span,
    exact,
    height,
    materials_of,
    parts,
    path_of,
    sentence,
    start_of,
)
from .figures import COLOURS, MOST_KEPT, Figures
from .form import Form
from .keys import groups, key_of
from .measured import Measured
from .worker import Worker

#: Largest file that is taken [bytes]
MOST_BYTES = 4_000_000
#: Digits of e in large; all digits stand in the table of numbers
_DIGITS = 4
#: Numbers that the curve may be drawn against, in this order, before all others
_AXES = ("impact.drop_height", "impact.velocity", "impact.temperature", "sphere.diameter",
         "sphere.radius", "plate.thickness")  # fmt: skip
_BODIES = {"plate": "surface", "sphere": "ball"}
_log = logging.getLogger(__name__)


class Page:
    """Content of one browser tab.

    Parameters
    ----------
    document
        The document that is filled.
    case
        The case to begin with; the page changes a copy.
    files
        Files of the case and its materials, for the commands that make the same; none: the case
        stands in them.
    span
        What the curve is drawn against; None: the first number that the case has.
    folder
        Where the files that are dropped on the page are, in a folder of their own.
    """

    def __init__(
        self, document: Document, case: Case, files: Sequence[str], span: Span | None, folder: Path
    ) -> None:
        """Make the widgets, add them to the document and ask for the first answer."""
        self._document, self._files = document, list(files)
        self._folder = tempfile.TemporaryDirectory(dir=folder)
        self._worker, self._beside = Worker(), Worker()
        self._style = InlineStyleSheet(css=Path(__file__).with_name("widgets.css").read_text())
        self._styles = [self._style]
        self._figures = Figures()
        self._answer = Answer()
        self._kept: list[tuple[Case, Answer]] = []
        self._is_busy = False
        #: Number of the last question, so that no answer of an earlier one is shown
        self._number = 0
        #: Number of the question whose commands are shown
        self._lines_of = -1
        self.form = Form(case.copy(), self._changed, self._styles)
        self._span = span if span is not None else self._first_span()
        roots = (
            self.form.root, *self._answer_parts(), self._axis_part(), self._figures.curve_box,
            self._figures.small_box, *self._kept_parts(), *self._measured_parts(),
            *self._file_parts(), *self._take_parts(),
        )  # fmt: skip
        with document.models.freeze():
            for root in roots:
                document.add_root(root)
        self._figures.set_span(self._span, self._span_key())
        self._read_rows()
        document.on_session_destroyed(self._end)
        self._changed()

    def _end(self, _context: Any) -> None:
        """End the threads and remove the files of a tab that was closed."""
        self._worker.end()
        self._beside.end()
        self._folder.cleanup()

    def _later(self, show: Callable[..., None], *what: Any) -> None:
        """Show something from a thread, if the page is still there."""
        # the document of a tab that was closed has no callbacks any more
        with contextlib.suppress(AttributeError):
            self._document.add_next_tick_callback(functools.partial(show, *what))

    @property
    def case(self) -> Case:
        """The case of the page."""
        return self.form.case

    @staticmethod
    def _put(div: Div, text: str) -> None:
        """Show a text, or nothing where there is none."""
        div.text, div.visible = text, bool(text)

    def _div(self, name: str, text: str = "", *classes: str) -> Div:
        """An element for a text; invisible while there is none."""
        return Div(
            text=text,
            name=name,
            stylesheets=self._styles,
            css_classes=list(classes),
            visible=bool(text),
            sizing_mode="stretch_width",
        )

    def _button(self, label: str, press: Callable[[], None], name: str) -> Button:
        """A button that calls `press`."""
        made = Button(label=label, stylesheets=self._styles, name=name)
        made.on_click(lambda _event=None: press())
        return made

    # ------------------------------------------------------------------------- answers

    def _answer_parts(self) -> list[Any]:
        """Elements for e, e with exact mechanics, and the other numbers."""
        self._e = self._div("answer")
        self._numbers = self._div("numbers")
        self._exact = self._div("exact")
        return [self._e, self._exact, self._numbers]

    def _changed(self) -> None:
        """Ask for the answer to the case as it is now."""
        self._number += 1
        number = self._number
        self._e.css_classes = self._exact.css_classes = ["stale"]
        if self.form.faults:
            return
        case = self.case.copy()
        kept = [one for one, _ in self._kept]
        self._refresh_axis()
        span = self._span

        def found() -> Iterator[Answer]:
            """The answers one after another; a fault of the page is one, too."""
            try:
                yield from parts(case, span, kept)
            except Exception:
                _log.exception("vcor page")
                yield Answer(fault="a fault of the page; the terminal of vcor page says which")

        self._worker.ask(found, lambda one: self._later(self._show, number, one))

    def _show(self, number: int, answer: Answer) -> None:
        """Show an answer, unless the hand has moved on."""
        if number != self._number:
            return
        self._answer = answer
        if answer.fault:
            line = answer.fault
            if answer.code != NumericalError.code:
                line = self.form.blame(answer.fault)
            self._put(self._e, _no_answer(line))
            self._put(self._exact, "")
            self._e.css_classes = []
            self._put(self._numbers, "")
            return
        self.form.clear()
        assert answer.numbers is not None
        self._put(self._e, _answer_text(answer))
        self._e.css_classes = []
        self._put(self._numbers, _table(answer))
        here = self.case[self._span.address] if self._span else None
        self._figures.show(
            answer, float(here) if isinstance(here, (int, float)) else None,
            [one for _, one in self._kept],
        )  # fmt: skip
        if number != self._lines_of:
            self._lines_of = number
            self._show_lines()
            self._ask_exact(number)

    def _ask_exact(self, number: int) -> None:
        """Ask for e with exact mechanics, in a thread of its own: it takes longer."""
        case = self.case.copy()
        if case._has_mesh:
            self._put(self._exact, "")
            return
        self._beside.ask(lambda: iter([exact(case)]), lambda e: self._later(
            self._show_exact, number, e))  # fmt: skip

    def _show_exact(self, number: int, e: float) -> None:
        """Show e with exact mechanics, if the answer is to the last question."""
        if number != self._number:
            return
        text = f'<p class="exact">With exact mechanics e = {e:.{_DIGITS}f}</p>'
        self._put(self._exact, text if math.isfinite(e) else "")
        self._exact.css_classes = []

    # --------------------------------------------------------------------------- curve

    def _axes(self) -> dict[str, str]:
        """Numbers of the case, with their labels."""
        found = {}
        for address in [*_AXES, *_addresses(self.case)]:
            if address in found or address not in self.case:
                continue
            if isinstance(self.case[address], float):
                key = key_of(self.case, address)
                owner = address.rpartition(".")[0]
                found[address] = f"{owner.replace('_', ' ')}: {key.label}"
        return found

    def _first_span(self) -> Span | None:
        """Range of the first number that the case has; None: it has none."""
        for address in self._axes():
            return self._span_of(address)
        return None

    def _span_of(self, address: str) -> Span:
        """A range around the value of an address."""
        value = self.case[address]
        unit = key_of(self.case, address).unit
        first, last, is_log = start_of(value if isinstance(value, (int, float)) else None, unit)
        if is_log:
            first, last = (float(f"{one:.2g}") for one in (first, last))
        return Span(address, first, last, is_log)

    def _span_key(self) -> Any:
        """Key of the number of the axis; None: there is none."""
        return key_of(self.case, self._span.address) if self._span else None

    def _axis_part(self) -> Any:
        """Widgets that choose the number of the axis and its range."""
        self._axis = Select(title="e against", options=[], stylesheets=self._styles, name="axis",
                            sizing_mode="stretch_width")  # fmt: skip
        self._from = TextInput(title="from", stylesheets=self._styles, name="from", width=110)
        self._to = TextInput(title="to", stylesheets=self._styles, name="to", width=110)
        self._scale = Select(title="points", options=["equal steps", "equal ratios"], width=130,
                             stylesheets=self._styles, name="scale")  # fmt: skip
        self._axis_fault = self._div("axis_fault", "", "fault")
        self._is_setting = False
        self._axis.on_change("value", self._axis_chosen)
        for one in (self._from, self._to, self._scale):
            one.on_change("value", self._range_given)
        self._refresh_axis()
        row = Row(self._from, self._to, self._scale, styles={"flex-wrap": "wrap"})
        return Column(
            self._axis, row, self._axis_fault, sizing_mode="stretch_width", name="axis_row"
        )

    def _refresh_axis(self) -> None:
        """Show the axis; another one if the case no longer has its number."""
        known = self._axes()
        if self._span is None or self._span.address not in known:
            self._span = self._first_span()
            self._figures.set_span(self._span, self._span_key())
        self._is_setting = True
        try:
            self._axis.options = list(known.items())
            if self._span is None:
                return
            key = self._span_key()
            self._axis.value = self._span.address
            self._from.value, self._to.value = (
                key.shown(self._span.first),
                key.shown(self._span.last),
            )
            unit = f" [{'°C' if key.usual == 'C' else key.usual}]" * bool(key.usual)
            self._from.title, self._to.title = f"from{unit}", f"to{unit}"
            self._scale.value = "equal ratios" if self._span.is_log else "equal steps"
        finally:
            self._is_setting = False

    def _axis_chosen(self, _attr: str, _old: str, new: str) -> None:
        """Take another number for the axis."""
        if not self._is_setting:
            self._set_span(self._span_of(new))

    def _range_given(self, _attr: str, _old: str, _new: str) -> None:
        """Take the ends and the spacing of the axis, or say what is wrong with them."""
        if self._is_setting or self._span is None:
            return
        key = self._span_key()
        self._put(self._axis_fault, "")
        try:
            first, last = (float(key.written(one.value)) for one in (self._from, self._to))
            is_log = self._scale.value == "equal ratios"
            if not (math.isfinite(first) and math.isfinite(last) and first < last):
                raise ValueError
            if is_log and not first > 0:
                raise UsageError("equal ratios: found a range that begins at 0 or below, expected "
                                 "one above 0")  # fmt: skip
        except (ValueError, Error) as error:
            line = str(error) if isinstance(error, Error) else (
                f"found {self._from.value} to {self._to.value}, expected a range from the smaller "
                "to the larger number")  # fmt: skip
            self._put(self._axis_fault, html.escape(line))
            return
        self._set_span(Span(self._span.address, first, last, is_log))

    def _set_span(self, span: Span) -> None:
        """Draw the curve over another range and ask for it."""
        self._span = span
        self._put(self._axis_fault, "")
        self._figures.set_span(span, self._span_key())
        self._read_rows()
        self._changed()

    # ---------------------------------------------------------------------------- kept

    def _kept_parts(self) -> list[Any]:
        """Widgets that keep curves and list them."""
        keep = self._button("Keep this curve", self._keep, "keep")
        clear = self._button("Remove kept curves", self._forget, "forget")
        self._kept_list = self._div("kept")
        return [Column(Row(keep, clear, styles={"flex-wrap": "wrap"}), self._kept_list,
                       sizing_mode="stretch_width", name="kept_row")]  # fmt: skip

    def _keep(self) -> None:
        """Keep the curve, in the place of the oldest one if there are MOST_KEPT."""
        if self._answer.numbers is None:
            return
        if len(self._kept) == MOST_KEPT:
            del self._kept[0]
        self._kept.append((self.case.copy(), self._answer))
        self._changed()

    def _forget(self) -> None:
        """Remove the kept curves."""
        self._kept.clear()
        self._changed()

    def _labels(self) -> list[str]:
        """Labels of the present case and each kept one: the values that differ."""
        cases = [self.case, *[one for one, _ in self._kept]]
        addresses: dict[str, None] = {}
        for one in cases[1:]:
            addresses |= dict.fromkeys(take_away.differences(one, cases[0]))
        if self._span:
            addresses.pop(self._span.address, None)
        labels = []
        for case in cases:
            words = []
            for address in addresses:
                if address not in case or (value := case[address]) is None:
                    continue
                key = key_of(case, address)
                # what belongs to a material has its name
                if key.group == "material" and address.partition(".")[0] not in map(
                    path_of, materials_of(case)
                ):
                    continue
                unit = {"C": "°C", "1": ""}.get(key.usual, key.usual)
                owner = address.rpartition(".")[0].replace("_", " ")
                words.append(
                    f"{owner} {key.name.replace('_', ' ')} {key.shown(value)} {unit}".strip()
                )
            labels.append(", ".join(words) or "the same values")
        return labels

    def _show_kept(self) -> None:
        """List what distinguishes the present and the kept curves, with their e."""
        if not self._kept:
            self._put(self._kept_list, "")
            return
        colours = COLOURS[self._figures.is_dark]
        lines = []
        for i, label in enumerate(self._labels()):
            chip = (
                f'<span class="chip" style="color:{colours[i]}">{"━━" if i == 0 else "╍╍"}</span>'
            )
            now = "now: " if i == 0 else ""
            answer = self._answer if i == 0 else self._kept[i - 1][1]
            e = answer.numbers["cor_sphere"] if answer.numbers else math.nan
            lines.append(f"<li>{chip} {now}{html.escape(label)}; e = {float(e):.{_DIGITS}f}</li>")
        self._put(self._kept_list, f"<ul>{''.join(lines)}</ul>")

    # ------------------------------------------------------------------------ measured

    def _measured_parts(self) -> list[Any]:
        """Widgets for rows of measured points."""
        self._rows = TextAreaInput(title="Rows", rows=4, stylesheets=self._styles, name="rows",
                                   max_length=MOST_BYTES, sizing_mode="stretch_width")  # fmt: skip
        self._rows.on_change("value", lambda _a, _o, _n: self._read_rows())
        self._of_file: Measured | None = None
        self._rows_said = self._div("rows_said")
        remove = self._button("Remove", self._remove_points, "remove")
        return [Column(self._rows, self._rows_said, remove, sizing_mode="stretch_width",
                       name="measured")]  # fmt: skip

    def _read_rows(self) -> None:
        """Show the measured points of the rows, or of a file."""
        found = self._of_file
        if found is None and self._span is not None:
            key = self._span_key()
            self._rows.title = f"Rows: {key.label}, e, and a bar if you like"
            found = measured.rows(self._rows.value, self._span.address, key)
        elif found is not None and self._span is not None and self._span.address not in found.at:
            found = Measured(faults=[*found.faults, f"found no column of {self._span.address}, "
                                     "against which the curve is drawn"])  # fmt: skip
        if found is None:
            return
        lines = "".join(f"<li>{html.escape(line)}</li>" for line in found.faults)
        self._put(self._rows_said, f"<ul>{lines}</ul>" if lines else "")
        self._figures.show_points(found)

    def _remove_points(self) -> None:
        """Remove the measured points."""
        self._of_file = None
        self._rows.value = ""
        self._read_rows()

    # --------------------------------------------------------------------------- files

    def _file_parts(self) -> list[Any]:
        """Widgets that take a file."""
        self._upload = ColumnDataSource(data={"name": [], "content": [], "size": []}, name="upload")
        self._upload.on_change("data", self._uploaded)
        self._body = RadioButtonGroup(
            labels=[f"for the {one}" for one in _BODIES.values()], active=0,
            stylesheets=self._styles, name="body",
        )  # fmt: skip
        self._file_said = self._div("file_said")
        # a source is no root that can be shown
        holder = Div(text="", visible=False, name="holder")
        holder.tags = [self._upload]
        return [Column(self._body, self._file_said, holder, sizing_mode="stretch_width",
                       name="files")]  # fmt: skip

    def _say_file(self, text: str, *, is_fault: bool = False) -> None:
        """Say what became of a file."""
        self._put(self._file_said, text)
        self._file_said.css_classes = ["fault"] if is_fault else []

    def _uploaded(self, _attr: str, _old: Any, new: dict[str, Sequence[Any]]) -> None:
        """Take a file that was dropped: materials, a case, moduli, or measured impacts."""
        if not len(new["name"]):
            return
        name = re.sub(r"[^\w .+-]+", "_", str(new["name"][0]).replace("\\", "/").split("/")[-1])
        name = name.lstrip(".")[-80:] or "file"
        if float(new["size"][0]) > MOST_BYTES:
            line = f"{name}: found {new['size'][0]:.0f} bytes, expected at most 4 MB"
            self._say_file(html.escape(line), is_fault=True)
            return
        try:
            content = base64.b64decode(str(new["content"][0]), validate=True)
        except ValueError:
            content = b""
        if len(content) > MOST_BYTES:
            return
        path = Path(self._folder.name) / name
        path.write_bytes(content)
        try:
            if name.endswith(".nml"):
                self._take_groups(path, name)
            else:
                self._take_data(path, name)
        except Error as error:
            self._refuse(error)

    def _refuse(self, error: Error) -> None:
        """Say why a file is refused."""
        line = str(error).replace(f"{self._folder.name}/", "")
        self._say_file(html.escape(line), is_fault=True)

    def _take_groups(self, path: Path, name: str) -> None:
        """Take a file of &material groups, or a whole case."""
        text = path.read_text(encoding="utf-8", errors="replace")
        case = Case(text, name=name)
        _, names, has_impact = material_case(path)
        owners = [*map(path_of, names), "target"]
        for owner in owners:
            for key in groups()["target" if owner == "target" else "material"].keys:
                if key.is_file and case[f"{owner}.{key.name}"] is not None:
                    raise InputError(f"{name}: found '{key.name}' of {owner}, expected numbers: a "
                                     "page reads no files of the machine")  # fmt: skip
        if has_impact:
            case.text()
            if case._axes():
                raise InputError(f"{name}: found a &sweep group, expected a single impact")
            self._files = []
            self.form.take(case)
            self._say_file(html.escape(f"{name}: the page has this case now"))
            return
        body = list(_BODIES)[self._body.active or 0]
        for one in names[1:]:
            if one in self.form.names(self.case):
                del self.case[path_of(one)]
        self.form.add_material(case, names[0], body)
        self._say_file(html.escape(f"{name}: '{names[0]}' is the material of the {_BODIES[body]}"))

    def _take_data(self, path: Path, name: str) -> None:
        """Take moduli, to which a material is fitted, or measured impacts."""
        from ..materials.data import read_data

        case = self.case

        def unit_of(address: str) -> str:
            """Unit of a key of the case."""
            return case._describe(address).unit

        try:
            data = read_data(path, unit_of=unit_of)
        except Error as error:
            # rows without names of columns are those of the text field
            text = path.read_text(encoding="utf-8", errors="replace")
            found = (
                measured.rows(text, self._span.address, self._span_key()) if self._span else None
            )
            if found is None or not found.e.size:
                raise error
            self._of_file = None
            self._rows.value = text
            self._say_file(html.escape(f"{name}: {found.e.size} measured points"))
            return
        if data.attrs["kind"] in ("dynamic", "relaxation"):
            self._fit(data, Path(name).stem, name)
            return
        self._of_file = measured.of_file(path, case)
        self._of_file.faults = [one.replace(f"{self._folder.name}/", "")
                                for one in self._of_file.faults]  # fmt: skip
        self._say_file(html.escape(f"{name}: {self._of_file.e.size} measured points"))
        self._read_rows()

    def _fit(self, data: Any, name: str, file: str) -> None:
        """Fit a material to moduli in a thread, and take it."""
        from ..materials.fit import fit

        if self._is_busy:
            self._say_file("A fit is on its way; drop the file again afterwards.", is_fault=True)
            return
        self._is_busy = True
        self._say_file(html.escape(f"{file}: a material is fitted to these moduli ..."))
        body = list(_BODIES)[self._body.active or 0]

        def work() -> None:
            """Fit; an error is handed over in place of the fit."""
            made: Any
            try:
                made = fit(data, name=name)
            except Error as error:
                made = error
            except Exception:
                _log.exception("vcor page")
                made = Error(f"{file}: a fault of the page; the terminal of vcor page says which")
            self._later(done, made)

        def done(made: Any) -> None:
            """Take the fit, or say why there is none."""
            self._is_busy = False
            if isinstance(made, Error):
                self._refuse(made)
                return
            self._take_fit(made, name, file, body)

        threading.Thread(target=work, daemon=True).start()

    def _take_fit(self, made: Any, name: str, file: str, body: str) -> None:
        """Give a body the fitted material, with the density of the one before; show the data."""
        from ..materials.fit_command import remarks

        group = Case(made.group, name=file)
        old = self.case[f"{body}.material"]
        density = self.case[f"{path_of(str(old))}.density"] if old else None
        if density is not None:
            # that of the material before: moduli do not say it
            group[f"{path_of(name)}.density"] = float(density)  # type: ignore[arg-type]
        self.form.add_material(group, name, body)
        notes = remarks(made, file).splitlines()
        notes = [html.escape(line.removeprefix("! ")) for line in notes]
        if density is not None:
            notes.append(f"density {density:g} kg/m3, that of the material before: the moduli do "
                         "not say it")  # fmt: skip
        self._say_file(f"<ul>{''.join(f'<li>{line}</li>' for line in notes)}</ul>")
        samples = made.samples
        if samples.dynamic:
            frequency = list(samples.at) * 2 if len(samples.moduli) > 1 else list(samples.at)
            turn = 2 * math.pi
            self._figures.show_data([one / turn for one in frequency],
                                    [float(v) for row in samples.moduli for v in row])  # fmt: skip

    # ----------------------------------------------------------------------- take away

    def _take_parts(self) -> list[Any]:
        """Widgets to take away case, table, figure and commands."""
        self._download = ColumnDataSource(data={"name": [], "text": [], "type": []})
        self._download.js_on_change("data", CustomJS(code=_SAVE))
        self._figure = Select(
            options=list(take_away.FIGURES.items()), value="curve", title="Figure",
            stylesheets=self._styles, name="figure_kind", width=170,
        )  # fmt: skip
        self._take_said = self._div("take_said")
        self._lines = self._div("lines")
        row = Row(
            self._button("Case (.nml)", self._take_case, "take_case"),
            self._button("Table (CSV)", self._take_table, "take_table"),
            self._figure, self._button("Figure (SVG)", self._take_figure, "take_figure"),
            styles={"flex-wrap": "wrap", "align-items": "end", "gap": "0.3rem"},
        )  # fmt: skip
        holder = Div(text="", visible=False)
        holder.tags = [self._download]
        return [Column(row, self._take_said, self._lines, holder, sizing_mode="stretch_width",
                       name="take")]  # fmt: skip

    def _give(self, name: str, kind: str, make: Callable[[], str]) -> None:
        """Make a text in a thread and give it to the browser as a file."""
        self._put(self._take_said, "")
        stem = take_away.name_of(self.case)

        def work() -> None:
            """Make the text; a fault is handed over in its place."""
            try:
                text, fault = make(), ""
            except Error as error:
                text, fault = "", str(error).replace(f"{self._folder.name}/", "")
            except Exception:
                _log.exception("vcor page")
                text, fault = "", "a fault of the page; the terminal of vcor page says which"
            self._later(done, text, fault)

        def done(text: str, fault: str) -> None:
            """Send the text to the browser, or say why there is none."""
            if fault:
                self._put(self._take_said, f'<p class="fault">{html.escape(fault)}</p>')
                return
            self._download.data = {"name": [f"{stem}{name}"], "text": [text], "type": [kind]}

        threading.Thread(target=work, daemon=True).start()

    def _take_case(self) -> None:
        """Give the case as a file."""
        case, folder = self.case.copy(), Path(self._folder.name)
        self._give(".nml", "text/plain", lambda: take_away.case_text(case, folder))

    def _take_table(self) -> None:
        """Give the summary over the range of the axis as CSV."""
        case, span, folder = self.case.copy(), self._span, Path(self._folder.name)
        self._give("_summary.csv", "text/csv", lambda: take_away.table(case, span, folder))

    def _take_figure(self) -> None:
        """Give the chosen figure, with all kept curves, as SVG."""
        kind, span = str(self._figure.value), self._span
        cases = [self.case.copy(), *[one.copy() for one, _ in self._kept]]
        labels = self._labels() if self._kept else []
        self._give(f"_{kind}.svg", "image/svg+xml",
                   lambda: take_away.svg(kind, cases, labels, span))  # fmt: skip

    def _show_lines(self) -> None:
        """Show the commands that make the same bits, and what distinguishes the kept curves."""
        self._show_kept()
        try:
            shell, python = take_away.commands(self.case, self._files, Path(self._folder.name))
        except Error:
            return
        self._put(
            self._lines,
            (
                "<details><summary>The same bits in the shell and in Python</summary>"
                f'<h3>In the shell</h3><pre class="shell">{html.escape(shell)}</pre>'
                f'<h3>In Python</h3><pre class="python">{html.escape(python)}</pre></details>'
            ),
        )

    # ------------------------------------------------------------------------- colours

    def set_dark(self, is_dark: bool) -> None:
        """Give the figures the colours of a light or a dark page."""
        if is_dark != self._figures.is_dark:
            self._figures.is_dark = is_dark
            self._figures.paint()
            self._show_kept()


#: Saves a text of the page as a file of the browser
_SAVE = """
const {name: [name], text: [text], type: [type]} = cb_obj.data
if (name === undefined) return
const link = document.createElement("a")
link.href = URL.createObjectURL(new Blob([text], {type}))
link.download = name
link.click()
setTimeout(() => URL.revokeObjectURL(link.href), 1000)
"""


def _addresses(case: Case) -> Iterator[str]:
    """Addresses of the numbers of a case, those of its materials last."""
    for group in groups().values():
        if group.repeated or group.name in ("output", "case"):
            continue
        model = case[f"{group.name}.{group.selector}"] if group.selector else None
        if group.selector and model is None:
            continue
        for key in group.keys_of(None if model is None else str(model)):
            if key.type == "real":
                yield f"{group.name}.{key.name}"
    for name in materials_of(case):
        owner = path_of(name)
        for key in groups()["material"].keys_of(str(case[f"{owner}.model"])):
            if key.type == "real":
                yield f"{owner}.{key.name}"


def _answer_text(answer: Answer) -> str:
    """The answer in large: e, rebound height, verdict."""
    numbers = answer.numbers
    assert numbers is not None
    e = float(numbers["cor_sphere"])
    level, words = sentence(numbers)
    shown = f"e = {e:.{_DIGITS}f}" if math.isfinite(e) else "e = –"
    rebound = ""
    if math.isfinite(e) and answer.drop > 0:
        rebound = f"Rebound height {height(e**2 * answer.drop)} of {height(answer.drop)}"
    name = f"<strong>{level.capitalize()}.</strong> " * bool(level)
    lines = "".join(f"<li>{html.escape(line)}</li>" for line in answer.remarks)
    return (
        '<p class="name">Coefficient of restitution of the sphere</p>'
        f'<p class="e"><output>{shown}</output></p><p class="height">{rebound}</p>'
        f'<p class="verdict {level}">{name}{html.escape(words)}</p><ul>{lines}</ul>'
    )


def _no_answer(line: str) -> str:
    """The answer where there is none, and why."""
    words = f'<p class="verdict outside">{html.escape(line)}</p>'
    return (
        '<p class="name">Coefficient of restitution of the sphere</p>'
        f'<p class="e"><output>e = –</output></p>{words}'
    )


def _table(answer: Answer) -> str:
    """All numbers of the impact, as the program writes them."""
    assert answer.numbers is not None
    rows = []
    for name, column in _library.columns(0).items():
        value = answer.numbers[name]
        shown = repr(value) if isinstance(value, float) else str(value)
        unit = "" if column.unit == "1" else column.unit
        rows.append(f'<tr><th scope="row">{html.escape(column.meaning)} <code>{name}</code></th>'
                    f'<td id="{name}">{shown}</td><td>{html.escape(unit)}</td></tr>')  # fmt: skip
    return f"<details><summary>All numbers</summary><table>{''.join(rows)}</table></details>"
