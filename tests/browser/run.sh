#!/usr/bin/env bash
# Opens the report of real runs in headless Chromium. Installs what it needs: Debian's chromium
# and fonts, and playwright-core as pinned in package-lock.json.
#
#   tests/browser/run.sh [PROGRAM]
#
# Screenshots go to target/browser.
set -euo pipefail
cd "$(dirname "$0")"
root=$(cd ../.. && pwd)
program=${1:-$root/target/release/navwalker}
shots=$root/target/browser
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if ! command -v chromium >/dev/null || ! fc-list 2>/dev/null | grep -q DejaVu; then
  apt-get update -qq
  apt-get install -y -qq --no-install-recommends chromium fontconfig fonts-dejavu-core >/dev/null
fi
npm ci --silent --no-audit --no-fund

rm -rf "$shots"
mkdir -p "$shots"
small=(--quiet --set region.step-deg=20 --set time.step-s=1200 --set optimizer.population=8
  --set optimizer.generations=4)

# The paper's study, with a validation and a constellation beside it.
"$program" optimize paper --quiet --out "$work/paper" >/dev/null
"$program" validate --quiet --run "$work/paper" --against sgp4 --out "$work/paper/validation" >/dev/null
"$program" report "$work/paper" --design star=star:86.4:180/12/1@925 >/dev/null

# The paper's four kinds of constellation with 182 satellites (rows 2 of its Table II), without a run.
mkdir "$work/four"
"$program" report paper --quiet --design Proposed=delta:55:182/13/1@925 --design Polar=star:90:182/13/1@925 \
  --design Iridium-like=star:86.4:182/13/1@925 --design Optimised-LFC=lattice:78.2:182/13/12@1000 \
  --out "$work/four/report.html" >/dev/null

# A hybrid of two shells, and satellites from a file with a hostile name.
mkdir "$work/files"
"$program" export --quiet --design star:86.4:66/6/2@780 --as tle --out "$work/iridium" >/dev/null
hostile=$'<img src=x onerror=window.attacked=1>\u202etle.<b>'
cp "$work/iridium/constellation.tle" "$work/$hostile"
"$program" report paper --quiet --set region.step-deg=20 --set time.step-s=1200 \
  --design hybrid=delta:53:72/6/1@1050+star:90:60/6/1@800 --constellation "$work/$hostile" \
  --out "$work/files/report.html" >/dev/null

# 300 satellites.
"$program" optimize "${small[@]}" --set search.planes='[15, 15]' \
  --set search.satellites-per-plane='[20, 20]' --out "$work/many" --report >/dev/null

# A search among two shells, one of which may be empty.
"$program" optimize "${small[@]}" --set 'objectives.minimize=["satellites", "cvar-pdop"]' \
  --set 'search.shells=[{planes=[3,6],satellites-per-plane=[4,8]},{planes=2,satellites-per-plane=[0,6],inclination-deg=90}]' \
  --out "$work/shells" --report >/dev/null

# Three objectives over points, on an ellipse of the Earth.
printf 'latitude_deg,longitude_deg\n52,5\n48,11\n41,-4\n' > "$work/points.csv"
printf '[region]\npoints = "%s"\n' "$work/points.csv" > "$work/points.toml"
"$program" optimize "$work/points.toml" --quiet --set time.step-s=1200 --set optimizer.population=8 \
  --set optimizer.generations=4 --set 'objectives.minimize=["mean-pdop", "satellites", "availability"]' \
  --out "$work/points" --report >/dev/null

# A wall in the east, and a mask of its own for GNSS.
"$program" optimize "${small[@]}" --set 'visibility.mask-table=[[0, 5], [1, 80], [179, 80], [180, 5], [360, 5]]' \
  --set visibility.gnss-mask-deg=12 --set 'objectives.minimize=["satellites", "mean-visible"]' \
  --out "$work/walled" --report >/dev/null

# Nothing feasible, a damaged front with hostile texts, and a front of ten thousand.
"$program" optimize "${small[@]}" --set 'objectives.constraints=["max-pdop <= 0.1"]' \
  --out "$work/empty" --report >/dev/null || [ $? = 1 ]
node hostile.mjs "$work/many" "$work/hostile" "$work/large"
"$program" report --quiet "$work/hostile" >/dev/null
"$program" report --quiet "$work/large" >/dev/null

# The pages of a search for the fewest satellites, and of a sweep.
space=(--quiet --set region.step-deg=25 --set time.step-s=1200 --set search.planes='[5, 7]' --set search.satellites-per-plane='[5, 8]'
  --set search.inclination-step-deg=5 --set search.altitude-step-km=150)
"$program" size "${space[@]}" --set 'objectives.constraints=["mean-visible >= 1.5", "mean-pdop <= 1.45"]' --slack 8 --out "$work/size" >/dev/null
"$program" sweep "${space[@]}" --out "$work/sweep" >/dev/null

node check.mjs "$work" "$shots"
