"""What the command-line programs share: errors in one line, files whole or not at all."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from pirouette.errors import NOT_BUILT, Error
from pirouette.run_folder import RunError

DONE, BAD_USAGE, INTERRUPTED = 0, 2, 130  # exit codes, as those of the C++ program


def run(body: Callable[[], None]) -> int:
    """Exit code of `body`; what it raises about its input becomes a line on stderr for each
    thing that is wrong."""
    try:
        body()
    except Error as error:
        lines = [str(error)] if isinstance(error, RunError) else str(error).splitlines()
        for line in lines:
            print(f"error: {' '.join(line.split())}", file=sys.stderr)
        return BAD_USAGE
    except ImportError as error:
        missing = f"{error}; `make setup` or `pip install .` installs it"
        built = error.name != "pirouette._core"
        print(f"error: {missing if built else NOT_BUILT}", file=sys.stderr)
        return BAD_USAGE
    except OSError as error:
        print(f"error: {error.filename or 'file'}: {error.strerror}", file=sys.stderr)
        return BAD_USAGE
    except KeyboardInterrupt:
        return INTERRUPTED
    return DONE


@contextmanager
def whole_file(out: Path) -> Iterator[Path]:
    """A path beside `out` to write to; it becomes `out` at the end, and vanishes after an error."""
    if not out.parent.is_dir():
        raise RunError(f"{out}: cannot be written, there is no folder {out.parent}")
    part = out.with_name(f".{out.stem}.part-{os.getpid()}{out.suffix}")
    try:
        yield part
        part.replace(out)
    finally:
        part.unlink(missing_ok=True)
