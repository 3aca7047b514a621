"""The API reference: a page per package, filled from docstrings by mkdocstrings."""

import suchus
from pages.code import BY_MODULE, about, exported, folder_of, home, modules, public, rooms


def pages() -> dict[str, str]:
    """Return every page of the reference by its path."""
    found = {f"api/{room}.md": _room(room) for room in rooms()}
    return {"api/index.md": _index(), **found}


def names(room: str) -> list[str]:
    """Return the dotted names that the page of a room documents."""
    below = modules(room)
    found = [home(room, name) for name in _own(room, below)]
    for module in below:
        path = f"suchus.{room}.{module}"
        found += [path, *(f"{path}.{name}" for name in _of_module(path))]
    return found


def _index() -> str:
    lines = [
        "# API reference",
        "",
        "Everything public, from docstrings. Lengths are in metres, angles in radians; see",
        "[conventions](../conventions.md). Packages stand in alphabetical order; which may import which is stated in",
        "[architecture](../architecture.md).",
        "",
        "| package | what it is good for |",
        "|---|---|",
    ]
    lines += [f"| [`suchus.{room}`]({room}.md) | {about(room)} |" for room in rooms()]
    lines += ["", "## From `import suchus`", "", "These names need no package; they are loaded at their first use.", ""]
    lines += ["| name | from |", "|---|---|"]
    lines += [f"| [`suchus.{name}`][{home}] | `{home}` |" for name, home in top().items()]
    return "\n".join([*lines, ""])


def top() -> dict[str, str]:
    """Return where each name of ``import suchus`` is at home, as a dotted name with an entry in the reference."""
    rooms_of = {name: place.removeprefix("suchus.") for name, place in suchus._HOMES.items()}
    return {name: home(rooms_of[name], name) for name in sorted(rooms_of, key=str.lower)}


def _room(room: str) -> str:
    below = modules(room)
    own = {name: home(room, name) for name in _own(room, below)}
    plain = [name for name, place in own.items() if place == f"suchus.{room}.{name}"]
    lines = _block(f"suchus.{room}", plain, level=1)
    for place in own.values():
        if place not in {f"suchus.{room}.{name}" for name in plain}:
            lines += _block(place, None, level=2)
    for module in below:
        path = f"suchus.{room}.{module}"
        lines += _block(path, _of_module(path), level=2)
    return "\n".join([*lines, ""])


def _block(path: str, members: list[str] | None, level: int) -> list[str]:
    """What mkdocstrings is asked for: a docstring under a heading, then members: those listed, or all for None."""
    asked = [f"::: {path}", "    options:", "      show_root_heading: true", f"      heading_level: {level}"]
    asked += ["      show_root_full_path: true"] if members is not None else []
    asked += ["      members:", *(f"        - {name}" for name in members)] if members else []
    return ["", *asked, *(["      members: []"] if members == [] else [])]


def _of_module(path: str) -> list[str]:
    """Public names of a module; of a folder, what it exports."""
    room = path.partition(".")[2]
    return exported(room) if folder_of(room).is_dir() else public(path)


def _own(room: str, below: list[str]) -> list[str]:
    if not folder_of(room).is_dir():
        return list(dict.fromkeys([*public(f"suchus.{room}"), *exported(room)]))
    return [name for name in exported(room) if name not in below or room in BY_MODULE]
