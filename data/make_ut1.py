#!/usr/bin/env python3
"""Turns the series EOP C04 of the IERS into UT1 - TAI at the beginning of each month.

    pip install astropy-iers-data==0.2026.11.2.0.34.55 pyerfa
    python3 data/make_ut1.py astropy_iers_data/data/eopc04.1962-now > data/earth-rotation/ut1-tai.txt

A line of the result is a year from 1972 on, and UT1 - TAI in seconds at 0h UTC on the first of each of its
months, as far as the series goes. Straight lines between them are within 7 ms of the series.
"""

import sys

import erfa


def main():
    years = {}
    with open(sys.argv[1], encoding="ascii") as series:
        for row in (line.split() for line in series if not line.startswith("#")):
            year, month, day = (int(text) for text in row[:3])
            if year >= 1972 and day == 1:
                years.setdefault(year, []).append(float(row[7]) - erfa.dat(year, month, day, 0.0))
    for year, values in years.items():
        print(year, *(f"{value:.3f}" for value in values))


main()
