"""Several environments at once, in separate processes."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import sys
import traceback
import types
import weakref
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.reduction import ForkingPickler
from typing import Any, Callable, Iterator, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import ArgumentError, Error
from .spaces import NEXT_STEP, VectorBase, batched, seeds_of

Make = Callable[[], Any]


class VectorEnv(VectorBase):
    """Several environments, distributed over processes. Each is bit-identical to a single environment.

    ``step`` takes the actions of all environments, (n, ...), and returns arrays of n. If the episode of an
    environment has ended, the next step resets it, ignores its action and gives it reward 0 (Gymnasium's
    NEXT_STEP). Each process has a share of the environments. It ends when this object is closed, or when
    this process is killed.

    Functions are passed by name, as `multiprocessing` does with "spawn". Functions of a script are found
    only if the script's main part is below ``if __name__ == "__main__":``. Functions of a notebook or an
    interactive session are not found; put them into a file and import it.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": NEXT_STEP}
    closed = True  # until the processes run

    def __init__(
        self,
        make: Union[Make, Sequence[Make]],
        count: Optional[int] = None,
        *,
        workers: Optional[int] = None,
        start: str = "spawn",
    ) -> None:
        """Start the processes, and wait until each has its environments.

        make: a function that returns an environment and is called `count` times, or a list of such
        functions: ``functools.partial(thimble.gym.TouchEnv, "rubber", reward=mine)``. With
        ``meshes=thimble.Meshes()`` in `make`, the environments of a process share their meshes. workers:
        number of processes; by default one for each core, at most one for each environment. start: "spawn"
        or "forkserver".
        """
        makes = list(make) if isinstance(make, Sequence) else [make] * (1 if count is None else count)
        if not makes or (count is not None and count != len(makes)):
            raise ArgumentError(f"count: expected {max(1, len(makes))}, found {count}.")
        if start not in ("spawn", "forkserver"):
            raise ArgumentError(f'start: expected "spawn" or "forkserver", found {start!r}.')
        if workers is not None and workers < 1:
            raise ArgumentError(f"workers: expected 1 or more, found {workers}.")
        max_workers = workers if workers is not None else len(os.sched_getaffinity(0))
        shares = np.array_split(np.arange(len(makes)), min(max_workers, len(makes)))
        self.num_envs = len(makes)
        self.closed = False
        self._workers: list[_Worker] = []
        # Closes at the end of the object or the program if close() was not called.
        self._closer = weakref.finalize(self, _close_all, self._workers)
        try:
            for share in shares:
                self._workers.append(_Worker(share, [makes[i] for i in share], start))
            spaces = [worker.receive() for worker in self._workers][0]
        except BaseException:
            self.close()
            raise
        self.single_observation_space, self.single_action_space = spaces
        self.observation_space = batched(self.single_observation_space, self.num_envs)
        self.action_space = batched(self.single_action_space, self.num_envs)
        self._begun = False
        self.render_mode = None

    def __enter__(self) -> "VectorEnv":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "closed" if self.closed else f"in {len(self._workers)} processes"
        return f"VectorEnv({self.num_envs} environments, {state})"

    __str__ = __repr__

    def reset(
        self,
        *,
        seed: Union[None, int, Sequence[Optional[int]]] = None,
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[NDArray[Any], dict[str, Any]]:
        """Begin an episode in each environment, and return observations (n, ...) and infos.

        seed: one for each, or one number s for s, s + 1, s + 2 and so on. infos: an array for each key of
        the environments' infos, and with the name ``_key`` a mask of the environments that have the key.
        """
        seeds = seeds_of(seed, self.num_envs)
        results = self._ask("reset", [(one, options) for one in seeds])
        self._begun = True
        return np.stack([observation for observation, _ in results]), _gathered([info for _, info in results])

    def step(
        self, actions: ArrayLike
    ) -> tuple[NDArray[Any], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Step each environment. Returns observations, rewards, terminated, truncated (arrays of n) and infos."""
        each = np.asarray(actions)
        if each.shape != self.action_space.shape:
            raise ArgumentError(f"actions: expected the shape {self.action_space.shape}, found {each.shape}.")
        if not self._begun:
            raise Error("The environments have no episodes: call reset().")
        results = self._ask("step", list(each))
        return (
            np.stack([one[0] for one in results]),
            np.array([one[1] for one in results], dtype=np.float64),
            np.array([one[2] for one in results], dtype=np.bool_),
            np.array([one[3] for one in results], dtype=np.bool_),
            _gathered([one[4] for one in results]),
        )

    def close(self, **_: Any) -> None:
        """End all processes, and wait for their end. Repeated calls do nothing."""
        self.closed = True
        self._closer()

    @property
    def processes(self) -> list[int]:
        """Numbers of the running processes; empty after :meth:`close`."""
        return [worker.process.pid for worker in self._workers if worker.process.pid is not None]

    def _ask(self, what: str, each: list[Any]) -> list[Any]:
        if self.closed:
            raise Error("The environments are closed. Create a new object.")
        results: list[Any] = []
        try:
            for worker in self._workers:
                worker.send((what, [each[i] for i in worker.share]))
            for worker in self._workers:
                results += worker.receive()
        except BaseException:  # half an answer is in the pipes, so the object is unusable, also after Ctrl-C
            self.close()
            raise
        return results


class _Worker:
    """Handle of a process that has a share of the environments."""

    def __init__(self, share: NDArray[Any], makes: list[Make], start: str) -> None:
        self.share = share
        context: Any = get_context(start)
        self._pipe, theirs = context.Pipe()
        parcel = bytes(ForkingPickler.dumps(makes))
        self.process = context.Process(target=_serve, args=(theirs, parcel), daemon=True)
        # The caller's script runs in the process only if the process needs something from it.
        with contextlib.nullcontext() if b"__main__" in parcel else _hidden_script():
            self.process.start()
        theirs.close()  # otherwise the end of the process would not be detected here

    def send(self, what: Any) -> None:
        with contextlib.suppress(BrokenPipeError):  # receive() reports it
            self._pipe.send(what)

    def receive(self) -> Any:
        try:
            kind, results = self._pipe.recv()
        except (EOFError, ConnectionResetError):
            self.process.join()
            at = ", ".join(map(str, self.share))
            raise Error(
                f"The process of the environments {at} ended (exit code {self.process.exitcode}). All are closed."
            ) from None
        if kind == "wrong":
            raise Error(f"In the process of environment {self.share[results[0]]}: {results[1]}")
        return results

    def close(self) -> None:
        self._pipe.close()  # this ends the process
        self.process.join(timeout=5)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()


def _close_all(workers: list[_Worker]) -> None:
    while workers:
        workers.pop().close()


@contextlib.contextmanager
def _hidden_script() -> Iterator[None]:
    """Prevent `multiprocessing` from running the caller's script again in the new process."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = types.ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


def _serve(pipe: Connection, parcel: bytes) -> None:
    """Create environments, and answer requests until the other end of the pipe is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent handles Ctrl-C and closes
    at = 0
    try:
        environments = []
        makes = pickle.loads(parcel)
        for at, make in enumerate(makes):
            environments.append(make())
        over = [False] * len(environments)
        pipe.send(("results", (environments[0].observation_space, environments[0].action_space)))
        while True:
            what, each = pipe.recv()
            results = []
            for at, environment in enumerate(environments):
                if what == "reset":
                    results.append(environment.reset(seed=each[at][0], options=each[at][1]))
                    over[at] = False
                elif over[at]:
                    results.append((lambda begun: (begun[0], 0.0, False, False, begun[1]))(environment.reset()))
                    over[at] = False
                else:
                    results.append(environment.step(each[at]))
                    over[at] = bool(results[-1][2] or results[-1][3])
            pipe.send(("results", results))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass
    except Exception:
        with contextlib.suppress(OSError):
            pipe.send(("wrong", (at, traceback.format_exc())))


def _gathered(infos: list[dict[str, Any]]) -> dict[str, Any]:
    """Return infos as arrays by key, and as ``_key`` a mask of the environments that have the key."""
    gathered: dict[str, Any] = {}
    for key in dict.fromkeys(key for info in infos for key in info):
        results = np.array([key in info for info in infos])
        first = next(info[key] for info in infos if key in info)
        plain = isinstance(first, (bool, int, float))
        values = np.zeros(len(infos), dtype=type(first) if plain else object)
        for at, info in enumerate(infos):
            if key in info:
                values[at] = info[key]
        gathered[key], gathered["_" + key] = values, results
    return gathered
