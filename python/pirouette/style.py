"""Colours and line styles that every figure shares."""

# Okabe and Ito: told apart with any colour vision, and on a light or dark page. Dashes, symbols and
# patterns say the same again.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")
SYMBOLS = ("circle", "square", "diamond", "triangle-up", "x", "cross")
PATTERNS = ("", "/", "x", "\\", ".", "+")
NEUTRAL = "#8c8c8c"  # for references: readable on a light and on a dark page


def colour(i: int) -> str:
    return COLOURS[i % len(COLOURS)]


def dash(i: int) -> str:
    return DASHES[i % len(DASHES)]


def rgb(i: int) -> tuple[int, int, int]:
    """The same colour as three bytes."""
    text = colour(i)
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)
