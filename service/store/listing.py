"""Sort orders for a list of jobs, each with paging."""

from typing import Any, Literal, get_args

from sqlalchemy import Select, and_, case, func, or_, select

from .records import DECISION, State
from .schema import jobs

Order = Literal["newest", "oldest", "name", "state", "decided"]
"""Order of a list of jobs. state: waiting and running jobs first. decided: jobs with a decision first."""

_KEYS: dict[Order, Any] = {
    "oldest": jobs.c.id,
    "name": func.lower(jobs.c.name),
    "state": case({state: place for place, state in enumerate(get_args(State))}, value=jobs.c.state),
    "decided": case((DECISION.is_(None), 1), else_=0),
}


def ordered_jobs(query: Select[Any], order: Order, before: int | None) -> Select[Any]:
    """Return a query for jobs in an order; jobs with equal keys are sorted newest first.

    before: number of a job; only jobs after it in this order, for paging. None for all.
    """
    key = _KEYS.get(order)
    if key is None:
        ordered = query.order_by(jobs.c.id.desc())
        return ordered if before is None else ordered.where(jobs.c.id < before)
    ordered = query.order_by(key, jobs.c.id.desc())
    if before is None:
        return ordered
    last = select(key).where(jobs.c.id == before).correlate(None).scalar_subquery()
    return ordered.where(or_(key > last, and_(key == last, jobs.c.id < before)))
