# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds a material's program: a list of data.Node in order of evaluation, with constants folded.

A Value is four numbers, known now (`constant`) or at render time (`node`, an index into Program.nodes). A scalar is a
Value with the same number in r, g and b.
"""

from dataclasses import dataclass

from . import data

# Rec. 709, as Blender turns a colour into a number.
LUMINANCE = (0.2126, 0.7152, 0.0722)


@dataclass(frozen=True)
class Value:
    constant: tuple = (0.0, 0.0, 0.0, 1.0)
    node: int = data.NONE

    @property
    def is_constant(self):
        return self.node == data.NONE

    def is_always(self, number):
        """Whether r, g and b are this number wherever the material is seen."""
        return self.is_constant and all(channel == number for channel in self.constant[:3])


def scalar(number):
    return Value((float(number),) * 3 + (1.0,))


def color(numbers):
    numbers = tuple(float(number) for number in numbers)
    return Value(numbers[:3] + (numbers[3] if len(numbers) > 3 else 1.0,))


ZERO = scalar(0)
ONE = scalar(1)


def _power(a, b):
    try:
        return max(a, 0.0) ** b
    except (OverflowError, ZeroDivisionError):
        return 0.0


_FOLD = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": lambda a, b: a / b if b else 0.0,
    "power": _power,
    "greater": lambda a, b: 1.0 if a > b else 0.0,
    "mix": lambda a, b, f: a + (b - a) * f,
    "clamp": lambda a: min(max(a, 0.0), 1.0),
}


class Program:
    def __init__(self):
        self.nodes = []
        self._known = {}

    def emit(self, node_type, inputs=(), parameters=((), (), ()), texture=data.NONE, name=""):
        """Appends a node, or finds the same one. inputs: Values; a constant among them becomes the node's value k."""
        indices, values = [data.NONE] * 3, [tuple(numbers) + (0.0,) * (4 - len(numbers)) for numbers in parameters]
        for k, value in enumerate(inputs):
            indices[k] = value.node
            if value.is_constant:
                values[k] = value.constant
        key = (node_type, tuple(indices), tuple(values), texture, name)
        if key not in self._known:
            self._known[key] = len(self.nodes)
            self.nodes.append(data.Node(node_type, tuple(indices), tuple(values), texture, name))
        return Value(node=self._known[key])

    def _operate(self, operation, *values):
        if all(value.is_constant for value in values):
            return Value(
                tuple(_FOLD[operation](*numbers) for numbers in zip(*(v.constant for v in values), strict=True))
            )
        return self.emit(operation, values)

    def add(self, a, b):
        if a.is_always(0):
            return b
        return a if b.is_always(0) else self._operate("add", a, b)

    def subtract(self, a, b):
        return a if b.is_always(0) else self._operate("subtract", a, b)

    def multiply(self, a, b):
        if a.is_always(0) or b.is_always(0):
            return ZERO
        if a.is_always(1):
            return b
        return a if b.is_always(1) else self._operate("multiply", a, b)

    def divide(self, a, b):
        if a.is_always(0):
            return ZERO
        return a if b.is_always(1) else self._operate("divide", a, b)

    def power(self, a, b):
        return self._operate("power", a, b)

    def greater(self, a, b):
        return self._operate("greater", a, b)

    def mix(self, a, b, factor):
        if factor.is_always(0) or a == b:
            return a
        return b if factor.is_always(1) else self._operate("mix", a, b, factor)

    def clamp(self, a):
        return self._operate("clamp", a)

    def one_minus(self, a):
        return self.subtract(ONE, a)

    def maximum(self, a, b):
        return self.mix(b, a, self.greater(a, b))

    def minimum(self, a, b):
        return self.mix(a, b, self.greater(a, b))

    def channel(self, a, index):
        """Channel 0 to 3 of a, as a scalar."""
        if a.is_constant:
            return scalar(a.constant[index])
        # The channel stands in value[0], which the slot's own constant would fill: the input is a node here.
        return self.emit("channel", (a,), ((float(index),), (), ()))

    def weighted_sum(self, a, weights):
        """Σ weights[k] · channel k, as a scalar."""
        total = ZERO
        for k, weight in enumerate(weights):
            total = self.add(total, self.multiply(self.channel(a, k), scalar(weight)))
        return total

    def luminance(self, a):
        return self.weighted_sum(a, LUMINANCE)

    def average(self, a):
        return self.weighted_sum(a, (1 / 3, 1 / 3, 1 / 3))

    def combine(self, r, g, b):
        """A colour of three scalars."""
        if r == g == b:
            return r
        total = ZERO
        for value, axis in ((r, (1, 0, 0)), (g, (0, 1, 0)), (b, (0, 0, 1))):
            total = self.add(total, self.multiply(value, color(axis)))
        return total

    def used(self, roots):
        """(nodes that the roots need, in order; new index by old index): folding leaves others behind."""
        needed, stack = set(), [root for root in roots if root != data.NONE]
        while stack:
            index = stack.pop()
            if index not in needed:
                needed.add(index)
                stack.extend(k for k in self.nodes[index].inputs if k != data.NONE)
        order = sorted(needed)
        place = {old: new for new, old in enumerate(order)}
        nodes = []
        for old in order:
            node = self.nodes[old]
            inputs = tuple(place.get(k, data.NONE) for k in node.inputs)
            nodes.append(data.Node(node.type, inputs, node.values, node.texture, node.name))
        place[data.NONE] = data.NONE
        return nodes, place
