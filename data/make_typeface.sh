#!/bin/sh
# Cuts Arimo down to the characters of figures: pip install fonttools brotli; apt-get download fonts-croscore
#
#     sh data/make_typeface.sh Arimo-Regular.ttf
#
# The characters are those of European languages in Latin, Greek and Cyrillic script, and the symbols of formulas and units.
set -eu
cd "$(dirname "$0")/typeface"
characters="U+0020-007E,U+00A0-017F,U+0370-03FF,U+0400-045F,U+2010-2027,U+2030-203A,U+2044,U+2070-209C,U+20AC,U+2113,U+2122"
characters="$characters,U+2190-2193,U+2202,U+2206,U+2211-221E,U+222B,U+2248,U+2260-2265,U+25CA,U+FFFD"
pyftsubset "$1" --unicodes="$characters" --no-hinting --desubroutinize --layout-features=kern,mark,mkmk,ccmp \
    --notdef-outline --name-IDs=0,1,2,3,4,5,6,13,14 --output-file=arimo.ttf
pyftsubset arimo.ttf --unicodes='*' --flavor=woff2 --layout-features='*' --name-IDs='*' --notdef-outline --output-file=arimo.woff2
