"""Commit, versions and processor of results."""

import json
import platform
import subprocess
import sys
from importlib.metadata import PackageNotFoundError
from pathlib import Path
from types import SimpleNamespace

import pytest
from processes import environment

from compare.run import provenance


@pytest.fixture
def installed(monkeypatch, tmp_path):
    """The project without a repository; return a function that sets the record of its installation."""
    monkeypatch.setattr(provenance, "ROOT", tmp_path)

    def as_said(content):
        monkeypatch.setattr(
            provenance, "distribution", lambda _: SimpleNamespace(read_text=lambda _: content)
        )

    return as_said


def test_a_project_without_repository_has_the_commit_that_it_was_installed_from(
    installed, monkeypatch, tmp_path
):
    installed(json.dumps({"vcs_info": {"commit_id": "abc"}}))
    assert provenance.commit() == "abc"
    installed(None)  # from a package registry
    assert provenance.commit() == ""

    def missing(_):
        raise PackageNotFoundError

    monkeypatch.setattr(provenance, "distribution", missing)
    assert provenance.commit() == ""
    (tmp_path / ".git").touch()
    monkeypatch.setenv("PATH", "")
    assert provenance.commit() == ""  # without git


def test_an_engine_has_its_own_version_or_that_of_its_distribution():
    assert provenance.engine_version("exudyn-native", "exudyn", "") == provenance.version_of("exudyn")
    assert provenance.engine_version("mine", "", "1.2") == "1.2"
    assert provenance.engine_version("mine", "", "") == ""


def test_a_processor_without_a_name_is_reported_by_its_architecture(monkeypatch):
    def missing(*_, **__):
        raise FileNotFoundError

    monkeypatch.setattr(Path, "read_text", missing)
    assert provenance.processor() == (platform.processor() or platform.machine())


@pytest.mark.parametrize(("first", "settings"), [("compare.engines", "off"), ("exudyn", "on")])
def test_a_users_settings_of_exudyn_are_off_and_reports_state_it(first, settings, tmp_path):
    (tmp_path / "config.json").write_text('{"version": 1, "config": {"suppressWarnings": true}}')
    code = (
        "if __name__ == '__main__':\n"  # not in the worker
        f"    import {first}, exudyn\n"
        "    from compare.run.provenance import exudyn_user_settings\n"
        "    from compare.run.workers import Workers\n"
        "    from exudyn.misc.overrideSettings import Applied\n"
        "    with Workers() as workers:\n"
        "        print(bool(Applied()), workers.ask(Applied), exudyn_user_settings())\n"
    )
    (tmp_path / "script.py").write_text(code)
    variables = environment(EXUDYN_CONFIG_FILE=str(tmp_path / "config.json"))
    del variables["EXUDYN_NO_USER_SETTINGS"]
    command = [sys.executable, str(tmp_path / "script.py")]
    done = subprocess.run(command, env=variables, capture_output=True, text=True)
    expected = f"{settings == 'on'} [] {settings}\n"
    assert done.stdout.endswith(expected), done.stdout + done.stderr


def test_lines_of_the_source_have_addresses_in_the_repository(monkeypatch):
    addresses = {"Project-URL": ["Exudyn, https://a.example/exudyn", "Repository, https://b.example/discs/"]}
    monkeypatch.setattr(provenance, "commit", lambda: "0123abc-dirty")
    monkeypatch.setattr(provenance, "metadata", lambda name: SimpleNamespace(get_all=addresses.get))
    assert provenance.address_of("compare/a.py", 7) == "https://b.example/discs/blob/0123abc/compare/a.py#L7"
    addresses["Project-URL"].pop()
    assert provenance.address_of("compare/a.py", 7) == ""
