# SPDX-License-Identifier: Apache-2.0
"""Command lines that look and fail like clrt's: --help in the layout of src/app/help_text.cpp, one line for an error."""
import argparse
import difflib
import re
import shutil
import sys
import textwrap

from clrt_tools.version import version

TEXT_COLUMN, EXIT_TEXT_COLUMN = 31, 7
NARROW, WIDE = 60, 100  # columns of the page where the terminal is outside
USAGE_ERROR = 2


class CommandLine(argparse.ArgumentParser):
    """A parser of one program. `examples`: lines of the shell; `exit_codes`: (number, meaning)."""

    def __init__(self, prog, purpose, examples, exit_codes):
        super().__init__(prog=prog, allow_abbrev=False, add_help=False)
        self.purpose, self.examples, self.exit_codes = purpose, examples, exit_codes

    def add_help_and_version(self):
        """The last two options of every program."""
        self.add_argument("-h", "--help", action="help", help="print this page and exit")
        self.add_argument("--version", action="version", version=f"{self.prog} {version()}", help="print the version and exit")

    def format_help(self):
        columns = min(max(shutil.get_terminal_size().columns - 1, NARROW), WIDE)
        names = " ".join(action.metavar for action in self._actions if not action.option_strings)
        parts = [f"Usage: {self.prog} [options] {names}", _entry("", self.purpose, 0, columns),
                 "\n".join(["Example:", *("  " + line for line in self.examples)])]
        for title, chosen in (("Arguments", False), ("Options", True)):
            entries = [_entry(_name(action), self._text(action), TEXT_COLUMN, columns)
                       for action in self._actions if bool(action.option_strings) == chosen]
            parts.append("\n".join([f"{title}:", *entries]))
        codes = [_entry(f"  {code}", meaning, EXIT_TEXT_COLUMN, columns) for code, meaning in self.exit_codes]
        return "\n\n".join(parts + ["\n".join(["Exit codes:", *codes])]) + "\n"

    @staticmethod
    def _text(action):
        return (action.help or "").replace("%%", "%")

    def parse_args(self, args=None, namespace=None):
        """Names an unknown option before anything that may be missing because of it."""
        names = [name for action in self._actions for name in action.option_strings]
        for word in sys.argv[1:] if args is None else args:
            option = word.split("=")[0] if word.startswith("--") else word[:2]
            if re.match("--?[a-z]", option) and option not in names:
                nearest = difflib.get_close_matches(option, names, 1, 0.5) if option.startswith("--") else []
                self.error(f"unknown option {option};" + (f" the nearest is {nearest[0]}, and" if nearest else "") +
                           f" `{self.prog} --help` lists all")
        return super().parse_args(args, namespace)

    def error(self, message):
        message = re.sub(r"^argument (-\w/)?", "option ", message)
        message = message.replace("the following arguments are required:", "expected") + (
            f", found none; `{self.prog} --help` tells more" if "are required" in message else "")
        print(f"{self.prog}: error: {message}", file=sys.stderr)
        sys.exit(USAGE_ERROR)


def _name(action):
    """`  -o, --output FILE`; a long name alone stands under the long names."""
    names = ", ".join(action.option_strings) or action.metavar
    value = "" if action.nargs == 0 or not action.option_strings else " " + _value(action)
    return ("  " if not names.startswith("--") else "      ") + names + value


def _value(action):
    value = action.metavar or "|".join(action.choices)
    return value + ("..." if action.nargs == "+" else "")


def _entry(name, text, indent, columns):
    """`name` and behind it the text, wrapped from column `indent` to column `columns`."""
    lines = textwrap.wrap(text, columns - indent, break_on_hyphens=False, break_long_words=False) or [""]
    if len(name) + 2 > indent and name:  # two blanks tell a name from its text
        return "\n".join([name] + [" " * indent + line for line in lines])
    return "\n".join([name.ljust(indent) + lines[0]] + [" " * indent + line for line in lines[1:]])
