#!/usr/bin/python3
"""Mutation test of pkmopt-check-proof.

proofs.py PROGRAM CHECKER [--mutations N] [--seed S] [--keep FOLDER]

`certify --proof` writes small proofs, which are mutated. CHECKER checks each mutant. The volume that the mutant claims
is compared with bounds of the true volume from an independent evaluator: interval branch and bound in fixed-point
arithmetic (integer multiples of 2^-160), with integer square roots, and series for trigonometric functions. It shares
neither code nor methods with the checker. If the boxes of a mutant are valid, two false claims are checked as well: a
volume above the upper and one below the lower bound of the true volume.

The campaign fails if a false volume is accepted, or if the exit code is neither 0 nor 1. Rejected mutants with a true
volume are counted by reason: their statement is true, but their boxes do not prove it.
"""

import argparse
import collections
import fractions
import heapq
import math
import os
import random
import re
import subprocess
import sys
import tempfile

# ---- fixed-point interval arithmetic ----
# Interval: (lower, upper, is_defined). The bounds are integer multiples of 2^-SCALE; is_defined is true if the function
# is defined on the whole box. None instead of an interval: defined nowhere on the box.

SCALE = 160
ONE = 1 << SCALE
GUARD = 40  # guard bits of series; their errors are below 2^(GUARD/2) units of the last guard bit


def series_atan(t, one):
    """arctan(t / one) in units of 1 / one, for 0 <= t <= one; the error is less than 2^10 units."""
    for _ in range(3):
        t = t * one // (one + math.isqrt(one * one + t * t))
    square, power, total, n = t * t // one, t, 0, 1
    while power:
        total += power // n if n % 4 == 1 else -(power // n)
        power = power * square // one
        n += 2
    return 8 * total


FINE = ONE << GUARD
PI = 4 * (4 * series_atan(FINE // 5, FINE) - series_atan(FINE // 239, FINE))  # Machin's formula
SLACK = 1 << (GUARD // 2)


def outward(fine, slack=SLACK):
    """Bounds at SCALE of a value with guard bits and an error of at most `slack`."""
    return (fine - slack) >> GUARD, -((-fine - slack) >> GUARD)


PI_DOWN, PI_UP = outward(PI)


def atan2_at(y, x):
    """Bounds of atan2(y, x) at a point other than the origin."""
    a, b = abs(y), abs(x)
    t = series_atan((min(a, b) << (SCALE + GUARD)) // max(a, b), FINE)
    if a > b:
        t = PI // 2 - t
    if x < 0:
        t = PI - t
    return outward(t if y >= 0 else -t)


def sine_at(x):
    """Bounds of sin(x) at a point."""
    fine = (x << GUARD) % (2 * PI)
    # the error of PI is multiplied by the number of periods in x
    slack = SLACK * (1 + abs((x << GUARD) // (2 * PI)))
    sign = 1
    if fine > PI:
        fine, sign = fine - PI, -1
    if 2 * fine > PI:
        fine = PI - fine
    term, total, n, square = fine, 0, 1, fine * fine // FINE
    while term:
        total += term if n % 4 == 1 else -term
        term = term * square // FINE // ((n + 1) * (n + 2))
        n += 2
    low, high = outward(sign * total, slack)
    return max(low, -ONE), min(high, ONE)


def hull(values):
    return min(v[0] for v in values), max(v[1] for v in values)


class Unknown(Exception):
    """The evaluator cannot compute bounds."""


def shifted_sine(x, quarter):
    """Enclosure of sin(x + quarter * pi / 2) over an interval."""
    low, high, ok = x
    if max(-low, high) > 100000 * ONE:
        raise Unknown("the program does not evaluate the sine beyond 1e5")
    if high - low >= 2 * PI_DOWN:
        return -ONE, ONE, ok
    shifted = [low + quarter * PI_DOWN // 2, high + quarter * PI_UP // 2 + 1]
    ends = hull([sine_at(shifted[0]), sine_at(shifted[1])])

    def contains_extremum(quarters):  # at quarters * pi/2 + 2 k pi
        first = (2 * shifted[0] - quarters * PI_UP - 2) // (4 * PI_UP) - 1
        for k in range(first, first + 5):
            at = sorted(((4 * k + quarters) * PI_DOWN // 2, (4 * k + quarters) * PI_UP // 2 + 1))
            if at[1] >= shifted[0] and at[0] <= shifted[1]:
                return True
        return False
    return (-ONE if contains_extremum(3) else ends[0]), (ONE if contains_extremum(1) else ends[1]), ok


def add(x, y):
    return x[0] + y[0], x[1] + y[1], x[2] and y[2]


def negative(x):
    return -x[1], -x[0], x[2]


def multiply(x, y):
    products = [a * b for a in x[:2] for b in y[:2]]
    return min(products) >> SCALE, -(-max(products) >> SCALE), x[2] and y[2]


def square(x):
    low, high = sorted((abs(x[0]), abs(x[1])))
    if x[0] <= 0 <= x[1]:
        low = 0
    return low * low >> SCALE, -(-high * high >> SCALE), x[2]


def divide(x, y):
    if y[0] == y[1] == 0:
        return None
    if y[0] <= 0 <= y[1]:
        raise Unknown("division by an interval that contains 0")
    quotients = [((a << SCALE) // b, -((-a << SCALE) // b)) for a in x[:2] for b in y[:2]]
    return (*hull(quotients), x[2] and y[2])


def root(x):
    if x[1] < 0:
        return None
    low, high = max(x[0], 0), x[1]
    return math.isqrt(low << SCALE), math.isqrt(high << SCALE) + 1, x[2] and x[0] >= 0


def arc(x, is_sine):
    """Enclosure of asin(x) or acos(x)."""
    if x[0] > ONE or x[1] < -ONE:
        return None
    ends = []
    for v in (max(x[0], -ONE), min(x[1], ONE)):
        cosine = (math.isqrt((ONE - v) * (ONE + v) << (2 * GUARD)), v << GUARD)
        # the integer square root has an error of one unit of the last guard bit
        low, high = atan2_at(cosine[1], cosine[0]) if is_sine else atan2_at(*cosine)
        ends.append((low - 1, high + 1))
    return (*hull(ends), x[2] and -ONE <= x[0] and x[1] <= ONE)


def angle(y, x):
    """Enclosure of atan2(y, x)."""
    ok = x[2] and y[2]
    if y[0] <= 0 <= y[1] and (x[0] <= 0 <= x[1] or (x[0] < 0 and y[0] < 0)):
        return -PI_UP, PI_UP, ok
    return (*hull([atan2_at(b, a) for a in x[:2] for b in y[:2]]), ok)


def principal_angle(x):
    """Enclosure of x - 2 pi ceil(x / (2 pi) - 1/2), the angle in (-pi, pi]."""
    low, high, ok = x
    counts = set()
    for v in (low, high):
        for pi in (PI_DOWN, PI_UP):
            counts.add(-((pi - v) // (2 * pi)))
    if len(counts) > 1:
        return -PI_UP, PI_UP, ok
    n = counts.pop()
    periods = sorted((2 * n * PI_DOWN, 2 * n * PI_UP))
    return low - periods[1], high - periods[0], ok


def truth(x):
    """Truth value of a condition: True, False, or None if undecided."""
    return True if x[0] > 0 or x[1] < 0 else False if x[0] == x[1] == 0 else None


def condition(value, ok):
    """Interval of a condition: 1, 0 or [0, 1] if undecided."""
    return {True: (ONE, ONE, ok), False: (0, 0, ok), None: (0, ONE, ok)}[value]


def ordered(x, y, strict):
    ok = x[2] and y[2]
    if x[1] < y[0] or (not strict and x[1] <= y[0]):
        return condition(True, ok)
    if x[0] > y[1] or (strict and x[0] >= y[1]):
        return condition(False, ok)
    return condition(None, ok)


def equal(x, y):
    ok = x[2] and y[2]
    if x[1] < y[0] or x[0] > y[1]:
        return condition(False, ok)
    return condition(True if x[0] == x[1] == y[0] == y[1] else None, ok)


def choose(c, x, y):
    """Enclosure of c ? x : y."""
    chosen = None if c is None else truth(c)
    if c is None:
        return None
    if chosen is not None:
        value = x if chosen else y
        return value and (value[0], value[1], value[2] and c[2])
    if x is None or y is None:
        value = x or y
        return value and (value[0], value[1], False)
    return (*hull([x, y]), x[2] and y[2] and c[2])


def power(x, y):
    n = y[0] >> SCALE
    if y[0] != y[1] or n << SCALE != y[0] or abs(n) > 64:
        raise Unknown("not an integer power, or too large")
    result, factor, k = (ONE, ONE, True), x, abs(n)
    if k % 2 == 0 and x[0] < 0:  # even power: of the magnitude
        factor = (max(0, x[0], -x[1]), max(-x[0], x[1]), x[2])
    while k:
        if k % 2:
            result = multiply(result, factor)
        factor = square(factor)
        k //= 2
    return divide((ONE, ONE, True), result) if n < 0 else result


def magnitude(x):
    return x if x[0] >= 0 else negative(x) if x[1] <= 0 else (0, max(-x[0], x[1]), x[2])


def sign(x):
    of = [(v > 0) - (v < 0) for v in x[:2]]
    return of[0] * ONE, of[1] * ONE, x[2]


FUNCTIONS = {
    "sin": lambda x: shifted_sine(x, 0), "cos": lambda x: shifted_sine(x, 1),
    "tan": lambda x: divide(shifted_sine(x, 0), shifted_sine(x, 1)),
    "asin": lambda x: arc(x, True), "acos": lambda x: arc(x, False),
    "atan": lambda x: angle(x, (ONE, ONE, True)), "atan2": angle, "sqrt": root, "abs": magnitude, "sign": sign,
    "min": lambda x, y: (min(x[0], y[0]), min(x[1], y[1]), x[2] and y[2]),
    "max": lambda x, y: (max(x[0], y[0]), max(x[1], y[1]), x[2] and y[2]),
    "+": add, "-": lambda x, y: add(x, negative(y)), "*": multiply, "/": divide, "^": power,
    "negative": negative, "turn": principal_angle,
    "<": lambda x, y: ordered(x, y, True), "<=": lambda x, y: ordered(x, y, False),
    ">": lambda x, y: ordered(y, x, True), ">=": lambda x, y: ordered(y, x, False),
    "==": equal, "!=": lambda x, y: add((ONE, ONE, True), negative(equal(x, y))),
    "&&": lambda x, y: FUNCTIONS["min"](condition(truth(x), x[2]), condition(truth(y), y[2])),
    "||": lambda x, y: FUNCTIONS["max"](condition(truth(x), x[2]), condition(truth(y), y[2])),
}
DOUBLES = {"+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b, "/": lambda a, b: a / b,
           "negative": lambda a: -a, "sqrt": math.sqrt, "abs": abs, "min": min, "max": max}


def exact(number):
    """A double as an integer multiple of 2^-SCALE."""
    value = fractions.Fraction(number) * ONE
    if value.denominator != 1:
        raise Unknown("a number with more than SCALE bits after the point")
    return value.numerator


# ---- the statement of a proof: an expression graph with its nodes in order of evaluation ----

RANK = {"||": 1, "&&": 2, "<": 4, "<=": 4, ">": 4, ">=": 4, "==": 4, "!=": 4, "+": 5, "-": 5, "*": 6, "/": 6, "^": 8}
WORD = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*)|(<=|>=|==|!=|&&|\|\||.))")


class Statement:
    """Parser and evaluator of the lines of a proof before "boxes". Raises Unknown or ValueError."""

    def __init__(self, lines):
        self.nodes, self.names, self.axes, self.given, self.conditions = [], {}, [], [], []
        for line in lines:
            kind, _, rest = line.partition(" ")
            words = rest.split(" ")
            if kind == "axis":
                self.axes.append(tuple(exact(float(w)) for w in words[1:3]))
                self.names[words[0]] = self.add("axis", len(self.axes) - 1)
            elif kind == "given":
                self.given.append(tuple(exact(float(w)) for w in words[1:3]))
                self.names[words[0]] = self.add("given", len(self.given) - 1)
            elif kind == "let":
                name, _, text = rest.partition(" = ")
                self.names[name] = self.formula(text)
            elif kind == "turn":
                self.names[words[0]] = self.add("turn", self.names[words[1]])
            elif kind == "condition":
                self.conditions.append(self.names[words[0]])

    def add(self, operation, *arguments):
        self.nodes.append((operation, arguments))
        return len(self.nodes) - 1

    def call(self, operation, *arguments):
        numbers = [self.nodes[a][1][0] for a in arguments if self.nodes[a][0] == "number"]
        if len(numbers) < len(arguments):
            return self.add(operation, *arguments)
        if operation == "^" and numbers[1] == 2:
            return self.add("number", numbers[0] * numbers[0])
        if operation not in DOUBLES:
            raise Unknown("a function of constants, which the program evaluates in double precision")
        try:
            value = DOUBLES[operation](*numbers)
        except (ZeroDivisionError, ValueError):
            value = math.nan
        if not math.isfinite(value):
            raise Unknown("a constant that is not finite")
        return self.add("number", value)

    def formula(self, text):
        self.words = [m.groups() for m in WORD.finditer(text.rstrip())] + [(None, None, None)]
        self.at = 0
        node = self.choice()
        if self.words[self.at] != (None, None, None):
            raise ValueError("text after the formula")
        return node

    def accept(self, *symbols):
        found = self.words[self.at][2]
        if found in symbols:
            self.at += 1
            return found
        return None

    def expect(self, symbol):
        if not self.accept(symbol):
            raise ValueError("expected " + symbol)

    def choice(self):
        condition = self.binary(1)
        if not self.accept("?"):
            return condition
        yes = self.choice()
        self.expect(":")
        return self.call("?", condition, yes, self.choice())

    def binary(self, rank):
        left = self.unary()
        while self.words[self.at][2] in RANK and RANK[self.words[self.at][2]] >= rank:
            operation = self.accept(self.words[self.at][2])
            right = self.binary(RANK[operation] + (operation != "^"))
            left = self.call(operation, left, right)
        return left

    def unary(self):
        if self.accept("-"):
            return self.call("negative", self.binary(7))
        self.accept("+")
        number, name, _ = self.words[self.at]
        if number:
            self.at += 1
            return self.add("number", float(number))
        if name == "pi":
            self.at += 1
            return self.add("number", math.pi)
        if name in FUNCTIONS:
            self.at += 1
            self.expect("(")
            arguments = [self.choice()]
            while self.accept(","):
                arguments.append(self.choice())
            self.expect(")")
            if name in ("min", "max"):
                node = arguments[0]
                for other in arguments[1:]:
                    node = self.call(name, node, other)
                return node
            return self.call(name, *arguments)
        if name:
            if name not in self.names:
                raise Unknown("a name that the evaluator does not support: " + name)
            self.at += 1
            return self.names[name]
        self.expect("(")
        node = self.choice()
        self.expect(")")
        return node

    def order(self, undecided):
        """Indices of the nodes that the given conditions need."""
        needed = [False] * len(self.nodes)
        for k in undecided:
            needed[self.conditions[k]] = True
        for i in range(len(self.nodes) - 1, -1, -1):
            if needed[i] and self.nodes[i][0] not in ("axis", "given", "number"):
                for a in self.nodes[i][1]:
                    needed[a] = True
        return [i for i, n in enumerate(needed) if n]

    def values(self, box, given, undecided):
        """Enclosures of the given conditions over a box; "unknown" if the evaluator has none."""
        found = {}
        for i in self.order(undecided):
            operation, arguments = self.nodes[i]
            if operation == "axis":
                found[i] = (*box[arguments[0]], True)
            elif operation == "given":
                found[i] = (*given[arguments[0]], True)
            elif operation == "number":
                v = exact(arguments[0])
                found[i] = (v, v, True)
            else:
                values = [found[a] for a in arguments]
                if "unknown" in values:
                    found[i] = "unknown"
                elif operation == "?":
                    found[i] = choose(*values)
                elif None in values:
                    found[i] = None
                else:
                    try:
                        same = operation == "*" and arguments[0] == arguments[1]
                        found[i] = square(values[0]) if same else FUNCTIONS[operation](*values)
                    except Unknown:
                        found[i] = "unknown"
        return {k: found[self.conditions[k]] for k in undecided}

    def volume(self, given, cells, gap):
        """Bounds of the volume as fractions, by interval branch and bound over all axes."""
        unit = fractions.Fraction(1, ONE ** len(self.axes))
        inside = undecided = 0
        heap = []

        def classify(box, conditions):
            nonlocal inside, undecided
            size = math.prod(high - low for low, high in box)
            remaining = []
            for k, value in self.values(box, given, conditions).items():
                if value is None or (value != "unknown" and value[1] < 0):
                    return
                if value == "unknown" or value[0] < 0 or not value[2]:
                    remaining.append(k)
            if not remaining:
                inside += size
                return
            undecided += size
            heapq.heappush(heap, (-size, box, tuple(remaining)))

        classify(tuple(self.axes), tuple(range(len(self.conditions))))
        whole = [high - low for low, high in self.axes]
        for _ in range(cells):
            if not heap or undecided <= gap * (inside + undecided):
                break
            size, box, conditions = heapq.heappop(heap)
            undecided += size
            axis = max(range(len(box)), key=lambda a: fractions.Fraction(box[a][1] - box[a][0], whole[a]))
            low, high = box[axis]
            middle = (low + high) // 2
            for half in ((low, middle), (middle, high)):
                classify(box[:axis] + (half,) + box[axis + 1:], conditions)
        return inside * unit, (inside + undecided) * unit


class Truth:
    """Bounds of the true volume of each statement, cached."""

    def __init__(self):
        self.known = {}

    def bounds(self, head, cells, gap, first_cells=0):
        """Bounds that hold for all values of the given intervals, and bounds for one of the values; None: unknown.
        @param first_cells  number of cells instead of `cells` if the statement is new (0: `cells`)"""
        key = (head, cells)
        if key not in self.known:
            try:
                cells = first_cells or cells
                statement = Statement(head)
                every = statement.volume(statement.given, cells, gap)
                fixed = [(low, low) for low, _ in statement.given]
                one = every if fixed == statement.given else statement.volume(fixed, cells, gap)
                self.known[key] = every, one
            except (Unknown, ValueError, KeyError, IndexError, TypeError, OverflowError):
                self.known[key] = None
        return self.known[key]


# ---- mutants ----

SEEDS = {  # name: (ranges of the axes, conditions, gap)
    "disc": ({"x": (-1.25, 1.25), "y": (-1.25, 1.25)}, ["1 - x^2 - y^2"], 0.5),
    "half-disc": ({"x": (-1, 1), "y": (-1, 1)}, ["sqrt(x^2 + y^2) - 0.25", "1 - x^2 - y^2", "y"], 0.6),
    "interval": ({"x": (-2, 3)}, ["0.75 - x*x"], 0.1),
    "two-intervals": ({"x": (-2, 3)}, ["abs(x) - w/2", "2 - x^2"], 0.1),
    "wave": ({"x": (0, 2), "y": (-1, 1)}, ["sin(3*x) - y", "y + 0.5"], 0.6),
    "arc": ({"x": (-1.5, 1.5), "y": (0, 4)}, ["acos(x) - y"], 0.5),
    "angle": ({"x": (-1, 1), "y": (-1, 1)}, ["atan2(y, x) + 2", "1 - max(abs(x), abs(y) + w)"], 0.6),
    "choice": ({"x": (-1, 1), "y": (-1, 1)}, ["(x > 0.25 ? 1 - x : w + x) - y^2", "1/(x + 2) - w"], 0.6),
    "ball": ({"x": (-1, 1), "y": (-1, 1), "z": (-1, 1)}, ["1 - x^2 - y^2 - z^2"], 1.5),
}
MECHANISM = """[mechanism]
name = "%s"
[parameters]
w = { default = 0.5, min = 0.1, max = 3, unit = "m" }
[platform]
coordinates = { %s }
[survey]
sweep = [%s]
box = { %s }
[[limb]]
name = "a"
drive = "formula"
joints = { %s }
unit = "m"
"""
MARGIN = '[[margin]]\nname = "margin %d"\nformula = "%s"\nunit = "1"\n'
FILES = {"five-bar": 0.5, "3-rpr": 1.4}  # mechanism files in experiments, with gaps
EXPERIMENTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../experiments/mechanisms")

NUMBER = re.compile(r"-?\b\d+\.?\d*(?:e[-+]?\d+)?")
STEP = re.compile(r"[xh]\d+ |t\d+ \d+ \d+ \d+ |s\d+ \d+ |r\d+ |n|\.\n|/\d\n")
HARD_NUMBERS = ["0", "-0", "1", "-1", "1e308", "-1e308", "1.7976931348623157e308", "5e-324", "1e-300", "1e16", "1e999",
                "inf", "-inf", "nan", "0x1p3", "1,5", "", "1e-9", "2", "0.5", "3"]
HARD_COUNTS = ["0", "1", "-1", "1073741824", "1073741823", "1073741825", "9223372036854775807", "9223372036854775808",
               "536870912", "127", "128", "00", "+1", "1e3", "", "2"]
WRAPPINGS = ["min(%s, %s)", "max(%s, %s)", "abs(%s) + 0*%s", "sqrt(max(%s, 0)) + 0*%s", "(%s) - (%s)", "(%s) * (%s)",
             "(%s > %s ? 1 : 2)", "min(sqrt(min((%s)^2, 0)), %s)", "(%s)/(%s)", "sqrt(%s)*(%s)", "acos(%s) + 0*%s",
             "(%s)^(%s)", "1e308*(%s) + 0*%s", "sign(%s) - %s", "tan(%s) + 0*%s", "atan2(%s, %s)"]
OPERATIONS = [" + ", " - ", " * ", " / "]


def similar_number(number, draw):
    """A number close to the given one, or with another sign or scale."""
    value = float(number)
    return repr(draw.choice([value * (1 + draw.choice([1e-15, 1e-9, 1e-3, 0.1]) * draw.choice([-1, 1])), -value,
                             value + draw.choice([-1, 1]) * 0.01, value * 2, value / 2]))


def mutate_head(lines, draw):
    lines = list(lines)
    i = draw.randrange(1, len(lines))
    kind = draw.randrange(7)
    if kind == 0:
        numbers = list(NUMBER.finditer(lines[i]))
        if numbers:
            m = draw.choice(numbers)
            text = similar_number(m.group(), draw) if draw.random() < 0.7 else draw.choice(HARD_NUMBERS)
            lines[i] = lines[i][:m.start()] + text + lines[i][m.end():]
    elif kind == 1:
        del lines[i]
    elif kind == 2:
        lines.insert(draw.randrange(1, len(lines) + 1), lines[i])
    elif kind == 3:
        k = draw.randrange(1, len(lines))
        lines[i], lines[k] = lines[k], lines[i]
    elif kind == 4:
        names = re.findall(r"\bn\d+\b|\bi\d+\b|\b[xyz]\b", "\n".join(lines))
        places = list(re.finditer(r"\bn\d+\b|\bi\d+\b|\b[xyz]\b", lines[i]))
        if names and places:
            m = draw.choice(places)
            lines[i] = lines[i][:m.start()] + draw.choice(names) + lines[i][m.end():]
    elif kind == 5 and " = " in lines[i]:
        start, _, text = lines[i].partition(" = ")
        other = draw.choice(re.findall(r"\bn\d+\b|\bi\d+\b|\b[xyz]\b", text) or ["x"])
        lines[i] = start + " = " + draw.choice(WRAPPINGS) % (text, other)
    elif kind == 6:
        places = [m.start() for o in OPERATIONS for m in re.finditer(re.escape(o), lines[i])]
        if places:
            at = draw.choice(places)
            lines[i] = lines[i][:at] + draw.choice(OPERATIONS) + lines[i][at + 3:]
    return lines


def mutate_volume(line, draw):
    try:
        low, high = (float(w) for w in line.split()[1:3])
    except ValueError:  # an earlier mutation left no numbers
        return line
    gap = high - low
    low, high = draw.choice([(low + draw.random() * gap, high), (low, high - draw.random() * gap),
                             (high, high + gap), (0, low * draw.random()), (low - gap, high + gap),
                             (high, low), (low * 0.999, high * 1.001)])
    return "volume %r %r" % (low, high)


def mutate_steps(steps, draw):
    steps = list(steps)
    i = draw.randrange(len(steps))
    kind = draw.randrange(8)
    if kind < 3:
        numbers = list(re.finditer(r"\d+", steps[i]))
        if numbers:
            m = draw.choice(numbers)
            value = int(m.group())
            text = str(draw.choice([value + 1, value - 1, value + (1 << draw.randrange(28)),
                                    value - (1 << draw.randrange(28)), value // 2, 2 * value]))
            if draw.random() < 0.1:
                text = draw.choice(HARD_COUNTS)
            steps[i] = steps[i][:m.start()] + text + steps[i][m.end():]
    elif kind == 3:
        del steps[i]
    elif kind == 4:
        steps.insert(draw.randrange(len(steps) + 1), steps[i])
    elif kind == 5:
        k = draw.randrange(len(steps))
        steps[i], steps[k] = steps[k], steps[i]
    elif kind == 6:
        steps[i] = draw.choice(["x0 ", "h0 ", "x1 ", "h1 ", "n", "s0 0 ", ".\n", "/0\n", "/1\n",
                                "r%d " % draw.randrange(1 << 30), "t0 0 1073741824 %d " % draw.randrange(1 << 30)])
    elif steps[i][0] in "xh":
        steps[i] = ("h" if steps[i][0] == "x" else "x") + steps[i][1:]
    elif steps[i][0] == "/":  # and the whole tree below it
        steps[i:] = [".\n"]
    return steps


def mutate_bytes(text, draw):
    at = draw.randrange(len(text))
    kind = draw.randrange(4)
    if kind == 0:
        return text[:at] + chr(draw.randrange(256)) + text[at + 1:]
    if kind == 1:
        return text[:at]
    end = min(len(text), at + draw.randrange(1, 40))
    return text[:at] + text[end:] if kind == 2 else text[:end] + text[at:]


class Proof:
    def __init__(self, text):
        head, _, boxes = text.partition("boxes\n")
        self.lines = [line for line in head.split("\n")[:-1] if not line.startswith("#")]
        self.steps = STEP.findall(boxes.removesuffix("end\n"))

    def text(self):
        return "\n".join(self.lines) + "\nboxes\n" + "".join(self.steps) + "end\n"


def mutant(proofs, draw):
    chosen = draw.choice(proofs)
    proof = Proof("")
    proof.lines, proof.steps = chosen.lines, chosen.steps
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        kind = draw.random()
        if kind < 0.25:
            proof.lines = mutate_head(proof.lines, draw)
        elif kind < 0.35:
            proof.lines = [mutate_volume(line, draw) if line.startswith("volume ") and len(line.split()) == 3 and
                           "x" not in line else line for line in proof.lines]
        elif kind < 0.9 and proof.steps:
            proof.steps = mutate_steps(proof.steps, draw)
        elif kind < 0.95:  # use the boxes of another proof
            proof.steps = draw.choice(proofs).steps
        else:
            return mutate_bytes(proof.text(), draw)
        if len(proof.lines) < 3:
            break
    return proof.text()


# ---- the campaign ----

def seeds(program, folder):
    found = []

    def certify(name, file, gap):
        proof = os.path.join(folder, name + ".proof")
        done = subprocess.run([program, "certify", file, "--gap", str(gap), "--proof", proof, "--threads", "1"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder)
        if done.returncode != 0:
            sys.exit("%s: %s" % (name, done.stdout))
        with open(proof, encoding="utf-8") as text:
            found.append((name, text.read()))

    for name, (axes, conditions, gap) in SEEDS.items():
        path = os.path.join(folder, name + ".toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(MECHANISM % (
                name, ", ".join('%s = "along %s"' % (a, a) for a in axes), ", ".join('"%s"' % a for a in axes),
                ", ".join("%s = [%r, %r]" % (a, *r) for a, r in axes.items()),
                ", ".join('q_%s = "%s"' % (a, a) for a in axes)))
            for number, condition in enumerate(conditions):
                file.write(MARGIN % (number, condition))
        certify(name, path, gap)
    for name, gap in FILES.items():
        certify(name, os.path.join(EXPERIMENTS, name + ".toml"), gap)
    return found


def with_volume(text, low, high):
    return re.sub(r"^volume .*$", "volume %r %r" % (low, high), text, count=1, flags=re.MULTILINE)


def double(fraction, toward):
    """A double strictly above (toward = 1) or below (-1) a fraction."""
    value = float(fraction)
    for _ in range(2):
        value = math.nextafter(value, toward * math.inf)
    return value


class Campaign:
    def __init__(self, checker, folder, keep):
        self.checker, self.file, self.keep = checker, os.path.join(folder, "mutant.proof"), keep
        self.truth, self.counts, self.reasons, self.failures = Truth(), collections.Counter(), collections.Counter(), 0

    def check(self, text):
        with open(self.file, "w", encoding="utf-8", newline="") as file:
            file.write(text)
        try:
            done = subprocess.run([self.checker, self.file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60,
                                  errors="replace")
        except subprocess.TimeoutExpired:
            self.fail("still running after 60 s", text)
            return 1, ""
        if done.returncode not in (0, 1):
            self.fail("exit code %d: %s" % (done.returncode, done.stderr), text)
        return done.returncode, done.stderr

    def fail(self, what, text):
        self.failures += 1
        print("FAULT: " + what, flush=True)
        if self.keep:
            os.makedirs(self.keep, exist_ok=True)
            with open(os.path.join(self.keep, "fault-%d.proof" % self.failures), "w", encoding="utf-8",
                      newline="") as file:
                file.write(text)
        else:
            print(text[:4000], flush=True)

    def judge(self, text, cells, gap):
        """Checks one mutant and compares the answer of the checker with the true volume."""
        code, reason = self.check(text)
        valid_boxes = code == 0 or "the proven " in reason  # lower or upper bound
        head, separator, _ = text.partition("\nboxes\n")
        lines = [line for line in head.split("\n") if not line.startswith("#")]
        claims = [line.split(" ") for line in lines if line.startswith("volume ")]
        if not separator or len(claims) != 1:
            if code == 0:
                self.fail("accepted, although it is not a proof", text)
            self.counts["no proof", code] += 1
            return
        statement = tuple(line for line in lines if not line.startswith("volume "))
        bounds = self.truth.bounds(statement, cells, gap, 0 if valid_boxes else cells // 8)
        if bounds is None:
            self.counts["unknown", code] += 1
            return
        every, one = bounds
        try:
            low, high = (fractions.Fraction(float(w)) for w in claims[0][1:3])
        except (ValueError, OverflowError):
            self.counts["no proof", code] += 1
            if code == 0:
                self.fail("accepted, although its volume is not a number", text)
            return
        is_true, is_false = low <= every[0] and every[1] <= high, high < one[0] or low > one[1]
        claim = "true" if is_true else "false" if is_false else "undecided"
        self.counts[claim, code] += 1
        if code == 0 and is_false:
            self.fail("a false volume is accepted; the true volume is between %g and %g" % (one[0], one[1]), text)
        if code == 1 and is_true:
            self.reasons[re.sub(r"-?\d[\d.e+-]*|'.*'|\".*\"", "_", reason.strip())] += 1
        if not valid_boxes:
            return
        self.counts["valid boxes"] += 1
        false_claims = [(double(one[1], 1), 1e300)] + ([(0.0, double(one[0], -1))] if one[0] > 0 else [])
        for low, high in false_claims:
            false = with_volume(text, low, high)
            if self.check(false)[0] == 0:
                self.fail("a false claim is accepted; the true volume is between %g and %g" % (one[0], one[1]), false)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("checker")
    parser.add_argument("--mutations", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cells", type=int, default=400, help="boxes that the evaluator divides for each statement")
    parser.add_argument("--keep", help="save the mutants that reveal faults in this folder")
    options = parser.parse_args()
    draw = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        campaign = Campaign(os.path.abspath(options.checker), folder, options.keep)
        originals = seeds(os.path.abspath(options.program), folder)
        proofs = []
        for name, text in originals:
            proof = Proof(text)
            proofs.append(proof)
            statement = tuple(line for line in proof.lines if not line.startswith("volume "))
            bounds = campaign.truth.bounds(statement, options.cells, 1e-3, 10 * options.cells)
            campaign.judge(proof.text(), options.cells, 1e-3)
            if campaign.counts["false", 0] + campaign.counts["false", 1] or not campaign.counts["valid boxes"]:
                campaign.fail("%s, the original proof" % name, text)
            volume = proof.lines[1].partition(" ")[2]
            found = "%.6g to %.6g" % tuple(map(float, bounds[0])) if bounds else "unknown"
            print("%-13s %5d steps  volume %s; the evaluator: %s" % (name, len(proof.steps), volume, found), flush=True)
        for number in range(options.mutations):
            campaign.judge(mutant(proofs, draw), options.cells, 1e-3)
            if number % 1000 == 999:
                print("%d mutants, %d faults" % (number + 1, campaign.failures), flush=True)
    print("mutants         accepted  rejected")
    for claim in ("true", "undecided", "false", "unknown", "no proof"):
        print("%-14s  %8d  %8d" % (claim, campaign.counts[claim, 0], campaign.counts[claim, 1]))
    print("with valid boxes: %d, each with two false claims" % campaign.counts["valid boxes"])
    print("rejected although true, by reason:")
    for reason, count in campaign.reasons.most_common(12):
        print("%8d  %s" % (count, reason))
    print("%d mutants, %d faults (accepted false volumes, wrong exit codes)" % (options.mutations, campaign.failures))
    return 1 if campaign.failures or not campaign.counts["valid boxes"] else 0


if __name__ == "__main__":
    sys.exit(main())
