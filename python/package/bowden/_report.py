"""The result of a call: fields of the JSON, figures, models and trace."""

from __future__ import annotations

import html
import json
import os
from base64 import b64encode
from typing import TYPE_CHECKING, Any, Optional

from . import _bowden
from ._error import Error
from ._fields import Fields
from ._model import Model

if TYPE_CHECKING:
    from . import _parts as parts

_COLOURS = {
    "explained": "good",
    "holds": "good",
    "no-input-dependence": "bad",
    "not-transferable": "bad",
    "does-not-hold": "bad",
    "defective-record": "bad",
}
_HEX = {"good": "#15803d", "mid": "#a16207", "bad": "#b91c1c"}


class _Found(Fields):
    """Base class of both reports."""

    __slots__ = ("_json", "_native", "_command")

    def __init__(self, text: str, native: Any, command: str) -> None:
        super().__init__(json.loads(text))
        self._json = text
        self._native = native
        self._command = command

    @property
    def json(self) -> str:
        """The same bytes as the ``--json`` output of the program for this record."""
        return self._json

    def _drawn(self) -> Any:
        if self._native is None:
            raise Error("nothing is kept to draw: the report came from another process")
        return self._native

    def trace(self, frame: Optional[str] = None) -> Any:
        """The signals over time, as the fit uses them.

        ``frame`` is ``"pandas"``, ``"polars"`` or ``"dict"`` (of arrays); default: the first one
        that is installed.
        """
        columns: dict[str, Any] = dict(self._drawn().trace())
        if frame in (None, "pandas"):
            try:
                import pandas  # type: ignore[import-untyped,unused-ignore]
            except ImportError:
                if frame:
                    raise
            else:
                return pandas.DataFrame(columns)
        if frame in (None, "polars"):
            try:
                import polars
            except ImportError:
                if frame:
                    raise
            else:
                return polars.DataFrame(columns)
        if frame not in (None, "dict"):
            raise Error(f'frame={frame!r}: "pandas", "polars" or "dict" is allowed')
        return columns

    @property
    def trace_csv(self) -> str:
        """The trace as CSV, as the program writes it with ``--trace``."""
        text: str = self._drawn().trace_csv
        return text

    def figure(self, name: str = "loop") -> str:
        """One figure as SVG: ``loop``, ``residual``, ``trace`` or ``shares``."""
        svg: str = self._drawn().figure(name)
        return svg

    def page(self) -> str:
        """The whole report as one self-contained HTML page.

        The SHA-256 of each file is that of the data that was read.
        """
        page: str = self._drawn().page(self._command)
        return page

    def save_page(self, path: "str | os.PathLike[str]") -> None:
        """Writes :meth:`page` to a file."""
        text = self.page()
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(text)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self['verdict']}: {self['summary']}>"

    def _numbers(self) -> str:
        return ""

    def _repr_html_(self) -> str:
        """The verdict, the errors, two figures and the folded page."""
        verdict = str(self["verdict"])
        colour = _HEX[_COLOURS.get(verdict, "mid")]
        head = (
            f'<div style="font-family:system-ui,sans-serif;max-width:960px">'
            f'<p style="font-size:1.1em;margin:0 0 .4em">{html.escape(str(self["summary"]))}</p>'
            f'<p style="margin:0 0 .6em"><span style="background:{colour};color:#fff;'
            f'border-radius:4px;padding:2px 8px;font-size:.85em">{html.escape(verdict)}</span>'
            f"{self._numbers()}</p>"
        )
        try:
            figures = "".join(_image(name, self.figure(name)) for name in ("loop", "residual"))
            page = html.escape(self.page(), quote=True)
        except (Error, OSError):
            return head + "</div>"
        return (
            f"{head}{figures}<details><summary>The whole report</summary>"
            f'<iframe srcdoc="{page}" sandbox="" loading="lazy" title="bowden: the whole report" '
            f'style="width:100%;height:720px;border:1px solid #dfe3e8"></iframe></details></div>'
        )

    def __getstate__(self) -> Any:
        return self._all, self._json, self._command

    def __setstate__(self, state: Any) -> None:
        self._all, self._json, self._command = state
        self._native = None


class Report(_Found):
    """The result of :func:`bowden.identify`, with the fields of schema ``bowden.identify/1``.

    Each key of the JSON is an attribute (``report.final.nrmse.held_out``). :attr:`json` is the text
    itself.
    """

    __slots__ = ("_models", "_no_model", "_vectors")

    if TYPE_CHECKING:
        schema: str
        record: parts.RecordPart
        records: list[parts.RecordPart]
        baseline: parts.ModelPart
        lacks: list[parts.Lack]
        files_alone: list[parts.FileAlone]
        complete: parts.Complete
        terms: list[parts.Term]
        undelivered: list[parts.Term]
        final: parts.FinalPart
        rejected: list[parts.Rejected]
        defects: list[parts.Defect]
        notes: list[str]
        redundant: list[parts.Fields]
        unknown: Optional[parts.Fields]
        noise_floor: float
        output_std: parts.Segments
        explains: parts.Fields
        held_out_floor: float
        stopped_by_max_terms: Optional[int]
        stopped_by_time_limit: Optional[float]
        verdict: str
        findings: list[parts.Finding]
        summary: str
        cost: parts.Cost

    def __init__(self, closed: _bowden.Closed, command: str, kept: bool) -> None:
        super().__init__(closed.json, closed, command)
        self._no_model = closed.no_model if kept else "figures=False: no model was kept"
        self._models = [Model(closed.model(k).decode()) for k in range(closed.models)]
        self._vectors = [closed.vector(k) for k in range(closed.models)]

    @property
    def model(self) -> Model:
        """The model for firmware; with ``per_file="gains"``, the model of the first file."""
        if not self._models:
            raise Error(f"no model can be exported: {self._no_model}")
        return self._models[0]

    @property
    def models(self) -> list[Model]:
        """The models for firmware: one, or one for each file with ``per_file="gains"``."""
        return list(self._models)

    @property
    def vectors(self) -> list[str]:
        """The test vector of each model as CSV, as ``--model-out`` of the program writes it."""
        return list(self._vectors)

    @property
    def names(self) -> list[str]:
        """The effects that were added to the baseline model, in the order of their discovery."""
        return [str(found.effect) for found in self.terms]

    def _numbers(self) -> str:
        before, after = (100.0 * part.nrmse.held_out for part in (self.baseline, self.final))
        found = ", ".join(html.escape(name) for name in self.names) or "nothing"
        return (
            f" &nbsp;held-out error {before:.2f} % → <b>{after:.2f} %</b> of the output's "
            f"standard deviation; found: {found}"
        )

    def __getstate__(self) -> Any:
        return super().__getstate__(), self._models, self._no_model, self._vectors

    def __setstate__(self, state: Any) -> None:
        found, self._models, self._no_model, self._vectors = state
        super().__setstate__(found)


class CheckReport(_Found):
    """The result of :func:`bowden.validate`, with the fields of ``bowden.validate/1``."""

    __slots__ = ()

    if TYPE_CHECKING:
        schema: str
        model: str
        record: parts.CheckedRecord
        rmse: float
        nrmse: float
        rmse_gain_offset: float
        nrmse_gain_offset: float
        gain: parts.Fitted
        offset: parts.Fitted
        trained_on: parts.Fields
        threshold_nrmse: Optional[float]
        noise_floor: float
        outside: list[parts.Fields]
        depends_on: list[parts.Fields]
        defects: list[parts.Defect]
        notes: list[str]
        verdict: str
        findings: list[parts.Finding]
        summary: str

    def __init__(self, checked: _bowden.Checked, command: str) -> None:
        super().__init__(checked.json, checked, command)

    def _numbers(self) -> str:
        return f" &nbsp;error {100.0 * self.nrmse:.2f} % of the output's standard deviation"


def _image(name: str, svg: str) -> str:
    data = b64encode(svg.encode()).decode()
    return (
        f'<img alt="{name}: measured, baseline and final model" '
        f'src="data:image/svg+xml;base64,{data}" style="max-width:100%;display:block;margin:.4em 0">'
    )
