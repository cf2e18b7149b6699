"""[clearance] in a job file: what becomes of it, and how it is refused."""

from typing import Any

import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.links_and_joints import Clearance
from slidercrank.optimise.job import Job, parse_job
from slidercrank.optimise.job.problem_of_job import problem_of

SMALL: dict[str, Any] = {
    "name": "Small",
    "mechanism": {"speed": "300 rpm", "slider": {"mass": "2 kg"}},
    "variables": {"crank": "140 mm", "rod": "310 mm", "offset": "60 mm"},
    "objectives": {"peak_torque": "minimise"},
}
LOOSE: dict[str, Any] = {"joint": "crank pin", "radial_clearance": "1 mm", "journal_radius": "10 mm"}


def test_a_job_without_clearance_has_ideal_joints() -> None:
    assert parse_job(SMALL).mechanism.clearance is None


def test_a_clearance_is_read_in_si_and_steel_unless_said_otherwise() -> None:
    assert parse_job(SMALL | {"clearance": LOOSE}).mechanism.clearance == Clearance(
        joint="crank pin", radius=1e-3, journal_radius=0.01
    )
    bronze = {"restitution": 0.8, "friction": 0.1, "elastic_modulus": "110 GPa", "poisson": 0.34}
    given = LOOSE | bronze | {"joint": "slider pin", "law": "lankarani-nikravesh"}
    assert parse_job(SMALL | {"clearance": given}).mechanism.clearance == Clearance(
        joint="slider pin",
        radius=1e-3,
        journal_radius=0.01,
        restitution=0.8,
        friction=0.1,
        law="lankarani-nikravesh",
        elastic_modulus=110e9,
        poisson=0.34,
    )


def test_a_clearance_survives_writing_and_reading() -> None:
    job = Job.model_validate(SMALL | {"clearance": LOOSE})
    assert problem_of(Job.model_validate(job.model_dump(mode="json"))) == problem_of(job)


def test_ideal_joints_are_what_designs_are_sized_with() -> None:
    loose, ideal = parse_job(SMALL | {"clearance": LOOSE}), parse_job(SMALL)
    assert loose.objectives == ideal.objectives
    assert loose.constraints == ideal.constraints


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"joint": "crank pn"}, ["clearance.joint", '"crank pn"', 'did you mean "crank pin"?']),
        ({"radial_clearence": "1 mm"}, ["clearance.radial_clearence: unknown key", "did you mean radial_clearance?"]),
        ({"radial_clearance": "0 mm"}, ["clearance.radial_clearance", "positive", '"0 mm"']),
        ({"radial_clearance": "1 N"}, ["clearance.radial_clearance", "is a force", '"80 mm"']),
        ({"radial_clearance": float("nan")}, ["clearance.radial_clearance", "finite", "nan"]),
        ({"radial_clearance": "1 m"}, ["clearance", "less than the radius of the journal", "check the units"]),
        ({"journal_radius": "-1 mm"}, ["clearance.journal_radius", "positive", '"-1 mm"']),
        ({"restitution": 0.0}, ["clearance.restitution", "above 0 and at most 1", "got 0", "steel"]),
        ({"restitution": 1.5}, ["clearance.restitution", "at most 1", "got 1.5"]),
        ({"friction": -0.1}, ["clearance.friction", "zero or more", "-0.1"]),
        ({"joint": 3}, ["clearance.joint", '"crank pivot", "crank pin" or "slider pin"', "got 3"]),
        ({"law": "hertz"}, ["clearance.law", '"flores" or "lankarani-nikravesh"', '"hertz"']),
        ({"elastic_modulus": "207 mm"}, ["clearance.elastic_modulus", "is a length", '"20 MPa"']),
        ({"poisson": 0.7}, ["clearance.poisson", "0 to 0.5", "got 0.7"]),
    ],
)
def test_a_bad_clearance_is_refused_with_key_rule_value_and_remedy(change: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(JobError) as refused:
        parse_job(SMALL | {"clearance": LOOSE | change})
    for word in words:
        assert word in str(refused.value)


@pytest.mark.parametrize("key", ["joint", "radial_clearance", "journal_radius"])
def test_what_a_clearance_needs_is_asked_for(key: str) -> None:
    with pytest.raises(JobError, match=rf"clearance\.{key}: is missing, but required; for example, add {key} ="):
        parse_job(SMALL | {"clearance": {name: value for name, value in LOOSE.items() if name != key}})
