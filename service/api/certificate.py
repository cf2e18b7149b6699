"""Proven bound on the distance of a job's front from the true one, as in `slidercrank certify`."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Response
from pydantic import BaseModel, Field
from pydantic_core import to_json

from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.formatting import plain_blocks
from ..runs.result import json_ready
from .blocks import AnswerBlock, block_models
from .computing import LongRoute
from .input_parameters import inputs_in_address, parameter_of
from .problem_documents import problem_responses
from .stored_fronts import FrontDep, StoredFront

router = APIRouter(route_class=LongRoute, tags=["fronts"], responses=problem_responses(409))

QUESTION = FRONT_OR_JOB_QUESTIONS["certify"]
CertificateInputs = Annotated[dict[str, Any], inputs_in_address(QUESTION.inputs, map(parameter_of, QUESTION.inputs))]
_EXAMPLE = {"status": "proven", "epsilon_asked": 0.01, "epsilon": 0.0098, "boxes": 41_210, "open_boxes": 0}


class CertificateModel(BaseModel):
    """A proof of how far a front can be from the true one.

    proven: whether that which was asked for is proven. sentences: the proof in words, in metric units. certificate:
    what `slidercrank certify --json` prints. blocks: the sentences as data.
    """

    job: int = Field(examples=[7])
    proven: bool
    sentences: list[str] = Field(examples=[["proven: for every feasible design, one of the 100 designs is worse ..."]])
    certificate: dict[str, Any] = Field(examples=[_EXAMPLE])
    blocks: list[AnswerBlock]


@router.get("/jobs/{number}/certificate", response_model=CertificateModel)
def certify_front(stored_front: FrontDep, given: CertificateInputs) -> Response:
    """Prove how far a front can be from the true one; without designs, that nothing is feasible."""
    name = " ".join(map(repr, given.values()))

    def make() -> tuple[tuple[str], bytes]:
        return (name,), to_json(_certificate_model(stored_front, given))

    return Response(stored_front.cached(name, "certificate", make), media_type="application/json")


def _certificate_model(stored_front: StoredFront, inputs: dict[str, Any]) -> CertificateModel:
    certificate = QUESTION.ask(stored_front.front, inputs)
    sentences = [block.sentence for block in plain_blocks(certificate.blocks)]
    return CertificateModel(
        job=stored_front.job.id,
        proven=certificate.is_satisfied,
        sentences=sentences if stored_front.result.designs else [certificate.message],
        certificate=json_ready({"run": stored_front.result.run} | certificate.record("metric")),
        blocks=block_models(certificate.blocks),
    )
