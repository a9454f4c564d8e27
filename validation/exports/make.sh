#!/bin/sh
# The gallery: three satellites at ten instants in every format and syntax. Makes it anew with
#     sh validation/exports/make.sh [path/to/navwalker [directory]]
# A format more is a line more in the list at the end: the name of its folder, and its options.
set -eu
program=${1:-target/release/navwalker}
out=${2:-$(dirname "$0")}
while read -r folder options; do
    # The options of a line are words.
    # shellcheck disable=SC2086
    "$program" export --quiet --force --design delta:55:3/3/1@925 \
        --set time.duration-h=1 --set time.step-s=360 --out "$out/$folder" $options >/dev/null
done <<'LIST'
tle --as tle,tle-states
omm-kvn --as omm
omm-xml --as omm --omm-syntax xml
omm-json --as omm --omm-syntax json
omm-csv --as omm --omm-syntax csv
omm-kvn-3.0 --as omm --ccsds-version 3.0 --creation-date 2025-06-01T12:00:00Z
oem-kvn --as oem
oem-xml --as oem --oem-syntax xml
oem-ndm --as oem --oem-syntax xml --oem-combined --frame GCRF
oem-kvn-3.0 --as oem --ccsds-version 3.0 --frame ITRF --time-system GPS
oem-teme --as oem --frame TEME --time-system TAI
opm --as opm
opm-xml --as opm --opm-syntax xml
opm-3.0 --as opm --ccsds-version 3.0 --frame ITRF --time-system TT
sp3-d --as sp3 --gnss beidou-3
sp3-c --as sp3 --sp3-version c --sp3-letter X
stk --as stk --set region.step-deg=20
stk-fixed --as stk --frame ITRF --set region.step-deg=20
csv --as csv
metrics --as metrics --set region.step-deg=20
czml --as czml --set region.step-deg=20
geojson --as geojson --set region.step-deg=20
kml --as kml --set region.step-deg=20
gmat --as gmat
yuma --as yuma
LIST
# Which build wrote the samples differs from machine to machine, so what the manifests name is not kept.
find "$out" -name provenance.json -delete
