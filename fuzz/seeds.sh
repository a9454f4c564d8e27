#!/bin/sh
# Seeds of the fuzz targets, by the program's own writers; SEM, which it only reads, begins without any, and terrain, skies and tables with some written here:
#     sh fuzz/seeds.sh [path/to/navwalker]
# A corpus that is there is kept; what the fuzzer found stays in it.
set -eu
cd "$(dirname "$0")/.."
program=${1:-target/release/navwalker}
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

export_to() {
    out="$1"
    shift
    "$program" export --quiet --out "$work/$out" --design lattice:55:4/2/1@925,e=0.01,w=30 \
        --set time.duration-h=0.1 --set time.step-s=90 "$@" >"$work/log"
}
export_to kvn --as tle,omm,oem,opm,sp3,stk,csv,tle-states
export_to xml --as omm,oem,stk,opm --omm-syntax xml --oem-syntax xml --opm-syntax xml --frame GCRF
export_to ndm --as oem,omm --oem-syntax xml --oem-combined --omm-syntax json --time-system TAI
export_to v3 --as omm,oem,opm,sp3,stk --omm-syntax csv --ccsds-version 3.0 --sp3-version c --frame ITRF --time-system GPS
export_to map --as czml --set region.step-deg=90 --set gnss.constellations='[]'
export_to almanac --as yuma --set region.step-deg=90
export_to teme --as oem,opm,stk,sp3 --frame TEME --time-system TT --sp3-letter G

for target in tle omm oem opm sp3 stk csv czml yuma sem lint terrain skies tables; do
    mkdir -p "fuzz/corpus/$target"
done
printf 'ncols 2\nnrows 3\nxllcorner 19.75\nyllcorner 9.75\ncellsize 0.5\nNODATA_value -9999\n1 2\n3 4.5\n5 6\n' >fuzz/corpus/terrain/grid.asc
printf 'latitude_deg,longitude_deg,height_m,weight\n10,20,1,1\n10,21,2,2\n11,20,3,3\n11,21,,4\n' >fuzz/corpus/terrain/table.csv
printf 'azimuth_deg,elevation_deg,system,sky\n0,5,a,one\n120,5,a,one\n240,5,a,one\n0,90,a,one\n40,30,b,one\n10,20,a,two\n' >fuzz/corpus/skies/two.csv
tables=fuzz/corpus/tables
printf 'azimuth_deg,elevation_deg\n0,5\n90,12.5\n180,0\n270,3\n' >$tables/skyline.csv
printf 'name,latitude_deg,longitude_deg,height_m,weight,skyline\nA,48.1,11.5,500,1,0:5 90:12.5 180:0 270:3\nB,-33,151,10,2,\n' >$tables/sites.csv
printf '{"type":"Polygon","coordinates":[[[170,0],[-170,0],[-170,20],[170,20],[170,0]],[[175,5],[176,5],[176,6],[175,5]]]}' >$tables/area.geojson
printf 'satellite,start_utc,end_utc\nNW-P01-S01,2025-01-01T01:00:00Z,2025-01-01T02:00:00Z\n' >$tables/outages.csv
printf 'stk.v.11.0\nBEGIN IntervalList\nDateUnitAbrv UTCG\nBEGIN Intervals\n"1 Jan 2025 01:00:00.0" "1 Jan 2025 02:00:00.0" Satellite/NW-P01-S03\nEND Intervals\nEND IntervalList\n' >$tables/outages.int
printf 'phase,add,remove\n2025-01-01,NW-P01-S01 NW-P01-S02,\n2025-02-01,,NW-P01-S01\n' >$tables/phases.csv
find "$work" -type f -size -20k ! -name manifest.json ! -name log | sort | while read -r file; do
    name="$(echo "${file#"$work"/}" | tr / -)"
    # One satellite tells as much as four.
    case "$name" in *P01-S02* | *P02*) continue ;; esac
    case "$file" in
        *.tle) target=tle ;;
        *omm*) target=omm ;;
        *oem*) target=oem ;;
        *opm*) target=opm ;;
        *.sp3) target=sp3 ;;
        *.e) target=stk ;;
        *.csv) target=csv ;;
        *.czml) target=czml ;;
        *.alm) target=yuma ;;
        *) continue ;;
    esac
    cp "$file" "fuzz/corpus/$target/$name"
    # The linter takes its choice of a format from a byte in front: here none of them.
    { printf '\377'; cat "$file"; } >"fuzz/corpus/lint/$name"
done
