"""A scene as an environment whose agent moves the hand."""

from __future__ import annotations

from typing import Any, Callable, Mapping, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import ArgumentError, Error, Meshes, PathOrName, Scene, Simulator, Stepper, Tick
from .spaces import Base, Box

Vector = NDArray[np.float64]
Reward = Callable[[Tick, Vector], float]
Terminated = Callable[[Tick, Vector], bool]


def no_reward(tick: Tick, action: Vector) -> float:
    """Return a reward of 0."""
    return 0.0


class TouchEnv(Base):
    """A scene in virtual time as an environment with Gymnasium's interface. The agent moves the hand.

    action: new target of the hand in the world, (3,), m. The hand moves there smoothly like a person's,
    with at most 0.4 m/s. If the arm cannot reach the target, the hand keeps its previous target, and
    ``info["reached"]`` is False. observation, (11,): tip p_WT (m), velocity v_WT (m/s), force on the hand
    (N), each in the world; depth of the tip below the surface (m); 1 in contact, else 0.

    Results are bit-identical for the same seed and actions, with and without Gymnasium.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        scene: Scene,
        reward: Reward = no_reward,
        *,
        terminated: Optional[Terminated] = None,
        frame_skip: int = 10,
        seconds: float = 10.0,
        workspace: Optional[tuple[ArrayLike, ArrayLike]] = None,
        set: Optional[Mapping[str, Any]] = None,
        arm: Optional[PathOrName] = None,
        quality: str = "normal",
        meshes: Optional[Meshes] = None,
    ) -> None:
        """Open the scene once, to get its arm.

        reward: ``reward(tick, action)``, called once per step with its last tick; 0 by default.
        terminated: ``terminated(tick, action)``, whether the goal was reached; by default never.
        frame_skip: ticks of the servo loop per step. seconds: duration after which an episode is truncated.
        workspace: lower and upper corner of the box of actions, (3,) in the world, m; by default that of
        the arm. meshes: meshes to share with other environments; the episodes of one environment always
        share theirs. The other options and errors are those of :func:`thimble.run`.
        """
        if frame_skip < 1 or frame_skip != int(frame_skip):
            raise ArgumentError(f"frame_skip: expected a whole number of 1 or more, found {frame_skip}.")
        self._reward = reward
        self._terminated = terminated
        self._frame_skip = int(frame_skip)
        self._seconds = float(seconds)
        # One second longer than requested: this class counts ticks and ends the episode.
        self._options: dict[str, Any] = {"set": set, "arm": arm, "quality": quality, "seconds": self._seconds + 1.0}
        self._options["meshes"] = Meshes() if meshes is None else meshes
        self._scene = scene
        info = Stepper(scene, **self._options).info
        self._rate = float(info["rate"])
        self._max_ticks = max(1, round(self._seconds * self._rate))
        self.action_space, self.observation_space = spaces_of(info, workspace)
        self.render_mode = None
        self._stepper: Optional[Stepper] = None
        self._ticks = 0
        self._over = True

    @property
    def stepper(self) -> Stepper:
        """The run of the episode: ticks, meshes, figures. Raises Error before the first reset."""
        if self._stepper is None:
            raise Error("The environment has no episode: call reset().")
        return self._stepper

    @property
    def seconds_per_step(self) -> float:
        """Virtual time of a step, s."""
        return self._frame_skip / self._rate

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Begin an episode with the scene of the file, and return the observation of its first tick.

        seed: seed of all following episodes; each episode draws its own seed for the hand's tremor. If no
        seed was ever given, the system provides one. options: ``{"seed": 3}`` sets the tremor's seed of
        this episode directly, as :func:`thimble.run` does.
        """
        super().reset(seed=seed)
        episode_seed = int(self.np_random.integers(2**31))
        episode_seed = int((options or {}).get("seed", episode_seed))
        self._stepper = Stepper(self._scene, seed=episode_seed, **self._options)
        self._stepper.step()
        self._ticks = 1
        self._over = False
        return self._observe(self._tick(), {"reached": True, "seed": episode_seed})

    def step(self, action: ArrayLike) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """Run ``frame_skip`` ticks, and return observation, reward, terminated, truncated, info.

        terminated: set by the function of that name, or by a fault (``info["fault"]`` names it).
        """
        stepper = self.stepper
        if self._over:
            raise Error("The episode is over: call reset().")
        goal = np.asarray(action, dtype=np.float64)
        if goal.shape != (3,) or not np.isfinite(goal).all():
            raise ArgumentError(f"action: expected three numbers, found {action!r}.")
        reached = _step_towards(stepper, goal)
        went = 1
        while went < self._frame_skip and self._ticks + went < self._max_ticks and stepper.step():
            went += 1
        self._ticks += went
        tick = self._tick()
        observation, info = self._observe(tick, {"reached": reached})
        terminated = stepper.end == "fault" or tick.fault != ""
        if self._terminated is not None:
            terminated = bool(self._terminated(tick, goal)) or terminated
        truncated = self._ticks >= self._max_ticks
        self._over = terminated or truncated
        return observation, float(self._reward(tick, goal)), terminated, truncated, info

    def close(self) -> None:
        """End the episode, and release the scene."""
        self._stepper = None
        self._over = True

    def _tick(self) -> Tick:
        tick = self.stepper.tick
        assert tick is not None  # reset() ran the first one
        return tick

    @staticmethod
    def _observe(tick: Tick, info: dict[str, Any]) -> tuple[Vector, dict[str, Any]]:
        contact = float(tick.in_contact)
        observation = np.concatenate([tick.tip, tick.velocity, tick.force, [float(tick.depth), contact]])
        info.update(time=float(tick.time), object=int(tick.object), fault=tick.fault)
        return observation, info


def _step_towards(stepper: Stepper, goal: Vector) -> bool:
    """Run a tick with a new target of the hand. Returns False, and keeps the old target, if it is out of reach."""
    try:
        stepper.step(hand=goal)
        return True
    except Error as wrong:
        if "does not reach" not in str(wrong):
            raise
    stepper.step()  # the target was refused before a tick ran
    return False


def spaces_of(info: Mapping[str, Any], workspace: Optional[tuple[ArrayLike, ArrayLike]]) -> tuple[Box, Box]:
    """Return the spaces of actions and observations for the ``info`` of a run."""
    low, high = workspace if workspace is not None else _workspace_of(info)
    actions = Box(np.asarray(low, np.float64), np.asarray(high, np.float64), dtype=np.float64)
    endless = np.full(9, np.inf)
    observations = Box(
        np.concatenate([-endless, [0.0, 0.0]]), np.concatenate([endless, [np.inf, 1.0]]), dtype=np.float64
    )
    return actions, observations


def _workspace_of(info: Mapping[str, Any]) -> tuple[Vector, Vector]:
    try:
        return Simulator(info["arm_file"]).workspace
    except Error as wrong:
        raise ArgumentError(
            f"workspace: pass ((x, y, z), (x, y, z)), m, because that of {info['arm']} is unknown: "
            f"{wrong}"
        ) from wrong
