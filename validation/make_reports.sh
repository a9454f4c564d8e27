#!/bin/sh
# Makes the committed reports anew, with the release binary:
#     sh validation/make_reports.sh [path/to/navwalker]
set -eu
cd "$(dirname "$0")/.."
program=${1:-target/release/navwalker}
mkdir -p validation/reports
for scenario in paper regional; do
    for form in markdown:md json:json; do
        "$program" validate "$scenario" --against all --format "${form%%:*}" \
            > "validation/reports/$scenario.${form##*:}"
    done
done
repeated=$(mktemp -d)
{
    echo "<!-- navwalker reproduce --quiet --format markdown > validation/reports/reproduce.md -->"
    "$program" reproduce --quiet --out "$repeated/study" --format markdown
} > validation/reports/reproduce.md
{
    echo "<!-- navwalker reproduce --all --quiet --format markdown > validation/reports/studies.md -->"
    "$program" reproduce --all --quiet --out "$repeated/all" --format markdown
} > validation/reports/studies.md
rm -r "$repeated"
