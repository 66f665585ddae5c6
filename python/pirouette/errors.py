"""The one exception of the package, and what to do without its compiled part."""


class Error(ValueError):
    """What was given cannot be used: names file, key, value and what is allowed; a line for each
    thing that is wrong."""


NOT_BUILT = (
    "pirouette's compiled library is missing: run `make python` in the source tree, or "
    "`pip install .`"
)
