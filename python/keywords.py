"""Writes package/vodca/_keywords.py from the table of parameters, which also makes docs/PARAMETERS.md: `python keywords.py`."""

import pathlib

import vodca

FILE = pathlib.Path(__file__).parent / "package" / "vodca" / "_keywords.py"


def text() -> str:
    """The file as it should be."""
    lines = ['"""Made by keywords.py; do not edit."""', "", "from typing import Literal, TypedDict", "", ""]
    lines += ["class Parameters(TypedDict, total=False):", '    """Every parameter as a keyword."""', ""]
    for parameter in vodca.parameters():
        kind = type(parameter.value).__name__
        if kind == "str":
            kind = f"Literal[{', '.join(repr(word) for word in parameter.allowed.split(', '))}]".replace("'", '"')
        unit = "" if parameter.unit == "-" else f", {parameter.unit}"
        lines += [f"    {parameter.key.replace('.', '_')}: {kind}", f'    """{parameter.effect} ({parameter.allowed}{unit})."""']
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    FILE.write_text(text())
