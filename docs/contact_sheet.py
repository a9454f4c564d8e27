"""Draws every figure of `navwalker plot` at 85 mm from small studies and puts them on one sheet, docs/figures.png.

    python docs/contact_sheet.py PROGRAM [docs/figures.png]

Needs Pillow. The sheet is for the eye; the figures themselves are checked by the tests of `src/report/figures`.
"""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

COLUMNS = 4
CELL = (480, 430)

DESIGN = "--design delta:55:182/13/1@925"
SMALL = "--set region.step-deg=10 --set time.step-s=600"
FIGURES = [
    "run --figure pareto",
    "run --figure convergence",
    "run --figure budget",
    f"paper {DESIGN} --figure map --measure mean-pdop",
    f"paper {DESIGN} --figure map --measure mean-visible",
    f"paper {DESIGN} --figure map --measure longest-outage-s --set objectives.availability-pdop=1.6",
    f"global {DESIGN} --set region.step-deg=5 --set time.step-s=1200 --figure map --measure max-pdop --clip-percentile 98",
    f"paper {DESIGN} --set region.country=\"Japan\" --set region.spacing-km=60 --set time.step-s=600 --figure map --measure mean-pdop",
    f"paper {DESIGN} --figure cdf --measure pdop",
    f"paper {DESIGN} --design star:90:182/13/1@925 --figure series --measure mean-pdop",
    f"paper {DESIGN} --figure histogram",
    f"paper {DESIGN} --figure timeline --set objectives.availability-pdop=1.6",
    f"paper {DESIGN} {SMALL} --figure failures",
    f"paper {DESIGN} {SMALL} --figure phases --phases phases.csv --set objectives.availability-pdop=1.6",
]


def main(program, sheet):
    program = str(pathlib.Path(program).resolve())
    with tempfile.TemporaryDirectory() as place:

        def run(arguments):
            words = [word.replace('"', "") if "country" in word else word for word in arguments.split(" ")]
            subprocess.run([program, *words, "--quiet"], cwd=place, check=True, stdout=subprocess.DEVNULL)

        run(f"optimize paper {SMALL} --set optimizer.generations=30 --out run")
        run("validate --run run --against sgp4 --report")
        phases = ["phase,add,remove"] + [f"{n} planes,NW-P{n:02d}," for n in range(1, 14)]
        pathlib.Path(place, "phases.csv").write_text("\n".join(phases) + "\n")
        rows = -(-len(FIGURES) // COLUMNS)
        whole = Image.new("RGB", (COLUMNS * CELL[0], rows * CELL[1]), "white")
        for n, figure in enumerate(FIGURES):
            run(f"plot {figure} --width-mm 85 --font-size 7 --as png --out figure.png --force")
            one = Image.open(pathlib.Path(place, "figure.png")).convert("RGB")
            one.thumbnail((CELL[0] - 16, CELL[1] - 16), Image.Resampling.LANCZOS)
            whole.paste(one, (n % COLUMNS * CELL[0] + 8, n // COLUMNS * CELL[1] + 8))
        whole.quantize(64).save(sheet, optimize=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "docs/figures.png")
