# Initialises the arm by motion, then pushes.
import proof

drd = proof.load_drd()
proof.prove(drd.drdOpenID(0) == 0, drd.dhdErrorGetLastStr())
if not drd.drdIsInitialized(-1):
    proof.prove(drd.drdAutoInit(-1) == 0, "no initialisation")
proof.prove(drd.drdIsInitialized(-1) and drd.drdStop(True, -1) == 0, "it is regulated")
proof.prove(not drd.drdIsRunning(-1), "it is regulated")
for _ in range(proof.TICKS):
    p = proof.position_dhd(drd)
    f = [-25 * x for x in p]
    proof.note(0, p, f)
    proof.push_dhd(drd, f)
drd.drdClose(-1)
