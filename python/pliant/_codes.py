"""Exit codes of the module's commands."""
import sys

from pliant._core import Error


def exit_code(work):
    """What `work` returns, or 0; an error is printed, and gives 4 where a run diverged and 2 otherwise."""
    try:
        return work() or 0
    except Error as error:
        print(f"pliant: {error}", file=sys.stderr)
        return 4 if error.code == 4 else 2
    except (ImportError, OSError) as error:
        print(f"pliant: {error}", file=sys.stderr)
        return 2
