"""Where the documents are, and how long a command may take."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
# Seconds after which a command counts as one that does not end
LIMIT = 1000
