"""Proof of how far the front of a job can be from the true one, as `slidercrank certify` gives it."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Response
from pydantic import BaseModel, Field
from pydantic_core import to_json

from ..designs.proof import certificate_record, infeasible_record, sentences_of, sizes_of
from ..runs.result import json_ready, rows_of
from .computing import LongRoute
from .problems import problem_responses
from .stored_fronts import FrontDep, StoredFront

router = APIRouter(route_class=LongRoute, tags=["fronts"], responses=problem_responses(409))

LONGEST_PROOF = 20.0
"""s, for the search of a proof."""

_EXAMPLE = {"status": "proven", "epsilon_asked": 0.01, "epsilon": 0.0098, "boxes": 41_210, "open_boxes": 0}


class CertificateModel(BaseModel):
    """A proof of how far a front can be from the true one.

    proven: whether that which was asked for is proven. sentences: the proof in words, in metric units. certificate:
    what `slidercrank certify --json` prints.
    """

    job: int = Field(examples=[7])
    proven: bool
    sentences: list[str] = Field(examples=[["proven: for every feasible design, one of the 100 designs is worse ..."]])
    certificate: dict[str, Any] = Field(examples=[_EXAMPLE])


@router.get("/jobs/{number}/certificate", response_model=CertificateModel)
def certify_front(
    found: FrontDep,
    epsilon: Annotated[
        float, Query(gt=0.0, lt=1.0, description="distance to be proven, as a share of each objective's range")
    ] = 0.01,
    seconds: Annotated[
        float, Query(gt=0.0, le=LONGEST_PROOF, description="stop after so long with what is proven by then")
    ] = 10.0,
) -> Response:
    """Prove how far a front can be from the true one; without designs, that nothing is feasible."""
    name = f"{epsilon!r} {seconds!r}"

    def make() -> tuple[tuple[str], bytes]:
        return (name,), to_json(_proof(found, epsilon, seconds))

    return Response(found.made(name, "certificate", make), media_type="application/json")


def _proof(found: StoredFront, epsilon: float, seconds: float) -> CertificateModel:
    result, problem, job = found.result, found.problem, found.job.id
    if not result.designs:
        from ...optimise.certificate.infeasible import prove_infeasible

        proven = prove_infeasible(problem, seconds=seconds)
        record = infeasible_record(result, proven=proven)
        return CertificateModel(job=job, proven=proven, sentences=[record["message"]], certificate=record)
    from ...optimise.certificate.certify import certify_designs

    proof = certify_designs(problem, sizes_of(result), epsilon=epsilon, seconds=seconds)
    rows = rows_of(proof.table.to_dict("list")) if len(proof.table) else []
    record = json_ready(certificate_record(proof, problem, result.run, rows))
    return CertificateModel(job=job, proven=proof.proven, sentences=sentences_of(proof, result), certificate=record)
