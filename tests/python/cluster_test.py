"""A sweep on a Ray cluster leaves the files of a sweep on one machine, byte for byte."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import PROGRAM, QUICK_TRIALS

from pirouette.cluster.driver import (
    NO_RAY,
    Study,
    import_ray,
    keep,
    known_results,
    merge,
    open_results,
    run,
    unfinished,
)
from pirouette.cluster.shard import Work, run_shard
from pirouette.errors import Error

EXPERIMENT = f"""
seeds = [1, 2, 3]
{QUICK_TRIALS}
[[rows]]
label = "one"
controller = "asc"
[[axes]]
key = "plant.friction"
values = [0.6, 0.8]
[trace]
plant.friction = 0.8
"""
RANDOM = f"""
trials = 5
{QUICK_TRIALS}
[random]
plant.friction = {{uniform = [0.4, 1.0]}}
[[rows]]
label = "one"
controller = "asc"
"""


def files(folder: Path) -> dict[str, bytes]:
    """What a reader looks at: tables and traces."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.suffix != ".jsonl"
    }


@pytest.fixture(scope="module")
def experiment(tmp_path_factory):
    folder = tmp_path_factory.mktemp("experiment")
    (folder / "tiny.toml").write_text(EXPERIMENT)
    (folder / "random.toml").write_text(RANDOM)
    for name in ("tiny", "random"):
        subprocess.run(
            [PROGRAM, "sweep", f"{name}.toml", "--out", f"{name}-alone"],
            cwd=folder,
            check=True,
            capture_output=True,
        )
    return folder


@pytest.fixture
def program(monkeypatch):
    monkeypatch.setenv("PIROUETTE", str(PROGRAM))


@pytest.fixture
def ray():
    return pytest.importorskip("ray", reason="ray is optional")


@pytest.mark.parametrize("name", ["tiny", "random"])
def test_the_cluster_leaves_the_same_files(ray, program, experiment, tmp_path, name):
    study = Study(experiment / f"{name}.toml", tmp_path / "out")
    assert run(study, "local", 4) == 0
    assert files(study.out) == files(experiment / f"{name}-alone")


def test_what_is_finished_does_not_run_again(ray, program, experiment, tmp_path, capfd):
    study = Study(experiment / "tiny.toml", tmp_path / "out")
    log = known_results(experiment / "tiny-alone").splitlines(keepends=True)
    study.out.mkdir()
    (study.out / "results-1of2.jsonl").write_bytes(b"".join(log[:3]) + log[3][:20])
    assert run(study, "local", None) == 0
    assert files(study.out) == files(experiment / "tiny-alone")
    assert "tasks" in capfd.readouterr().err
    assert run(study, "local", None) == 0  # nothing is left: Ray is not even started
    assert "tasks" not in capfd.readouterr().err


def test_damaged_results_run_again(program, experiment, tmp_path, capfd):
    study = Study(experiment / "tiny.toml", tmp_path / "out")
    log = known_results(experiment / "tiny-alone").splitlines(keepends=True)
    shutil.copytree(experiment / "tiny-alone" / "traces", study.out / "traces")
    damaged = [log[0].replace(b'"fell":0.0', b'"fell":1.0'), b"\xff\xfe\n", *log[2:], log[1][:9]]
    (study.out / "results-ray.jsonl").write_bytes(b"".join(damaged))
    assert unfinished(str(PROGRAM), study) == 2
    work = Work(
        program=str(PROGRAM),
        version=subprocess.check_output([PROGRAM, "--version"], text=True).strip(),
        verb="sweep",
        name="tiny.toml",
        text=EXPERIMENT,
        options=(),
        folder=str(tmp_path),
        environment={},
        known=known_results(study.out),
    )
    finished = run_shard(work, 1, 1)
    assert finished.error == ""
    assert sorted(finished.results.splitlines(keepends=True)) == sorted(log[:2])
    with open_results(study.out) as results:
        keep(finished, study.out, results)
    assert merge(str(PROGRAM), study) == 0
    assert files(study.out) == files(experiment / "tiny-alone")
    said = capfd.readouterr().err
    assert "results-ray.jsonl:1: is damaged or edited: its checksum does not fit; left out" in said
    assert "results-ray.jsonl:2: is no whole line of JSON; left out" in said


def test_a_node_with_another_program_is_refused(ray, program, experiment, tmp_path, monkeypatch):
    monkeypatch.setattr("pirouette.cluster.driver.ask", lambda *words: fake_answer(words))
    with pytest.raises(Error, match=r"is pirouette .*; allowed: pirouette 0\.0"):
        run(Study(experiment / "tiny.toml", tmp_path / "out"), "local", 1)


def fake_answer(words: tuple) -> str:
    return "pirouette 0.0" if "--version" in words else "0 of 6 trials"


def test_a_wrong_experiment_is_refused_as_by_the_program(program, tmp_path):
    (tmp_path / "wrong.toml").write_text(EXPERIMENT.replace("asc", "acs"))
    with pytest.raises(Error, match=r'wrong.toml:7: controller: given "acs"'):
        run(Study(tmp_path / "wrong.toml", tmp_path / "out"), "local", None)


@pytest.mark.parametrize("address", ["127.0.0.1:1", "127.0.0.1:port", "here"])
def test_an_address_where_nobody_answers_is_refused_at_once(program, experiment, tmp_path, address):
    study = Study(experiment / "tiny.toml", tmp_path / "out")
    with pytest.raises(Error, match=f"--address: given '{address}'"):
        run(study, address, None)


def test_without_ray_one_line_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(Error) as raised:
        import_ray()
    assert str(raised.value) == NO_RAY


def test_the_command_line_names_a_wrong_option(call, experiment):
    refused = call("cluster", experiment / "tiny.toml", "--tasks", 0)
    assert refused.returncode == 2
    assert "--tasks: given 0; allowed: a whole number from 1 on" in refused.stderr
