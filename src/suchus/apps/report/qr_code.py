"""QR codes of addresses, after ISO/IEC 18004: a picture for a page, and characters for a terminal.

The package segno computes them. It is the extra ``lessons``; without it there is no code, and an address is typed.
"""

from itertools import zip_longest
from typing import Any

from markupsafe import Markup

_BORDER = 4
"""Width of the light border that a reader needs [modules]."""
_HALF_BLOCKS = {(True, True): "█", (True, False): "▀", (False, True): "▄", (False, False): " "}
"""Character for two modules, the upper and the lower, True where dark."""


def qr_picture(address: str) -> Markup:
    """Return the code of an address as an SVG element without a size; empty without segno or without an address."""
    code = _make_code(address)
    if code is None:
        return Markup()
    return Markup(
        code.svg_inline(border=_BORDER, omitsize=True, dark="#000", light="#fff", svgclass="code", lineclass=None,
                        title=f"QR code of {address}")
    )  # fmt: skip


def qr_text(address: str) -> str:
    """Return the code of an address in characters, two modules in each; empty without segno or without an address.

    It is read where the characters are dark on a light ground.
    """
    code = _make_code(address)
    if code is None:
        return ""
    rows = [[bool(module) for module in row] for row in code.matrix_iter(border=_BORDER)]
    pairs = zip_longest(rows[::2], rows[1::2], fillvalue=[False] * len(rows[0]))
    return "\n".join("".join(_HALF_BLOCKS[pair] for pair in zip(*pair_of_rows, strict=True)) for pair_of_rows in pairs)


def _make_code(address: str) -> Any:
    """Return segno's code of an address; None without segno or without an address."""
    try:
        import segno  # noqa: PLC0415  an optional extra, needed here only
    except ModuleNotFoundError:
        return None
    return segno.make(address, error="m", micro=False) if address else None
