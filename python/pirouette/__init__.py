"""Reports, exports and pictures of the runs that the program `pirouette` writes."""

__version__ = "0.1.0"
