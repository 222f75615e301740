# SPDX-License-Identifier: MIT
"""Runs many missions at a time: in processes of this machine, or on a Dask cluster; a dead worker costs nothing."""

from __future__ import annotations

import importlib
import multiprocessing
import signal
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any, Final

from hil_sim.bench.plan import parse_id
from hil_sim.bench.work import Record, failed, work
from hil_sim.errors import LinkError, SimError

AHEAD: Final = 4
"""Missions handed out for each worker: enough that none waits for the next."""
CONNECT_S = 10.0
_END_S: Final = 5.0
_LIVES: Final = 2
"""A mission that was running each time so many workers died is taken to have killed them."""
_CLUSTER_LIVES: Final = 100

Work = Callable[[str], Record]
Fail = Callable[[str, str], Record]
"""Makes the record of a mission that has none, from its id and the reason."""


def _failed(case_id: str, reason: str) -> Record:
    return failed(parse_id(case_id), reason)


def _ignore_interrupt() -> None:
    # Ctrl-C goes to the whole group; the parent ends its workers when it has written what is done.
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def run_here(ids: Sequence[str], jobs: int, run: Work = work, fail: Fail = _failed) -> Iterator[Record]:
    """Yield the record of each id as it comes, from `jobs` processes; in this process when that is 1."""
    if jobs <= 1:
        yield from map(run, ids)
        return
    waiting, deaths = deque(ids), dict.fromkeys(ids, 0)
    while waiting:
        # After a death one at a time until the culprit is known, so that no other mission is blamed.
        suspects = [name for name in waiting if deaths[name]]
        if suspects:
            for name in suspects:
                waiting.remove(name)
            yield from _alone(suspects, deaths, waiting, (run, fail))
        else:
            yield from _together(waiting, jobs, deaths, run)


def _pool(jobs: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"), _ignore_interrupt)


def _together(waiting: deque[str], jobs: int, deaths: dict[str, int], run: Work) -> Iterator[Record]:
    pool = _pool(jobs)
    running: dict[Future[Record], str] = {}
    try:
        while waiting or running:
            while waiting and len(running) < AHEAD * jobs:
                name = waiting.popleft()
                running[pool.submit(run, name)] = name
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                record = future.result()
                del running[future]
                yield record
    except BrokenProcessPool:
        for name in running.values():
            deaths[name] += 1
            waiting.append(name)
    finally:
        _end(pool)


def _alone(
    suspects: list[str], deaths: dict[str, int], waiting: deque[str], how: tuple[Work, Fail]
) -> Iterator[Record]:
    run, fail = how
    while suspects:
        pool = _pool(1)
        try:
            while suspects:
                record = pool.submit(run, suspects[0]).result()
                suspects.pop(0)
                yield record
        except BrokenProcessPool:
            name = suspects.pop(0)
            deaths[name] += 1
            if deaths[name] >= _LIVES:
                yield fail(name, "the process that ran it died")
            else:
                waiting.append(name)
        finally:
            _end(pool)


def _end(pool: ProcessPoolExecutor) -> None:
    """End the workers now: what they have not finished is run again by --resume."""
    processes = list((pool._processes or {}).values())
    manager: Any = pool._executor_manager_thread  # a thread; typeshed takes it for something else
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.kill()
    # The pool's own thread reaps them too, and the second to reap cannot tell that they are gone. With a limit: it
    # reads from them, and what died in the middle of a record never ends it.
    if manager is not None:
        manager.join(_END_S)
    for process in processes:
        process.join()


def run_cluster(
    ids: Sequence[str], address: str, files: Mapping[str, bytes], core: str, run: Any = work
) -> Iterator[Record]:
    """Yield the record of each id as it comes from the workers of a Dask scheduler.

    A mission whose worker dies goes to another one. core: digest of the fault manager that the workers must have.
    LinkError when no scheduler answers at the address.
    """
    try:
        # Any: the package is optional, and its types are not complete.
        dask: Any = importlib.import_module("distributed")
    except ImportError:
        raise SimError(
            "--scheduler needs Dask, which is not installed: pip install 'argus-p3dx[cluster]'"
        ) from None
    try:
        client = dask.Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise LinkError(
            f"--scheduler {address}: nobody answers ({error}); start 'dask scheduler' there"
        ) from error
    with client:
        waiting = deque(ids)
        width = AHEAD * max(1, sum(client.nthreads().values()))
        given = dict(files)

        def submit() -> Any:
            # Not pure: a second bench must not be handed the first one's results. The files go along with each
            # mission, not ahead to some workers: whatever dies, the next worker has all that it needs.
            name = waiting.popleft()
            world = parse_id(name).world
            own = {world: given[world]} if world in given else None
            future = client.submit(run, name, own, core, pure=False, retries=_CLUSTER_LIVES)
            names[future.key] = name
            return future

        names: dict[str, str] = {}
        first = [submit() for _ in range(min(width, len(waiting)))]
        running = dask.as_completed(first, loop=client.loop)
        for future in running:
            name = names.pop(future.key)
            if future.status == "finished":
                yield future.result()
            else:
                yield failed(parse_id(name), f"the cluster gave it up: {future.status}, {_reason(future)}")
            if waiting:
                running.add(submit())


def _reason(future: Any) -> str:
    """Why a task has no result; asking a cancelled one raises."""
    try:
        return str(future.exception())
    except Exception as error:  # whatever it is, it is the reason
        return f"{type(error).__name__} {error}"
