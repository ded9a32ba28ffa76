# A spring at the place where the arm is opened, by hdPhantom and ctypes.
import proof

phantom = proof.Phantom()
anchor = phantom.position()
for _ in range(proof.TICKS):
    p = phantom.position()
    phantom.push(p, [40 * (a - x) for a, x in zip(anchor, p)])
phantom.close()
