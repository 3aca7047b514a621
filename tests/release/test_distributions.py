"""What is asked of the wheel and the sdist that `make release` builds."""

import tarfile
import zipfile

import pytest

from release import distributions

SOURCES = {"src/suchus/__init__.py", "src/suchus/verdict/claims.json"}


@pytest.fixture
def built(tmp_path):
    def build(inside, packed):
        wheel, sdist = tmp_path / "suchus-1-py3-none-any.whl", tmp_path / "suchus-1.tar.gz"
        with zipfile.ZipFile(wheel, "w") as opened:
            for name in [*inside, "suchus-1.dist-info/METADATA"]:
                opened.writestr(name, "")
        with tarfile.open(sdist, "w:gz") as opened:
            for name in packed:
                opened.addfile(tarfile.TarInfo(f"suchus-1/{name}"))
        return distributions.differences(wheel, sdist, SOURCES)

    return build


WHOLE = ["suchus/__init__.py", "suchus/verdict/claims.json"]
BESIDE = ["pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md"]


def test_whole_distributions_differ_in_nothing(built):
    assert built(WHOLE, [*SOURCES, *BESIDE]) == []


def test_a_file_too_few_or_too_many_is_told(built):
    assert built(WHOLE[:1], [*SOURCES, *BESIDE]) == ["suchus-1-py3-none-any.whl lacks src/suchus/verdict/claims.json"]
    assert "which git does not know" in built([*WHOLE, "suchus/secret.txt"], [*SOURCES, *BESIDE])[0]
    assert built(WHOLE, [*SOURCES, *BESIDE[:-1]]) == ["suchus-1.tar.gz lacks CHANGELOG.md"]


def test_the_package_holds_its_templates_and_the_table_of_claims():
    tracked = distributions.tracked()
    assert {"src/suchus/verdict/claims.json", "src/suchus/py.typed", "src/suchus/replay/templates/player.js"} <= tracked
