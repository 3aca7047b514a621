"""Wheel and sdist: built from the checkout, and what is in them."""

import hashlib
import re
import tarfile
import tomllib
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from release.environment import PINNED, ROOT, Environment, Failed, clean, run

PACKAGE = "src/suchus"
ENGINE = f"{PACKAGE}/apps/laboratory/engine"
"""Folder of the engine of ``suchus page``, which is fetched by its digest and not committed."""
_SAID = {
    "pyproject.toml": r'^version = "([^"]+)"',
    "CHANGELOG.md": r"^## (\d\S*) \(\d{4}-\d\d-\d\d\)$",  # the latest stands first
    "CITATION.cff": r"^version: (\S+)$",
}
_BESIDE = ("pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md")


def project() -> dict[str, Any]:
    """Return what pyproject.toml says of the project."""
    found: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return found


def tags(checkout: Path = ROOT) -> list[str]:
    """Return the tags of versions, ``v`` and a number, that what is checked out carries."""
    return run(["git", "tag", "--points-at", "HEAD", "--list", "v[0-9]*"], cwd=checkout).split()


def versions(checkout: Path = ROOT) -> dict[str, str]:
    """Return the version that each file says which has one; empty where it says none."""
    found = {}
    for name, pattern in _SAID.items():
        said = re.search(pattern, (checkout / name).read_text(encoding="utf-8"), re.M)
        found[name] = said[1] if said else ""
    return found


def disagreement(versions: Mapping[str, str], tags: Sequence[str]) -> str:
    """Return in a sentence that files or tags of a commit say another version than pyproject.toml, or nothing.

    Args:
        versions: what each file says, see ``versions``.
        tags: those of the commit; none where it has none.
    """
    version = versions["pyproject.toml"]
    other = [f"{name} says {said or 'none'}" for name, said in versions.items() if said != version]
    other += [f"this commit has the tag {tag}" for tag in tags if tag != f"v{version}"]
    if not other:
        return ""
    return (
        f"pyproject.toml says version {version}, but {', '.join(other)}: one commit has one version. Say the same in "
        f"{', '.join(versions)}, and tag the commit with `make tag`, or remove a wrong tag with `git tag --delete`."
    )


def tag(version: str, checkout: Path = ROOT) -> str:
    """Tag the commit that is checked out, with what the changelog says of the version, and return the tag.

    Raises:
        Failed: another commit has the tag, what is checked out is not what was committed, or the changelog has lines
            that belong to no version yet.
    """
    name, parts = (
        f"v{version}",
        re.split(r"^## (.*)$", (checkout / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.M),
    )
    said = {title.split()[0]: text.strip() for title, text in zip(parts[1::2], parts[2::2], strict=True)}
    if run(["git", "tag", "--list", name], cwd=checkout).strip():
        where = run(["git", "rev-list", "-1", "--abbrev-commit", name], cwd=checkout).strip()
        raise Failed(f"the tag {name} is that of commit {where}; a version is released once: say the next one.")
    if said.get("Unreleased"):
        raise Failed(
            f"CHANGELOG.md has lines under Unreleased, which would belong to no version: put them into a section of "
            f"{version}, or of the next one."
        )
    if run(["git", "status", "--porcelain"], cwd=checkout).strip():
        raise Failed("what is checked out is not what was committed: commit it first.")
    run(
        ["git", "tag", "--annotate", "--cleanup=verbatim", "-m", f"suchus {version}\n\n{said[version]}\n", name],
        cwd=checkout,
    )
    return name


def build(tools: Environment, folder: Path, checkout: Path = ROOT) -> tuple[Path, Path | None]:
    """Build into a folder, and return wheel and sdist.

    The wheel is made from the sdist. Where the package ``build`` is not to be had, pip makes the wheel alone.
    What builds is pinned, with digests.
    """
    folder.mkdir(exist_ok=True)
    for old in [*folder.glob("suchus-*.whl"), *folder.glob("suchus-*.tar.gz")]:
        old.unlink()
    if tools.pip_if_served("build"):  # the build back end runs in an environment of its own, which pip makes
        pinned = clean() | {"PIP_CONSTRAINT": PINNED.as_uri()}  # pip takes a path with a space for two
        run([tools.bin / "python", "-m", "build", "--outdir", folder, checkout], cwd=folder, env=pinned)
    else:
        print("The package build is not to be had: pip builds the wheel, and there is no sdist.")
        words = ["wheel", "--no-deps", "--build-constraint", PINNED, "--wheel-dir", folder, checkout]
        run([tools.bin / "python", "-m", "pip", *words], cwd=folder)
    (wheel,) = folder.glob("suchus-*.whl")
    return wheel, next(iter(folder.glob("suchus-*.tar.gz")), None)


def digests(*files: Path | None) -> dict[str, str]:
    """Return the SHA-256 of each file by its name; None stands for one that was not built."""
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in files if file is not None}


def unlike(first: Mapping[str, str], second: Mapping[str, str]) -> str:
    """Return in a sentence which of two builds' files differ, or nothing.

    Args:
        first: digests of the files of a build, by name.
        second: those of another build of the same commit.
    """
    names = [name for name in dict.fromkeys((*first, *second)) if first.get(name) != second.get(name)]
    return (
        f"two builds of one commit differ in {', '.join(names)}; nobody could check what is published." if names else ""
    )


def tracked() -> set[str]:
    """Return the files of the package that git knows, and the engine of the page, with paths from the checkout."""
    engine = {f"{ENGINE}/{file.name}" for file in (ROOT / ENGINE).glob("mujoco.*")}
    return set(run(["git", "ls-files", PACKAGE], cwd=ROOT).splitlines()) | engine


def differences(wheel: Path, sdist: Path | None, sources: set[str]) -> list[str]:
    """Return in sentences where the distributions hold other files than the sources.

    Args:
        wheel: to look into.
        sdist: to look into, if there is one.
        sources: paths that belong to the package, with ``src/`` before it.
    """
    with zipfile.ZipFile(wheel) as opened:
        inside = {f"src/{name}" for name in opened.namelist() if name.startswith("suchus/") and not name.endswith("/")}
    said = [f"{wheel.name} lacks {name}" for name in sorted(sources - inside)]
    said += [f"{wheel.name} holds {name}, which git does not know" for name in sorted(inside - sources)]
    if sdist is not None:
        with tarfile.open(sdist) as packed:
            names = {name.partition("/")[2] for name in packed.getnames()}
        said += [f"{sdist.name} lacks {name}" for name in sorted((sources | set(_BESIDE)) - names)]
    return said
