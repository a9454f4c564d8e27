#!/usr/bin/env bash
# Builds the source distribution and the wheel, installs that into a clean virtual environment and runs its tests, types, doctests and
# notebooks; the reference of the module goes to DIR/reference. The wheel is built in the checkout, whose release build it shares; that
# the source distribution has the same sources is compared.
set -euo pipefail
cd "$(dirname "$0")/.."
work="${1:?a directory to work in}"
mkdir -p "$work"
python3 -m venv "$work/venv"
bin="$work/venv/bin"
"$bin/pip" install --quiet --disable-pip-version-check 'maturin>=1.9,<2'
"$bin/maturin" sdist --manifest-path python/Cargo.toml --out "$work/sdist" 2>"$work/sdist.log" || { cat "$work/sdist.log"; exit 1; }
mkdir "$work/unpacked"
tar --extract --gzip --file "$work"/sdist/*.tar.gz --directory "$work/unpacked" --strip-components 1
for needed in src data build.rs Cargo.lock python/src; do
    diff --recursive --brief --exclude __pycache__ --exclude '*.so' "$needed" "$work/unpacked/$needed"
done
diff --recursive --brief --exclude __pycache__ --exclude '*.so' python/navwalker "$work/unpacked/navwalker"
"$bin/maturin" build --quiet --release --locked --manifest-path python/Cargo.toml --out "$work/dist"
"$bin/pip" install --quiet --disable-pip-version-check "$work"/dist/*.whl
"$bin/python" -c 'import navwalker as nw; print(nw.Scenario("paper", time_step_s=1800).evaluate("delta:55:182/13/1@925").mean_pdop)'
"$bin/python" -m navwalker --version
"$bin/pip" install --quiet --disable-pip-version-check -r python/requirements-check.txt
"$bin/python" -m pytest --quiet python/tests
"$bin/python" -m pytest --quiet --doctest-modules --pyargs navwalker
"$bin/mypy" --strict python/tests/typed_sample.py
"$bin/basedpyright" --project python/tests/pyrightconfig.json --pythonpath "$bin/python"
"$bin/python" -W error -m pdoc --no-show-source --no-search --output-directory "$work/reference" navwalker
for notebook in examples/notebooks/*.ipynb; do
    (cd "$work" && "$bin/jupyter" execute "$OLDPWD/$notebook" --output "$work/$(basename "$notebook")") >"$work/notebook.log" 2>&1 ||
        { cat "$work/notebook.log"; exit 1; }
    echo "$notebook runs"
done
