"""The release: one version, a citation, tested version ranges, and all files in wheel and source archive."""

import json
import re
import runpy
import subprocess
import tomllib
from pathlib import Path

import pytest
import yaml

import reference_model

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = ("reference_model", "exudyn_models", "fmu_models", "compare")


def tracked():
    if not (ROOT / ".git").exists():
        pytest.skip("this is no checkout")
    out = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, encoding="utf-8"
    )
    return [Path(name) for name in out.stdout.split("\0") if name and (ROOT / name).exists()]


@pytest.fixture(scope="module")
def release():
    return runpy.run_path(str(ROOT / "builders" / "release.py"))


def test_a_wheel_or_archive_that_lacks_a_file_or_has_one_too_many_is_noticed(release):
    files = {"compare/a.py", "compare/page.html", "docs/b.png", ".ci/run"}
    complaints = release["complaints_of_wheel"](
        ["compare/a.py", "compare/c.py", "x-1.dist-info/METADATA"], files
    )
    assert complaints == ["the wheel lacks compare/page.html", "the wheel has compare/c.py"]
    complaints = release["complaints_of_archive"](
        ["x-1/compare/a.py", "x-1/compare/page.html", "x-1/PKG-INFO"], files
    )
    assert complaints == ["the source archive lacks docs/b.png"]


def lower_ends(requirements):
    """Return the lower end of each range by the name of the library, "numpy>=1.25" giving 1.25."""
    return dict(re.fullmatch(r"([\w-]+)>=([\w.]+)", each).groups() for each in requirements)


def short(version):
    return re.sub(r"(\.0)+$", "", version)


def test_citation_archive_and_changelog_agree_on_the_version_and_on_its_description():
    assert "version" not in PROJECT["project"]
    assert PROJECT["tool"]["setuptools"]["dynamic"]["version"]["attr"] == "reference_model.__version__"
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    archive = json.loads((ROOT / ".zenodo.json").read_text(encoding="utf-8"))
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    latest = re.search(r"^## (\S+)$", changelog, re.MULTILINE)[1]
    assert citation["version"] == archive["version"] == latest == reference_model.__version__
    for name in ("title", "license", "keywords"):
        assert citation[name] == archive[name]
    assert citation["authors"] == archive["creators"] == PROJECT["project"]["authors"]
    assert citation["abstract"] == archive["description"]


def test_classifiers_name_only_the_system_that_the_workflow_tests():
    workflow = yaml.safe_load((ROOT / ".github" / "workflows" / "test.yml").read_text(encoding="utf-8"))
    assert {job["runs-on"] for job in workflow["jobs"].values()} == {"ubuntu-latest"}
    systems = [each for each in PROJECT["project"]["classifiers"] if each.startswith("Operating System")]
    assert systems == ["Operating System :: POSIX :: Linux"]


def test_the_oldest_versions_are_the_lower_ends_of_the_ranges():
    project = PROJECT["project"]
    ranges = lower_ends([*project["dependencies"], *project["optional-dependencies"]["sweep"]])
    lines = (ROOT / "tests" / "oldest.txt").read_text(encoding="utf-8").splitlines()
    oldest = dict(line.split("==") for line in lines if not line.startswith("#"))
    assert {name: short(each) for name, each in oldest.items()} == {
        name: short(each) for name, each in ranges.items()
    }


def test_the_wheel_has_every_file_of_the_packages():
    data = PROJECT["tool"]["setuptools"]["package-data"]
    files = [path for path in tracked() if path.parts[0] in PACKAGES and path.suffix != ".py"]
    assert len(files) > 40
    for path in files:
        inside = path.relative_to(path.parts[0])
        assert any(inside in found(path.parts[0], pattern) for pattern in data[path.parts[0]]), path


def found(package, pattern):
    return {path.relative_to(ROOT / package) for path in (ROOT / package).glob(pattern)}


def test_the_source_archive_has_every_file_except_those_of_the_repository():
    """Packages, pyproject, README and licence are included automatically, the rest by ``MANIFEST.in``."""
    lines = (ROOT / "MANIFEST.in").read_text(encoding="utf-8").splitlines()
    named = {name for line in lines for name in line.split()[1:]}
    by_itself = {*PACKAGES, "pyproject.toml", "README.md", "LICENSE", "MANIFEST.in"}
    for path in tracked():
        assert path.parts[0] in named | by_itself or path.parts[0].startswith("."), path
