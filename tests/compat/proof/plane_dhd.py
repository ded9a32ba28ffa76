# A plane at 18 mm.
import proof

drd = proof.load_drd()
proof.prove(drd.dhdOpen() == 0 and drd.dhdEnableForce(1, -1) == 0, drd.dhdErrorGetLastStr())
touched = 0
for _ in range(proof.TICKS):
    p = proof.position_dhd(drd)
    f = [0, 0, max(0, 150 * (0.018 - p[2]))]
    touched += f[2] > 0
    proof.note(0, p, f)
    proof.push_dhd(drd, f)
drd.dhdClose(-1)
proof.prove(touched > 300, f"{touched} ticks in contact")
