# SPDX-License-Identifier: Apache-2.0
"""The switches of clrt that a study compares, and the methods that they make. A new switch is one row of Method, and its words
in study_sentence.py where its names do not say enough; the names that it takes, and whether it is there, are asked of the program
that will run (clrt_choices.py)."""
import dataclasses
import itertools
from typing import Optional

# The name of an option that is left away.
OFF, ON = "off", "on"


@dataclasses.dataclass(frozen=True)
class Switch:
    """An option of clrt whose names are compared."""
    option: str               # of clrt
    plural: str               # option of clrt-study that lists names of it
    rank: int                 # of its changes: those of the highest are measured last, and dropped first where time is short
    about: str                # of the option of clrt-study, for --help
    short: Optional[str] = None
    combined: bool = False    # with all others where no list was given; else one change at a time
    usual: Optional[str] = None  # the name that need not be said
    bare: bool = False        # the option alone, or --option=NAME; OFF leaves it away
    tried: tuple = ()         # what is compared where no list was given, the default first; empty: all names in clrt's help
    numbers: bool = False     # takes whole numbers beside its names

    def words(self, name):
        """The part of clrt's command line that says so."""
        if not self.bare:
            return [self.option, name]
        return [] if name == OFF else [self.option if name == ON else f"{self.option}={name}"]


def _switch(*row, **settings):
    return dataclasses.field(default=None, metadata={"switch": Switch(*row, **settings)})


@dataclasses.dataclass(frozen=True)
class Method:
    """What is compared: a name for every switch; None where this clrt has no such switch."""
    integrator: Optional[str] = _switch("--integrator", "integrators", 9, "those of clrt that are compared (default path,whitted; "
                                        "quick: path)", "-i", combined=True)
    precision: Optional[str] = _switch("--precision", "precisions", 8, "likewise (default: all)", "-p", combined=True)
    sampler: Optional[str] = _switch("--sampler", "samplers", 1, "likewise (default: all)", combined=True)
    lights: Optional[str] = _switch("--light-sampler", "light-samplers", 2, "likewise; combined with the others where it is given "
                                    "(default: all that this clrt has, one change at a time)", usual="tree")
    path_reuse: Optional[str] = _switch("--path-reuse", "path-reuse", 3, "likewise (default: auto,off)", usual="auto",
                                        tried=("auto", "off"))
    guide: Optional[str] = _switch("--guide", "guides", 4, "likewise, such as auto,on,off", usual="auto")
    emission_rays: Optional[str] = _switch("--emission-rays", "emission-rays", 5, "likewise (default: 16,1)", usual="16",
                                           tried=("16", "1"), numbers=True)
    light_samples: Optional[str] = _switch("--light-samples", "light-samples", 6, "likewise, such as auto,1,4 (default: auto,1)",
                                           usual="auto", tried=("auto", "1"), numbers=True)
    adaptive: Optional[str] = _switch("--adaptive", "adaptive", 7, "likewise, such as off,relative", usual=OFF, bare=True)

    def __str__(self):
        return ", ".join(self._said(field, name) for field, name in self.names().items()
                         if name != SWITCHES[field].usual)

    def names(self):
        """{field: name} of the switches that there are."""
        return {field: getattr(self, field) for field in SWITCHES if getattr(self, field) is not None}

    def words(self):
        """The part of clrt's command line that says all this."""
        return [word for field, name in self.names().items() for word in SWITCHES[field].words(name)]

    def changes(self, other):
        """{field: name of this method} where it differs from the other."""
        return {field: name for field, name in self.names().items() if name != getattr(other, field)}

    def label(self, default):
        """The method in few words: what differs from the default."""
        return ", ".join(self._said(field, name) for field, name in self.changes(default).items()) or f"default ({self})"

    @staticmethod
    def _said(field, name):
        """A name that says alone what it is, or with its switch: `whitted`, `guide off`."""
        return name if SWITCHES[field].combined else f"{field.replace('_', ' ')} {name}"


SWITCHES = {field.name: field.metadata["switch"] for field in dataclasses.fields(Method)}


def combinations(names, given, quick, default):
    """The methods of a study, the default first. `names`: {field: list}; `given`: fields whose list was asked for; `default`: the
    Method of clrt without options. Quick studies change one thing at a time; others combine what was asked for and what is
    always combined, and change the rest one at a time."""
    every = [Method(**dict(zip(names, chosen))) for chosen in itertools.product(*names.values())]
    first = default if default in every else every[0]
    one_change = [method for field in sorted(SWITCHES, key=lambda field: SWITCHES[field].rank) for method in every
                  if list(method.changes(first)) == [field]]
    if quick:
        return [first] + one_change
    alone = [field for field in names if field not in given and not SWITCHES[field].combined]
    combined = [method for method in every if not set(method.changes(first)) & set(alone)]
    methods = [first] + one_change
    return methods + [method for method in combined if method not in methods]
