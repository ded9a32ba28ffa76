"""Many arms with the same scene in one process, as one vector environment."""

from __future__ import annotations

import warnings
from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import ArgumentError, Error, Meshes, PathOrName, Scene, Ticks, _core
from .._arguments import optional_path, path_of, whole_of
from .._meshes import core_meshes
from .._scene_text import scene_file
from .actions import Actions, workspace_of
from .observations import checked_bodies, observation_space, observed
from .spaces import NEXT_STEP, VectorBase, batched, seeds_of

Vector = NDArray[np.float64]
Rewards = Callable[[Ticks, Vector], ArrayLike]
Ends = Callable[[Ticks, Vector], ArrayLike]

_MAX_ARMS = 1_000_000  # 100 GB and more; [chosen] to detect a wrong unit


class TouchVectorEnv(VectorBase):
    """Many arms with the same scene in this process, stepped by one call; a Gymnasium ``VectorEnv``.

    Each arm is bit-identical to the :class:`TouchEnv` with its seed. The scene and its meshes are loaded
    once, and the loop over the arms runs in C++. Actions, observations and infos are those of `TouchEnv`,
    one row for each arm. If the episode of an arm has ended, the next step restarts it, ignores its action
    and gives it reward 0 (Gymnasium's NEXT_STEP).

    To use several cores, start a process for each, with different seeds.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": NEXT_STEP}
    closed = True  # until a batch is open

    def __init__(
        self,
        scene: Scene,
        count: int,
        reward: Optional[Rewards] = None,
        *,
        terminated: Optional[Ends] = None,
        frame_skip: int = 10,
        seconds: float = 10.0,
        workspace: Optional[tuple[ArrayLike, ArrayLike]] = None,
        set: Optional[Mapping[str, Any]] = None,
        arm: Optional[PathOrName] = None,
        quality: str = "normal",
        meshes: Optional[Meshes] = None,
        bodies: Sequence[str] = (),
        actions: str = "world",
        render_mode: Optional[str] = None,
    ) -> None:
        """Open the scene for `count` arms.

        reward: ``reward(ticks, actions)``, called once per step with the last tick of each arm
        (``ticks.force`` is (count, 3)) and the actions (count, 3). It returns (count,) numbers; 0 by default.
        terminated: ``terminated(ticks, actions)``, whether each goal was reached, (count,); by default
        never. Their values for arms that are restarted are ignored. The other options and errors are
        those of :class:`TouchEnv`. There are no pictures of many arms: render_mode is None.
        """
        if render_mode is not None:
            raise ArgumentError(f"render_mode: many arms have no pictures, found {render_mode!r}; use TouchEnv.")
        self.num_envs = whole_of("count", count, 1, _MAX_ARMS)
        self._frame_skip = whole_of("frame_skip", frame_skip, 1)
        self._reward = reward
        self._terminated = terminated
        self._batch: Optional[_core.Batch] = _core.Batch(
            scene_file(scene, set, keep=False),
            self.num_envs,
            arm=optional_path("arm", arm),
            # One second longer than requested: this class counts ticks and ends the episodes.
            seconds=float(seconds) + 1.0,
            quality=path_of("quality", quality, "draft, normal, reference or auto"),
            meshes=core_meshes(meshes),
        )
        for warning in self._batch.warnings():
            warnings.warn(warning, RuntimeWarning, stacklevel=2)
        info = self._batch.info()
        self._bodies = checked_bodies(bodies, self._batch.moving)
        self._rate = float(info["rate"])
        self._max_ticks = max(1, round(float(seconds) * self._rate))
        low, high = workspace_of(info, workspace)
        self._name = str(info["scene"])
        self._actions = Actions(actions, low, high, self.seconds_per_step)
        self.single_action_space = self._actions.space
        self.single_observation_space = observation_space(info, low, high, len(self._bodies))
        self.action_space = batched(self.single_action_space, self.num_envs)
        self.observation_space = batched(self.single_observation_space, self.num_envs)
        self.render_mode = None
        self.closed = False
        self._randoms: list[np.random.Generator] = []
        self._ticks = np.zeros(self.num_envs, np.int64)  # ticks of each episode
        self._over = np.ones(self.num_envs, np.bool_)
        self._targets = np.zeros((self.num_envs, 3))
        self._newest: Optional[Ticks] = None

    def __enter__(self) -> "TouchVectorEnv":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "closed" if self.closed else f'actions="{self._actions.kind}"'
        return f'TouchVectorEnv("{self._name}", {self.num_envs} arms, {state})'

    __str__ = __repr__

    @property
    def seconds_per_step(self) -> float:
        """Virtual time of a step, s."""
        return self._frame_skip / self._rate

    @property
    def ticks(self) -> Ticks:
        """The newest tick of each arm. Raises Error before the first reset."""
        if self._newest is None:
            raise Error("The environments have no episodes: call reset().")
        return self._newest

    def reset(
        self,
        *,
        seed: Union[None, int, Sequence[Optional[int]]] = None,
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[Vector, dict[str, Any]]:
        """Begin an episode of each arm, and return observations (count, 11 or more) and infos.

        seed: seeds of all following episodes, one for each arm; one number s gives s, s + 1, s + 2 and so
        on. options: ``{"seed": 3}`` sets the tremor's seed of these episodes directly, the same for all arms.
        """
        seeds = seeds_of(seed, self.num_envs)
        if not self._randoms:
            self._randoms = [np.random.default_rng(one) for one in seeds]
        for i, one in enumerate(seeds):
            if one is not None:
                self._randoms[i] = np.random.default_rng(one)
        everyone = np.ones(self.num_envs, np.bool_)
        begun = self._begin(everyone, (options or {}).get("seed"))
        return self._observe(everyone, begun, everyone)

    def step(
        self, actions: ArrayLike
    ) -> tuple[Vector, Vector, NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Run ``frame_skip`` ticks of each arm. Returns observations, rewards, terminated, truncated, infos."""
        given = np.ascontiguousarray(actions, dtype=np.float64)
        if given.shape != self.action_space.shape:
            raise ArgumentError(f"actions: expected the shape {self.action_space.shape}, found {given.shape}.")
        if self._newest is None:
            raise Error("The environments have no episodes: call reset().")
        new_episode = self._over.copy()
        if not np.isfinite(given[~new_episode]).all():
            raise ArgumentError("actions: expected three numbers for each arm.")
        ticks = np.where(new_episode, 0, np.minimum(self._frame_skip, self._max_ticks - self._ticks))
        targets = np.ascontiguousarray(self._actions.targets(given, self._targets))
        columns, reached = self._core().step(ticks.astype(np.uint32), targets)
        self._targets = np.where(reached.astype(np.bool_)[:, np.newaxis], targets, self._targets)
        self._ticks += ticks
        self._newest = Ticks(columns)
        begun = self._begin(new_episode, None)
        ticks_now = self._newest
        terminated = ticks_now.columns["fault"] != 0
        if self._terminated is not None:
            terminated = terminated | self._checked("terminated", self._terminated(ticks_now, given), np.bool_)
        rewards = np.zeros(self.num_envs)
        if self._reward is not None:
            rewards = self._checked("reward", self._reward(ticks_now, given), np.float64)
        rewards[new_episode] = 0.0
        terminated &= ~new_episode
        truncated = (self._ticks >= self._max_ticks) & ~new_episode
        self._over = terminated | truncated
        observations, infos = self._observe(new_episode, begun, reached.astype(np.bool_))
        return observations, rewards, terminated, truncated, infos

    def close(self, **_: Any) -> None:
        """Release the arms. Repeated calls do nothing."""
        self._batch = None
        self._newest = None
        self.closed = True

    def _core(self) -> _core.Batch:
        if self._batch is None:
            raise Error("The environments are closed. Create a new object.")
        return self._batch

    def _checked(self, name: str, values: ArrayLike, kind: Any) -> NDArray[Any]:
        array = np.array(values, dtype=kind)
        if array.shape != (self.num_envs,):
            raise ArgumentError(f"{name}: expected the shape ({self.num_envs},), found {array.shape}.")
        return array

    def _begin(self, which: NDArray[np.bool_], seed: Optional[int]) -> NDArray[np.uint64]:
        """Begin the episodes of some arms, with their first tick. Returns their seeds; 0 for the other arms."""
        seeds = np.zeros(self.num_envs, np.uint64)
        numbers = np.flatnonzero(which).astype(np.uint32)
        if not len(numbers):
            return seeds
        for i in numbers:
            drawn = int(self._randoms[i].integers(2**31))
            seeds[i] = drawn if seed is None else int(seed)
        self._core().restart(numbers, seeds[numbers])
        columns, _ = self._core().step(which.astype(np.uint32))
        self._newest = Ticks(columns)
        self._targets[which] = self._newest.tip[which]
        self._ticks[which] = 1
        self._over[which] = False
        return seeds

    def _observe(
        self, begun: NDArray[np.bool_], seeds: NDArray[np.uint64], reached: NDArray[np.bool_]
    ) -> tuple[Vector, dict[str, Any]]:
        ticks = self.ticks
        poses: list[Any] = []
        if self._bodies:
            poses.append(self._core().bodies(self._bodies).reshape(self.num_envs, -1))
        observations = observed(ticks, poses, self.single_observation_space)
        faults = np.array([_core.fault(int(one))[0] if one else "" for one in ticks.columns["fault"]], dtype=object)
        values_by_key: dict[str, NDArray[Any]] = {
            "reached": reached,
            "time": np.array(ticks.time),
            "object": ticks.object.astype(np.int64),
            "fault": faults,
        }
        infos: dict[str, Any] = {}
        for key, values in values_by_key.items():
            infos[key], infos["_" + key] = values, np.ones(self.num_envs, np.bool_)
        if begun.any():
            infos["seed"], infos["_seed"] = seeds.astype(np.int64), begun.copy()
        return observations, infos
