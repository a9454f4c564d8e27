#!/usr/bin/env python3
"""Writes the mean density of the upper atmosphere at three levels of solar activity, as atmosphere/density.txt has it.

    pip install brahe==1.8.0
    python3 make_density.py > atmosphere/density.txt

NRLMSISE-00 (Picone et al., J. Geophys. Res. 107 (2002) 1468) as in brahe, averaged over the globe by area, over local
time and over the year. Activities are the long-term ones of ECSS-E-ST-10-04C: F10.7 (daily and of 81 days) and Ap 65, 0
(low), 140, 15 (moderate) and 250, 45 (high).
"""

import math

import brahe as bh
import numpy as np

# F10.7, Ap, and the Kp next to it.
ACTIVITIES = [(65.0, 0.0, 0.0), (140.0, 15.0, 3.0), (250.0, 45.0, 5.0)]
ALTITUDES_KM = range(100, 1501, 20)
# Nodes and weights of a Gauss-Legendre rule in the sine of the latitude.
SINES, WEIGHTS = np.polynomial.legendre.leggauss(8)
MONTHS = range(1, 13)
LONGITUDES_DEG = np.arange(0.0, 360.0, 45.0)


def mean_density(altitude_km):
    total = 0.0
    for sine, weight in zip(SINES, WEIGHTS):
        latitude_deg = math.degrees(math.asin(sine))
        for month in MONTHS:
            epoch = bh.Epoch.from_datetime(2025, month, 15, 12, 0, 0.0, 0.0, bh.TimeSystem.UTC)
            for longitude_deg in LONGITUDES_DEG:
                # At one instant all longitudes are all local times.
                place = np.array([longitude_deg, latitude_deg, altitude_km * 1e3])
                total += weight * bh.density_nrlmsise00_geod(epoch, place)
    return total / (2 * len(MONTHS) * len(LONGITUDES_DEG))


def main():
    bh.set_global_eop_provider_from_static_provider(bh.StaticEOPProvider.from_zero())
    columns = []
    for flux, ap, kp in ACTIVITIES:
        bh.set_global_space_weather_provider(bh.StaticSpaceWeatherProvider.from_values(kp, ap, flux, flux, 0))
        columns.append([mean_density(altitude) for altitude in ALTITUDES_KM])
    print("# km; kg/m3 at low, moderate and high solar activity")
    for altitude, *densities in zip(ALTITUDES_KM, *columns):
        print(altitude, *(f"{density:.4e}" for density in densities))


if __name__ == "__main__":
    main()
