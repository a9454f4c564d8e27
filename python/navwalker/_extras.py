"""Packages that only some functions need."""

import importlib
from typing import Any

_EXTRA_OF = {
    "matplotlib.pyplot": "plot",
    "pandas": "pandas",
    "polars": "polars",
    "pyarrow": "arrow",
    "pymoo.core.problem": "pymoo",
    "xarray": "xarray",
}


def needed(module: str, what: str) -> Any:
    """The module that ``what`` needs, or an error that names the extra to install."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        extra = _EXTRA_OF[module]
        message = f"{what} needs {package}: pip install 'navwalker[{extra}]'"
        raise ImportError(message) from error
