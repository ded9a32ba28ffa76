# The sphere by hdPhantom and ctypes.
import math

import proof

phantom = proof.Phantom()
for _ in range(proof.TICKS):
    p = phantom.position()
    distance = math.hypot(*p)
    push = 250 * max(0, 0.020 - distance)  # N/m, m
    phantom.push(p, [push * x / distance for x in p])
phantom.close()
