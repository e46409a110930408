"""Nodes back to text, numbers with the six digits that OpenSCAD gives them."""

from .text import Node


def printed(top: list[Node]) -> str:
    """The text of a file."""
    return "".join(_node(node, 0) for node in top)


def _node(node: Node, depth: int) -> str:
    indent = "\t" * depth
    arguments = [_value(v) for v in node.given] + [f"{name} = {_value(v)}" for name, v in node.named.items()]
    head = f"{indent}{node.modifiers}{node.name}({', '.join(arguments)})"
    if not node.children:
        return head + ";\n"
    return head + " {\n" + "".join(_node(child, depth + 1) for child in node.children) + indent + "}\n"


def _value(value) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return "undef" if value is None else f"{value:g}"
