"""A page for the browser: live, or as one file with a sweep made beforehand.

`live` serves one from this process, as `vcor page` and `case.page()` do; `make` makes a file that
needs neither Python nor a network: it looks up and interpolates what the library has computed.
"""

from .document import Page, make
from .server import Live, live

__all__ = ["Live", "Page", "live", "make"]
