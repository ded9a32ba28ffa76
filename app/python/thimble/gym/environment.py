"""A scene as an environment whose agent moves the hand."""

from __future__ import annotations

import functools
from typing import Any, Callable, Mapping, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import ArgumentError, Error, Meshes, PathOrName, Scene, Stepper, Tick
from .._arguments import number_of, whole_of
from .actions import Actions, workspace_of
from .observations import checked_bodies, observation_space, observed
from .picture import Picture
from .spaces import Base
from .window import Window

Vector = NDArray[np.float64]
Reward = Callable[[Tick, Vector], float]
Terminated = Callable[[Tick, Vector], bool]


def no_reward(tick: Tick, action: Vector) -> float:
    """Return a reward of 0."""
    return 0.0


class TouchEnv(Base):
    """A scene in virtual time as an environment with Gymnasium's interface. The agent moves the hand.

    action, (3,): new target of the hand (``actions=``). The hand moves there smoothly like a person's, with at
    most 0.4 m/s. If the arm cannot reach the target, the hand keeps its previous target, and
    ``info["reached"]`` is False. observation, (11,): tip p_WT (m), velocity v_WT (m/s), force on the hand
    (N), each in the world; depth of the tip below the surface (m); 1 in contact, else 0. For each object in
    ``bodies``, 7 more: position (m) and quaternion w, x, y, z, as in :attr:`Stepper.bodies`. Both spaces are
    finite; an observation outside its space, such as an object that fell off a table, is set to the bound.

    Results are bit-identical for the same seed and actions, with and without Gymnasium. An environment can be
    copied and pickled: the copy has the same options and no episode.
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 100}
    _made_from: tuple[tuple[Any, ...], dict[str, Any]]

    def __new__(cls, *arguments: Any, **options: Any) -> "TouchEnv":
        env = super().__new__(cls)
        env._made_from = arguments, options
        return env

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
        bodies: Sequence[str] = (),
        actions: str = "world",
        render_mode: Optional[str] = None,
        size: tuple[int, int] = (480, 360),
    ) -> None:
        """Open the scene once, to get its arm.

        reward: ``reward(tick, action)``, called once per step with its last tick; 0 by default.
        terminated: ``terminated(tick, action)``, whether the goal was reached; by default never.
        frame_skip: ticks of the servo loop per step. seconds: duration after which an episode is truncated.
        workspace: lower and upper corner of the box of targets, (3,) in the world, m; by default that of
        the arm. meshes: meshes to share with other environments; the episodes of one environment always
        share theirs. bodies: names of objects that move, whose poses are added to the observation. The other
        options and errors are those of :func:`thimble.run`.

        actions: "world": the target in the world, m. "unit": numbers from -1 to 1, scaled to the workspace.
        "move": numbers from -1 to 1 that displace the present target; 1 is the distance that the hand can
        cover in one step.

        render_mode: "rgb_array": :meth:`render` returns a picture. "human": a window shows the episode in
        real time. size: width and height of the picture, pixels.
        """
        self._frame_skip = whole_of("frame_skip", frame_skip, 1)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ArgumentError(f'render_mode: expected "human", "rgb_array" or None, found {render_mode!r}.')
        self._size = whole_of("size", size[0], 64, 4096), whole_of("size", size[1], 64, 4096)
        self._reward = reward
        self._terminated = terminated
        self._seconds = number_of("seconds", seconds)
        # One second longer than requested: this class counts ticks and ends the episode.
        self._options: dict[str, Any] = {"set": set, "arm": arm, "quality": quality, "seconds": self._seconds + 1.0}
        self._options["meshes"] = Meshes() if meshes is None else meshes
        self._scene = scene
        stepper = Stepper(scene, **self._options)
        info = stepper.info
        self._name = str(info["scene"])
        self._bodies = checked_bodies(bodies, list(stepper.bodies))
        self._rate = float(info["rate"])
        self._max_ticks = max(1, round(self._seconds * self._rate))
        low, high = workspace_of(info, workspace)
        self._actions = Actions(actions, low, high, self.seconds_per_step)
        self.action_space = self._actions.space
        self.observation_space = observation_space(info, low, high, len(self._bodies))
        self.metadata = {**self.metadata, "render_fps": max(1, round(1.0 / self.seconds_per_step))}
        self.render_mode = render_mode
        self._picture: Optional[Picture] = None
        self._window: Optional[Window] = None
        self._stepper: Optional[Stepper] = None
        self._target = np.zeros(3)
        self._ticks = 0
        self._over = True

    def __reduce__(self) -> tuple[Any, ...]:
        arguments, options = self._made_from
        return functools.partial(type(self), *arguments, **options), ()

    def __repr__(self) -> str:
        state = "no episode" if self._stepper is None else f"{self._ticks / self._rate:.3f} s of {self._seconds:g} s"
        return f'{type(self).__name__}("{self._name}", actions="{self._actions.kind}", {state})'

    __str__ = __repr__

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
        tick = self._tick()
        self._target = np.array(tick.tip)
        observation, info = self._observe(tick, {"reached": True, "seed": episode_seed})
        self._show(new_episode=True)
        return observation, info

    def step(self, action: ArrayLike) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """Run ``frame_skip`` ticks, and return observation, reward, terminated, truncated, info.

        terminated: set by the function of that name, or by a fault (``info["fault"]`` names it).
        """
        stepper = self.stepper
        if self._over:
            raise Error("The episode is over: call reset().")
        given = np.asarray(action, dtype=np.float64)
        if given.shape != (3,) or not np.isfinite(given).all():
            raise ArgumentError(f"action: expected three numbers, found {action!r}.")
        target = self._actions.targets(given, self._target)
        reached = _step_towards(stepper, target)
        if reached:
            self._target = target
        went = 1
        while went < self._frame_skip and self._ticks + went < self._max_ticks and stepper.step():
            went += 1
        self._ticks += went
        tick = self._tick()
        observation, info = self._observe(tick, {"reached": reached})
        terminated = stepper.end == "fault" or tick.fault != ""
        if self._terminated is not None:
            terminated = bool(self._terminated(tick, given)) or terminated
        truncated = self._ticks >= self._max_ticks
        self._over = terminated or truncated
        self._show()
        return observation, float(self._reward(tick, given)), terminated, truncated, info

    def render(self) -> Optional[NDArray[np.uint8]]:
        """Return the present moment as an array (height, width, 3) of RGB values, in the mode "rgb_array".

        In the mode "human", the window shows it, and None is returned. :meth:`step` and :meth:`reset` update the
        window, too. Raises Error without a render mode.
        """
        if self.render_mode is None:
            raise Error('The environment has no render mode: create it with render_mode="rgb_array" or "human".')
        stepper = self.stepper
        if self._picture is None:
            self._picture = Picture(*self._size)
        meshes = {name: stepper.mesh(name) for name in stepper.objects}
        frame = self._picture.draw(meshes, self._tick())
        if self.render_mode == "rgb_array":
            return frame
        self._open_window().show(frame)
        return None

    def close(self) -> None:
        """End the episode, close the window, and release the scene. Repeated calls do nothing."""
        self._stepper = None
        self._picture = None
        self._over = True
        if self._window is not None:
            self._window.close()
            self._window = None

    def _show(self, new_episode: bool = False) -> None:
        """Update the window, in the mode "human", in real time."""
        if self.render_mode != "human":
            return
        if self._open_window().is_due(self._ticks / self._rate, new_episode):
            self.render()

    def _open_window(self) -> Window:
        if self._window is None:
            self._window = Window(f"Thimble: {self._name}", *self._size)
        return self._window

    def _tick(self) -> Tick:
        tick = self.stepper.tick
        assert tick is not None  # reset() ran the first one
        return tick

    def _observe(self, tick: Tick, info: dict[str, Any]) -> tuple[Vector, dict[str, Any]]:
        poses: list[Any] = []
        if self._bodies:
            all_poses = self.stepper.bodies
            for name in self._bodies:
                poses += all_poses[name]
        info.update(time=float(tick.time), object=int(tick.object), fault=tick.fault)
        return observed(tick, poses, self.observation_space), info


def _step_towards(stepper: Stepper, target: Vector) -> bool:
    """Run a tick with a new target of the hand. Returns False, and keeps the old target, if it is out of reach."""
    try:
        stepper.step(hand=target)
        return True
    except Error as wrong:
        if "does not reach" not in str(wrong):
            raise
    stepper.step()  # the target was refused before a tick ran
    return False
