"""The command ``ringlet``: its commands and its errors.

Exit codes: 0 success, 1 what was checked does not hold, 2 bad input, 3 a mistake in Ringlet itself, 130 interrupted.
"""

from __future__ import annotations

import os
import sys
import tempfile
import traceback
import warnings
from collections.abc import Sequence
from importlib import import_module
from io import TextIOWrapper
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

import ringlet

# In the order of the help. Each is the function of the same name in the file of the same name.
COMMANDS = [
    "demo",
    "groom",
    "edit",
    "check",
    "loft",
    "motion",
    "sim",
    "converge",
    "wedge",
    "farm",
    "hair",
    "convert",
    "adopt",
    "upgrade",
    "render",
    "movie",
    "turntable",
    "view",
    "share",
    "serve",
    "validate",
    "schema",
    "doctor",
    "bench",
]
FORMER_COMMANDS = {"picture": "render"}
CONTEXT = {"bench": {"allow_extra_args": True, "ignore_unknown_options": True}}  # a benchmark takes what it likes
INTERRUPTED = 130  # what typer makes of a KeyboardInterrupt


class Front(TyperGroup):
    """Prints every error in one line, without a traceback unless one was asked for."""

    def main(self, args: Sequence[str] | None = None, *rest: Any, standalone_mode: bool = True, **extra: Any) -> Any:
        """Runs a command line and exits with its code."""
        try:
            with warnings.catch_warnings(), ringlet.recorded():  # no command replaces a file that it reads
                if not os.environ.get("RINGLET_DEBUG"):
                    warnings.simplefilter("ignore")  # those of libraries are for programmers
                show_former_names()
                code = super().main(args, *rest, standalone_mode=False, **extra) or 0
            if code == INTERRUPTED:
                fail("interrupted", code)
        except typer.TyperException as error:
            code = fail(f"{reason(error)}  (ringlet --help tells more)", error.exit_code)
        except BrokenPipeError:  # the reader of our output has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            code = 1
        except typer.Abort:
            code = fail("interrupted", INTERRUPTED)
        except Exception as error:
            line = ringlet.line_of(error)
            code = fail(bug(), 3) if line is None else fail(line, 2)
        sys.exit(code)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of a name; a former name is read too."""
        if (name := FORMER_COMMANDS.get(cmd_name, cmd_name)) != cmd_name:
            print(f"note: ringlet {cmd_name} is now ringlet {name}", file=sys.stderr)
        return super().get_command(ctx, name)


def reason(error: typer.TyperException) -> str:
    """What is wrong with a command line; of a value that a bound or a type refuses, in our own words."""
    option = getattr(getattr(error, "param", None), "opts", None)
    cause: Any = error.__cause__
    if option and hasattr(cause, "errors"):
        return str(ringlet.explain(cause, option[0]))
    return error.format_message()


def show_former_names() -> None:
    """Prints each note on former names of settings once, until the warnings are caught no more."""
    shown, others = set[str](), warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *rest: Any) -> None:
        if not issubclass(category, ringlet.FormerNames):
            others(message, category, *rest)
        elif str(message) not in shown:
            shown.add(str(message))
            print("note:", message, file=sys.stderr)

    warnings.filterwarnings("always", category=ringlet.FormerNames)
    warnings.showwarning = show


def fail(message: str, code: int) -> int:
    """Prints a message as one line and gives the exit code back."""
    print("error:", " ".join(message.split()), file=sys.stderr)
    return code


def bug() -> str:
    """The message for an unexpected exception, whose traceback is written to a file or printed."""
    if os.environ.get("RINGLET_DEBUG"):
        traceback.print_exc()
        where = "above"
    else:
        with tempfile.NamedTemporaryFile("w", prefix="ringlet-", suffix=".txt", delete=False) as file:
            traceback.print_exc(file=file)
        where = f"in {file.name}"
    kind, value, _ = sys.exc_info()
    name = kind.__name__ if kind else ""
    return f"this is a mistake in Ringlet ({name}: {value}); the traceback is {where}, please report it"


app = typer.Typer(
    name="ringlet",
    cls=Front,
    help="Grooms tightly curled hair and simulates it.",
    epilog="Start with: [bold]ringlet demo[/bold]",
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def show_version(asked: bool) -> None:
    """Prints the version and ends."""
    if asked:
        print(f"ringlet {ringlet.__version__}")
        raise typer.Exit


def show_tracebacks(asked: bool) -> None:
    """Lets mistakes in Ringlet show where they happened."""
    if asked:
        os.environ["RINGLET_DEBUG"] = "1"


@app.callback(invoke_without_command=True)
def front(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=show_version, is_eager=True, help="Print the version.")
    ] = False,
    debug: Annotated[
        bool, typer.Option("--debug", callback=show_tracebacks, help="Show the traceback of a bug in Ringlet.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        print(context.get_help())


for name in COMMANDS:
    app.command(name, context_settings=CONTEXT.get(name))(getattr(import_module(f"ringlet.cli.{name}"), name))


def main() -> None:
    """Entry point of the command ``ringlet``."""
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # names of files may be no text
    bound_memory()
    app()


def bound_memory() -> None:
    """Lets allocations beyond the machine's memory fail and be reported; Linux would end the process without a word."""
    if sys.platform != "linux":
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    least = min([memory, *(limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY)])
    resource.setrlimit(resource.RLIMIT_DATA, (least, hard))
