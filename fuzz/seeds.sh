#!/bin/sh
# Seeds of the fuzz targets, by the program's own writers; SEM, which it only reads, begins without any, and terrain with two written here:
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

for target in tle omm oem opm sp3 stk csv czml yuma sem lint terrain; do
    mkdir -p "fuzz/corpus/$target"
done
printf 'ncols 2\nnrows 3\nxllcorner 19.75\nyllcorner 9.75\ncellsize 0.5\nNODATA_value -9999\n1 2\n3 4.5\n5 6\n' >fuzz/corpus/terrain/grid.asc
printf 'latitude_deg,longitude_deg,height_m,weight\n10,20,1,1\n10,21,2,2\n11,20,3,3\n11,21,,4\n' >fuzz/corpus/terrain/table.csv
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
