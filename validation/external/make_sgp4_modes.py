"""States of the SGP4 verification set in both modes, by the C++ code of Vallado et al.

The published list tcppver.out has one mode only. This script flies the same element sets over the
same minutes in AFSPC and in improved mode, with the official C++ code as the PyPI package `sgp4`
wraps it, and writes `mode,number,minutes,x,y,z,vx,vy,vz` (km, km/s); a set ends where the code
refuses it.

    python3 validation/external/make_sgp4_modes.py > validation/cases/sgp4/modes.csv
"""

from pathlib import Path

from sgp4 import earth_gravity
from sgp4.api import WGS72, Satrec, accelerated
from sgp4.io import twoline2rv

CASES = Path(__file__).parent.parent / "cases" / "sgp4"


def cases():
    lines = [l for l in (CASES / "SGP4-VER.TLE").read_text().splitlines() if not l.startswith("#")]
    for one, two in zip(lines[::2], lines[1::2]):
        yield one[:69], two[:69], [float(x) for x in two[69:].split()]


def minutes(start, stop, step):
    """The published minutes: the epoch first, then the span with its end."""
    yield 0.0
    at = start
    while at < stop:
        if at != 0.0:
            yield at
        at += step
    if stop != 0.0:
        yield stop


def satellite(one, two, mode):
    read = twoline2rv(one, two, earth_gravity.wgs72, opsmode=mode)
    made = Satrec()
    made.sgp4init(
        WGS72, mode, read.satnum, read.jdsatepoch - 2433281.5 + read.jdsatepochF,
        read.bstar, read.ndot, read.nddot, read.ecco, read.argpo, read.inclo, read.mo,
        read.no_kozai, read.nodeo,
    )
    return made


def main():
    assert accelerated, "the C++ code is what is wanted"
    print("mode,number,minutes,x,y,z,vx,vy,vz")
    for mode, name in (("a", "afspc"), ("i", "improved")):
        for one, two, span in cases():
            flown = satellite(one, two, mode)
            for at in minutes(*span):
                error, r, v = flown.sgp4_tsince(at)
                if error:
                    break
                values = [f"{x:.8f}" for x in r] + [f"{x:.9f}" for x in v]
                print(",".join([name, str(int(one[2:7])), f"{at:.8f}", *values]))


if __name__ == "__main__":
    main()
