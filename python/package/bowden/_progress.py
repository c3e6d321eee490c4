"""Progress of a long call: a tqdm bar, or a function of the caller."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from typing import Any, Callable, Optional

#: Called with the completed fraction (0 to 1, ``None`` if unknown) and the current task.
Told = Callable[[Optional[float], str], object]


class _Bar:
    """A tqdm bar or a similar one, moved to a fraction of its total."""

    def __init__(self, bar: Any, own: bool) -> None:
        self.bar, self.own = bar, own
        if not getattr(bar, "total", None):
            bar.total = 1.0

    def __call__(self, share: Optional[float], message: str) -> None:
        if hasattr(self.bar, "set_postfix_str"):
            self.bar.set_postfix_str(message, refresh=False)
        self._move(share)

    def _move(self, share: Optional[float]) -> None:
        at = self.bar.n if share is None else share * self.bar.total
        if hasattr(self.bar, "refresh"):
            # One drawing a step; never backwards.
            self.bar.n = max(self.bar.n, at)
            self.bar.refresh()
        elif at > self.bar.n:
            self.bar.update(at - self.bar.n)

    def done(self) -> None:
        self._move(1.0)

    def close(self) -> None:
        if self.own:
            self.bar.close()


class Progress:
    """The meaning of ``progress=``, for the duration of one call."""

    def __init__(self, wanted: Any) -> None:
        self.bar: Optional[_Bar] = None
        self.told: Optional[Told] = None
        if wanted is None or wanted is False:
            return
        if wanted is True:
            self.told = self.bar = _own_bar()
            self.told = self.told or _line
        elif hasattr(wanted, "update") and hasattr(wanted, "n"):
            self.told = self.bar = _Bar(wanted, own=False)
        elif callable(wanted):
            self.told = wanted
        else:
            raise TypeError(
                f"progress: {type(wanted).__name__}; True, a bar of tqdm or a function is allowed"
            )

    def __enter__(self) -> Optional[Told]:
        return self.told

    def __exit__(self, kind: object, *rest: object) -> None:
        if self.bar is not None:
            if kind is None:
                self.bar.done()
            self.bar.close()


def _own_bar() -> Optional[_Bar]:
    try:
        # Without ipywidgets `tqdm.auto` warns in a notebook and draws text all the same.
        where = "tqdm.auto" if importlib.util.find_spec("ipywidgets") else "tqdm"
        tqdm = importlib.import_module(where).tqdm
    except ImportError:
        return None
    form = "{percentage:3.0f} % |{bar:24}| {elapsed} {postfix}"
    return _Bar(tqdm(total=1.0, leave=False, bar_format=form), own=True)


def _line(share: Optional[float], message: str) -> None:
    print(f"bowden: {message}", file=sys.stderr)
