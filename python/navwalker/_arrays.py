"""Arrays that the caller gives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from navwalker import _native

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


def numbers(name: str, given: npt.ArrayLike) -> npt.NDArray[np.integer | np.floating]:
    """An argument as an array of integers or reals of any shape."""
    import numpy as np

    try:
        array = np.asarray(given)
    except ValueError as error:
        raise _native.NavwalkerError(f"{name} is no array: {error}") from None
    if array.dtype.kind not in "iuf":
        raise _native.NavwalkerError(f"{name} has the type {array.dtype}, expected numbers")
    return array


def finite(name: str, array: npt.NDArray[np.integer | np.floating]) -> None:
    """Refuses an array with a value that is NaN or infinite."""
    import numpy as np

    wrong = ~np.isfinite(array)
    if wrong.any():
        row = int(np.argmax(wrong.reshape(len(array), -1).any(axis=1)))
        raise _native.NavwalkerError(f"{name} has a value that is not finite in row {row}")
