# SPDX-License-Identifier: Apache-2.0
"""What sockets of shader nodes hold."""


def linked_node(socket):
    """The node that a socket gets its value from, reroutes passed; None where it has a value of its own."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def value_of(node, name):
    """A socket's own value: a number or a tuple."""
    value = node.inputs[name].default_value
    return tuple(value) if hasattr(value, "__len__") else value
