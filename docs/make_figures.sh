#!/bin/sh
# Draws docs/figures.png, every figure at the width of a column:  sh docs/make_figures.sh target/release/navwalker
#
# Needs Python with Pillow. The search is the paper's with fewer generations.
set -eu
navwalker=$(realpath "$1")
docs=$(realpath "$(dirname "$0")")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
"$navwalker" optimize paper --quiet --set optimizer.generations=12 --set time.step-s=120 --out run >/dev/null
"$navwalker" validate --quiet --run run --against sgp4 --out run/validation >/dev/null
cat >sites.csv <<'CSV'
name,latitude_deg,longitude_deg
Beijing,39.9,116.4
Tianjin,39.1,117.2
Shijiazhuang,38.0,114.5
Tangshan,39.6,118.2
CSV
cat >phases.csv <<'CSV'
phase,add
2026-03,NW-P01 NW-P02
2026-06,NW-P03 NW-P04
2026-09,NW-P05 NW-P06
CSV
plot() {
    name=$1
    shift
    "$navwalker" plot --quiet "$@" --width-mm 85 --font-size 7 --out "$name.png" >/dev/null
}
both="--design delta:55:182/13/1@925 --design star:90:182/13/1@925"
plot a-pareto run --figure pareto
plot b-convergence run --figure convergence
plot c-budget run --figure budget
plot d-map run --figure map
plot e-country --design delta:55:182/13/1@925 --figure map --measure mean-visible --set 'region.country=["Spain","Portugal"]' \
    --set region.spacing-km=50
plot f-globe global --design delta:55:182/13/1@925 --figure map --set region.step-deg=5 --set time.step-s=600
plot g-sites paper --design delta:55:182/13/1@925 --figure map --measure p95-pdop --set region.points=sites.csv
plot h-cdf paper $both --figure cdf --measure pdop --clip-percentile 99
plot i-series paper $both --figure series
plot j-histogram paper $both --figure histogram
plot k-timeline paper --design delta:55:60/6/1@925 --figure timeline --set objectives.availability-pdop=2
plot l-failures paper --design delta:55:60/6/1@925 --figure failures --set time.step-s=300
plot m-phases --design delta:55:60/6/1@925 --figure phases --phases phases.csv --set time.step-s=300
python3 - "$docs/figures.png" <<'PY'
import glob
import sys

from PIL import Image

COLUMNS, WIDTH, GAP = 3, 502, 8
columns = [[] for _ in range(COLUMNS)]
heights = [0] * COLUMNS
for name in sorted(glob.glob("?-*.png")):
    image = Image.open(name).convert("RGB")
    image = image.resize((WIDTH, round(image.height * WIDTH / image.width)), Image.LANCZOS)
    shortest = heights.index(min(heights))
    columns[shortest].append((heights[shortest], image))
    heights[shortest] += image.height + GAP
sheet = Image.new("RGB", (COLUMNS * (WIDTH + GAP) - GAP, max(heights) - GAP), (210, 210, 210))
for column, images in enumerate(columns):
    for top, image in images:
        sheet.paste(image, (column * (WIDTH + GAP), top))
sheet.quantize(128, dither=Image.NONE).save(sys.argv[1], optimize=True)
PY
