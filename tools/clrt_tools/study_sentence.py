# SPDX-License-Identifier: Apache-2.0
"""The figures of a study in words. Nothing is called better that is not so at 95 %."""
from clrt_tools.study_methods import Method
from clrt_tools.study_ratios import BELOW, EXTRAPOLATED, MEASURED, NEVER

# The error, relative, that the sentence tells the price of, and what it takes where that was not measured.
PREFERRED = (0.05, 0.02, 0.10, 0.01)
# A factor that nobody notices: errors, and seconds.
SAME_ERROR, SAME_SECONDS = 1.01, 1.05
# Widest interval, over or below 1, that is still called about the same.
WIDEST_SAME = 2.0

# What changes of a method are called, where their names do not say enough.
NAMES = {"sampler": {"sobol": "Sobol points", "independent": "white noise"},
         "precision": {"double": "double precision", "single": "single precision", "fast": "fast maths"},
         "lights": {"tree": "the light tree", "mixture": "choosing lights by power and evenly",
                    "power": "choosing lights by power alone"},
         "path_reuse": {"on": "reuse of paths", "off": "no reuse of paths", "auto": "reuse of paths by pilots' choice"},
         "emission_rays": {"1": "one camera ray a sample", "16": "16 camera rays a sample at the outlines of lamps"},
         "light_samples": {"1": "one light sample", "auto": "a number of light samples by pilots' choice"},
         "guide": {"on": "path guiding", "off": "no path guiding", "auto": "path guiding by a pilot's choice"},
         "adaptive": {"off": "even sampling", "on": "adaptive sampling", "mse": "adaptive sampling for the squared error",
                      "relative": "adaptive sampling for the relative error"}}
# The change that aims at the relative squared error, and is judged by it.
FOR_RELATIVE = ("adaptive", "relative")
THE_DEFAULT = "clrt's default"


def change_name(field, name):
    """A name of a switch in words."""
    return NAMES.get(field, {}).get(name, name if field == "integrator" else f"{field.replace('_', ' ')} {name}")


def number(value):
    """Two digits, without an exponent."""
    return f"{float(f'{value:.2g}'):,.0f}" if value >= 10 else f"{value:.2g}"


def duration(seconds):
    """Two digits in s, min, h or days."""
    for limit, unit, length in ((100, "s", 1), (100 * 60, "min", 60), (48 * 3600, "h", 3600)):
        if seconds < limit:
            return f"{number(seconds / length)} {unit}"
    return f"{number(seconds / 86400)} days"


def ends(interval, words=number):
    """`3.5 - 13`, `2 - 24 min`; nothing where the interval is not known."""
    if not 0 < interval.low <= interval.high < float("inf"):
        return ""
    low, high = words(interval.low), words(interval.high)
    if " " in low and low.split()[1] == high.split()[1]:
        low = low.split()[0]
    return f"{low} - {high}"


def _in_brackets(text):
    return f" ({text})" if text else ""


def _same(interval):
    """In words; the interval includes 1."""
    if interval.low >= 1 / WIDEST_SAME and interval.high <= WIDEST_SAME:
        return "about the same"
    return "not told apart" + _in_brackets(f"{ends(interval)} times" if ends(interval) else "too few runs")


def cost_words(ratio):
    """A method's cost over the default's, for a table."""
    if ratio.floor:
        return f"levels off at {number(100 * ratio.floor)} %"
    if ratio.cost is None:
        return "below the noise"
    if ratio.cost.includes_one:
        return _same(ratio.cost)
    if 1 / SAME_SECONDS < ratio.cost.value < SAME_SECONDS:
        return "about the same"
    return f"{number(ratio.cost.value)} times dearer" if ratio.cost.value > 1 else f"{number(1 / ratio.cost.value)} times cheaper"


def price_sentence(times, size):
    """`An error of 5 % costs 12 s (10 - 15 s) at 800x600.` of the default's TimeTo."""
    by_target = {time.target: time for time in times}
    order = sorted(PREFERRED, key=lambda target: by_target[target].kind != MEASURED)
    order = [target for target in order if by_target[target].kind in (MEASURED, EXTRAPOLATED)]
    if not order:
        below = [time for time in times if time.kind == BELOW]
        if not below:
            return "No error that was asked for is reached: the default does not simulate what the reference shows."
        best = min(below, key=lambda time: time.target)
        return f"An error of {100 * best.target:g} % costs less than {duration(best.seconds.value)} at {size}."
    time = by_target[order[0]]
    beyond = "extrapolated" if time.kind == EXTRAPOLATED else ""
    known = _in_brackets(", ".join(filter(None, (beyond, ends(time.seconds, duration)))))
    about = "about " if beyond or not size.measured else ""
    return f"An error of {100 * time.target:g} % costs {about}{duration(time.seconds.value)}{known} at {size}."


def _than(name, other, cost):
    """Who is better, by how much; `cost`: of the first over the other."""
    if cost.includes_one:
        same = _same(cost)
        return f"{other} and {name} " + ("cost about the same" if same == "about the same" else f"were {same}")
    better, worse, factor = (other, name, cost) if cost.value > 1 else (name, other, cost.inverse())
    if factor.value < SAME_SECONDS:
        return f"{other} and {name} cost about the same"
    verb = "are" if better == NAMES["sampler"]["sobol"] else "is"
    return f"{better} {verb} {number(factor.value)} times{_in_brackets(ends(factor))} better than {worse}"


def _precision(name, ratio):
    """Does it buy accuracy, or seconds?"""
    error, seconds = ratio.error, ratio.seconds
    if not (error.includes_one or 1 / SAME_ERROR < error.value < SAME_ERROR):
        return (f"{name} gives {number(error.value)} times{_in_brackets(ends(error))} the error in {number(seconds.value)} times "
                "the seconds")
    if seconds.includes_one or 1 / SAME_SECONDS < seconds.value < SAME_SECONDS:
        same = _same(seconds) if seconds.includes_one else "about the same"
        return f"{name} buys nothing: the same error" + (
            " in about the same time" if same == "about the same" else f", the seconds {same}")
    if seconds.value > 1:
        return f"{name} buys nothing: the same error in {number(seconds.value)} times{_in_brackets(ends(seconds))} the seconds"
    return f"{name} takes {number(seconds.value)} times{_in_brackets(ends(seconds))} the seconds for the same error"


def _clause(ratio, default):
    """What one change to the default does."""
    (field, value), = ratio.method.changes(default).items()
    name = change_name(field, value)
    if ratio.floor:
        return f"{name} levels off at {number(100 * ratio.floor)} %: it does not simulate all that the reference shows"
    if ratio.error is None:
        return f"{name} lies below the noise of the reference"
    if field == "precision":
        return _precision(name, ratio)
    other = change_name(field, getattr(default, field))
    if (field, value) == FOR_RELATIVE and ratio.relative_cost:
        return _than(name, other, ratio.relative_cost)
    return _than(name, other, ratio.cost)


def _rival_clause(ratio):
    """How another renderer compares with the default."""
    if ratio.floor:
        return f"{ratio.method} levels off at {number(100 * ratio.floor)} %: it does not render what the reference shows"
    known = [(cost, words) for cost, words in ((ratio.cost, "squared error"), (ratio.relative_cost, "relative squared error")) if cost]
    if not known:
        return f"{ratio.method} lies below the noise of the reference"
    return f"{THE_DEFAULT} and {ratio.method}: " + ", ".join(f"{_times_as_accurate(cost)} by the {words}" for cost, words in known)


def _times_as_accurate(cost):
    """`1.4 times (1.2 - 1.6) the accuracy a second`, of the default over the rival whose cost it is."""
    if cost.includes_one:
        return _same(cost)
    return f"{number(cost.value)} times{_in_brackets(ends(cost))} its accuracy a second"


def headline(times, size, ratios, default):
    """What a study says: the price of an error, what each single change to the default does, how other renderers compare."""
    methods = {method: ratio for method, ratio in ratios.items() if isinstance(method, Method)}
    clauses = [_clause(ratio, default) for method, ratio in methods.items() if len(method.changes(default)) == 1]
    sentence = price_sentence(times, size)
    if clauses:
        sentence += " " + clauses[0][0].upper() + "; ".join(clauses)[1:] + "."
    return " ".join([sentence] + [_rival_clause(ratio) + "." for method, ratio in ratios.items() if method not in methods])


def time_words(time):
    """A cell of the table: (words, their interval, mark)."""
    if time.kind == NEVER:
        return "not reached", "", ""
    if time.kind == BELOW:
        return f"< {duration(time.seconds.value)}", "", ""
    return duration(time.seconds.value), ends(time.seconds, duration), "*" if time.kind == EXTRAPOLATED else ""
