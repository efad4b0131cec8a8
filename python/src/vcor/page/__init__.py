"""A page for the browser: one file with sliders, from a sweep made beforehand.

`make` makes it, `vcor page` writes it. The page needs neither Python nor a network: it looks up
and interpolates what the library has computed.
"""

from .document import Page, make

__all__ = ["Page", "make"]
