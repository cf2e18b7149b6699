"""Workers of a store and the time of each one's last heartbeat."""

from sqlalchemy import delete, exists, func, insert, not_, or_, select, update

from .database import Database
from .database_clock import now
from .queue import ENDED_LEASE, LEFT
from .records import Crew, Worker
from .schema import jobs, workers

_FORGOTTEN = 7 * 86_400.0  # s


class Workers(Database):
    """Database with its table of workers."""

    def register(self, worker: str) -> None:
        """Record a worker as present; delete those without a heartbeat for days."""
        with self.writing() as connection:
            sign_of_life = update(workers).where(workers.c.id == worker).values(seen=now())
            if not connection.execute(sign_of_life).rowcount:
                connection.execute(delete(workers).where(workers.c.seen < now() - _FORGOTTEN))
                connection.execute(insert(workers).values(id=worker, started=now(), seen=now()))

    def unregister(self, worker: str) -> None:
        """Record the departure of a worker."""
        with self.writing() as connection:
            connection.execute(delete(workers).where(workers.c.id == worker))

    def has_waiting_jobs(self) -> bool:
        """Whether a job waits for a worker, even if it is not due or cannot be claimed yet."""
        query = select(jobs.c.id).where(or_(jobs.c.state == "queued", LEFT)).limit(1)
        with self.reading() as connection:
            return connection.execute(query).first() is not None

    def count_workers_and_waiting_jobs(self) -> Crew:
        """Return the number of workers with a recent heartbeat, and the number of jobs that wait for one."""
        busy = [worker.busy for worker in self.workers() if worker.at_work]
        with self.reading() as connection:
            waiting = connection.scalar(select(func.count()).where(jobs.c.state == "queued")) or 0
        return Crew(workers=len(busy), busy=sum(busy), waiting=waiting)

    def count_present_workers(self) -> int:
        """Return the number of workers with a recent heartbeat, busy or not."""
        return sum(worker.at_work for worker in self.workers())

    def workers(self) -> list[Worker]:
        """Return all workers that have not left, the most recent heartbeat first.

        A heartbeat in the future, from before the clock was set back, counts as equally far in the past.
        """
        silent = func.abs(now() - workers.c.seen).label("silent")
        has_job = exists().where(jobs.c.worker == workers.c.id, jobs.c.state == "running", not_(ENDED_LEASE))
        query = select(*workers.c, silent, has_job.label("busy")).order_by(silent)
        with self.reading() as connection:
            return [Worker(**row._mapping) for row in connection.execute(query)]
