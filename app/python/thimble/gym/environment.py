"""One scene with the hand as the agent."""

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
    """Reward nothing."""
    return 0.0


class TouchEnv(Base):
    """A scene in virtual time as an environment with Gymnasium's interface; the agent leads the hand.

    action: the point of the world that the hand is led to from now on, (3,), m. It goes there as a
    person's would, smoothly and at most with 0.4 m/s; out of reach of the arm the hand is led on to
    where it was (``info["reached"]`` is False). observation, (11,): tip p_WT (m), velocity v_WT (m/s),
    force on the hand (N), each in the world; depth of the tip below the surface (m); 1 in contact, else 0.

    The same to the bit for the same seed and actions, whether Gymnasium is installed or not.
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
        """Open the scene once, to learn its arm.

        reward: ``reward(tick, action)``, asked once per step with the last tick of it; 0 if absent.
        terminated: ``terminated(tick, action)``, whether the goal was reached; never if absent.
        frame_skip: ticks of the servo loop per step. seconds: an episode is truncated after them.
        workspace: lower and upper corner of the box of actions, (3,) in the world, m; the arm's own if
        absent. meshes: that it shares with other environments; all its episodes share them in any case.
        Others as of :func:`thimble.run`. Raises thimble.Error as it does.
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
        self._ticks_most = max(1, round(self._seconds * self._rate))
        self.action_space, self.observation_space = spaces_of(info, workspace)
        self.render_mode = None
        self._stepper: Optional[Stepper] = None
        self._ticks = 0
        self._over = True

    @property
    def stepper(self) -> Stepper:
        """The episode beneath: ticks, meshes, figures. Error before the first reset."""
        if self._stepper is None:
            raise Error("The environment has no episode: call reset().")
        return self._stepper

    @property
    def seconds_per_step(self) -> float:
        """Virtual time that a step takes, s."""
        return self._frame_skip / self._rate

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Begin an episode with the scene as it is in its file, and give what is felt in its first tick.

        seed: of all episodes from now on; each takes a seed of its own for the hand's tremor from it.
        Without any seed ever the system gives one. options: ``{"seed": 3}`` seeds this episode's
        tremor itself, as :func:`thimble.run` does.
        """
        super().reset(seed=seed)
        episode_seed = int(self.np_random.integers(2**31))
        episode_seed = int((options or {}).get("seed", episode_seed))
        self._stepper = Stepper(self._scene, seed=episode_seed, **self._options)
        self._stepper.step()
        self._ticks = 1
        self._over = False
        return self._felt(self._tick(), {"reached": True, "seed": episode_seed})

    def step(self, action: ArrayLike) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """Lead the hand for ``frame_skip`` ticks, and give observation, reward, terminated, truncated, info.

        terminated: by the function of that name, or by a fault (``info["fault"]`` names it).
        """
        stepper = self.stepper
        if self._over:
            raise Error("The episode is over: call reset().")
        goal = np.asarray(action, dtype=np.float64)
        if goal.shape != (3,) or not np.isfinite(goal).all():
            raise ArgumentError(f"action: expected three numbers, found {action!r}.")
        reached = _lead(stepper, goal)
        went = 1
        while went < self._frame_skip and self._ticks + went < self._ticks_most and stepper.step():
            went += 1
        self._ticks += went
        tick = self._tick()
        observation, info = self._felt(tick, {"reached": reached})
        terminated = stepper.end == "fault" or tick.fault != ""
        if self._terminated is not None:
            terminated = bool(self._terminated(tick, goal)) or terminated
        truncated = self._ticks >= self._ticks_most
        self._over = terminated or truncated
        return observation, float(self._reward(tick, goal)), terminated, truncated, info

    def close(self) -> None:
        """End the episode, and let the scene go."""
        self._stepper = None
        self._over = True

    def _tick(self) -> Tick:
        tick = self.stepper.tick
        assert tick is not None  # reset() ran the first one
        return tick

    @staticmethod
    def _felt(tick: Tick, info: dict[str, Any]) -> tuple[Vector, dict[str, Any]]:
        contact = float(tick.in_contact)
        observation = np.concatenate([tick.tip, tick.velocity, tick.force, [float(tick.depth), contact]])
        info.update(time=float(tick.time), object=int(tick.object), fault=tick.fault)
        return observation, info


def _lead(stepper: Stepper, goal: Vector) -> bool:
    """Run a tick, and tell whether the arm reaches where the hand is led to; else that stays as it was."""
    try:
        stepper.step(hand=goal)
        return True
    except Error as wrong:
        if "does not reach" not in str(wrong):
            raise
    stepper.step()  # the target was refused before a tick ran
    return False


def spaces_of(info: Mapping[str, Any], workspace: Optional[tuple[ArrayLike, ArrayLike]]) -> tuple[Box, Box]:
    """Give the spaces of actions and observations of a scene, by what its run tells of itself."""
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
            f"The workspace of {info['arm']} is not known by itself ({wrong}) Name it: "
            "workspace=((x, y, z), (x, y, z)), m."
        ) from wrong
