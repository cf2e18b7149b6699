"""Proof of how far the front of a job can be from the true one, as `slidercrank certify` gives it."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

from fastapi import APIRouter, Response
from pydantic import BaseModel, Field
from pydantic_core import to_json

from ..questions.discovery import WIDER
from ..questions.plain_input import Plain
from ..render.formatting import plain_blocks
from ..runs.result import json_ready
from .blocks import AnswerBlock, answer_blocks
from .computing import LongRoute
from .input_parameters import inputs_in_address, parameter_of
from .problems import problem_responses
from .stored_fronts import FrontDep, StoredFront

router = APIRouter(route_class=LongRoute, tags=["fronts"], responses=problem_responses(409))

LONGEST_PROOF = 20.0
"""s, for the search of a proof."""
QUESTION = WIDER["certify"]
_LIMITED = [
    replace(one, usual="10.0", limits={**one.limits, "le": LONGEST_PROOF})
    if isinstance(one, Plain) and one.name == "seconds"
    else one
    for one in QUESTION.inputs
]
Given = Annotated[dict[str, Any], inputs_in_address(_LIMITED, map(parameter_of, _LIMITED))]
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
def certify_front(found: FrontDep, given: Given) -> Response:
    """Prove how far a front can be from the true one; without designs, that nothing is feasible."""
    name = " ".join(map(repr, given.values()))

    def make() -> tuple[tuple[str], bytes]:
        return (name,), to_json(_proof(found, given))

    return Response(found.made(name, "certificate", make), media_type="application/json")


def _proof(found: StoredFront, given: dict[str, Any]) -> CertificateModel:
    answer = QUESTION.ask(found.front, given)
    sentences = [block.sentence for block in plain_blocks(answer.blocks)]
    return CertificateModel(
        job=found.job.id,
        proven=answer.met,
        sentences=sentences if found.result.designs else [answer.message],
        certificate=json_ready({"run": found.result.run} | answer.record("metric")),
        blocks=answer_blocks(answer.blocks),
    )
