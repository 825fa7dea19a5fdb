"""From which commit, versions and processor results are."""

import json
import platform
from importlib.metadata import PackageNotFoundError
from pathlib import Path
from types import SimpleNamespace

import pytest

from compare.run import provenance


@pytest.fixture
def installed(monkeypatch, tmp_path):
    """The project without a repository; return what says how its distribution was installed."""
    monkeypatch.setattr(provenance, "ROOT", tmp_path)

    def as_said(content):
        monkeypatch.setattr(
            provenance, "distribution", lambda _: SimpleNamespace(read_text=lambda _: content)
        )

    return as_said


def test_an_installed_project_has_the_commit_that_it_was_installed_from(installed):
    installed(json.dumps({"vcs_info": {"commit_id": "abc"}}))
    assert provenance.commit() == "abc"
    installed(None)  # from a package registry
    assert provenance.commit() == ""


def test_without_distribution_or_git_the_commit_is_not_known(installed, monkeypatch, tmp_path):
    def missing(_):
        raise PackageNotFoundError

    monkeypatch.setattr(provenance, "distribution", missing)
    assert provenance.commit() == ""
    (tmp_path / ".git").touch()
    monkeypatch.setenv("PATH", "")
    assert provenance.commit() == ""


def test_an_engine_has_its_own_version_or_that_of_where_its_code_is_from():
    assert provenance.engine_version("exudyn-native", "exudyn", "") == provenance.version_of("exudyn")
    assert provenance.engine_version("mine", "", "1.2") == "1.2"
    assert provenance.engine_version("mine", "", "") == ""


def test_a_processor_without_a_name_is_told_by_its_kind(monkeypatch):
    def missing(*_, **__):
        raise FileNotFoundError

    monkeypatch.setattr(Path, "read_text", missing)
    assert provenance.processor() == (platform.processor() or platform.machine())
