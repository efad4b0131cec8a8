"""A thread that computes what a page asks for last, and leaves what nobody waits for any more."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import TypeVar

T = TypeVar("T")
#: Time between parts of an answer that are handed over [s]: what comes sooner is shown at once
_APART = 0.1


class Worker:
    """A thread for the answers of one page; the last question replaces all others."""

    def __init__(self) -> None:
        """Begin the thread; it waits."""
        self._changed = threading.Condition()
        self._next: Callable[[], None] | None = None
        self._is_over = False
        self._number = 0
        threading.Thread(target=self._work, name="vcor page", daemon=True).start()

    def ask(self, parts: Callable[[], Iterator[T]], give: Callable[[T], None]) -> None:
        """Compute parts, each with all that is known, and hand them over from the thread."""
        with self._changed:
            self._number += 1
            number = self._number
            self._next = lambda: self._answer(number, parts, give)
            self._changed.notify()

    def _answer(
        self, number: int, parts: Callable[[], Iterator[T]], give: Callable[[T], None]
    ) -> None:
        """Hand over parts, at most one each _APART [s], until another question is asked."""
        last, begin = None, time.monotonic()
        for part in parts():
            if number != self._number:
                return
            last = part
            if time.monotonic() - begin > _APART:
                give(part)
                last, begin = None, time.monotonic()
        if last is not None:
            give(last)

    def end(self) -> None:
        """End the thread after what it is at."""
        with self._changed:
            self._is_over = True
            self._number += 1
            self._changed.notify()

    def _work(self) -> None:
        """Answer the last question, again and again, until the end."""
        while True:
            with self._changed:
                while self._next is None and not self._is_over:
                    self._changed.wait()
                if self._is_over:
                    return
                job, self._next = self._next, None
            assert job is not None
            job()
