# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments. Each function returns the value in the form that the library takes, or raises UsageError with
the argument's name, its value, and the expected value. InputError is raised for a number in an array that no mesh can
have, ResourceError for arrays too large to copy."""

import collections.abc as _abc
import decimal as _decimal
import math as _math
import numbers as _numbers
import os as _os
import reprlib as _reprlib

import numpy as _np

from ._core import InputError, ResourceError, UsageError

LARGEST = 0xffffffff  # largest count or index: these have 32 bits in the library
_DEEPEST = 64  # levels of nested lists in a scene; a deeper list must contain itself

_short = _reprlib.Repr()
_short.maxstring = _short.maxother = 60
_short.maxlist = _short.maxtuple = _short.maxdict = 4


def shown(value):
    """Returns the value for messages: shortened, or an array's type and shape."""
    if isinstance(value, _np.ndarray) and value.ndim > 0:
        return f"(an array of {value.dtype}, shape {value.shape})"
    return _short.repr(value)


def _refuse(name, value, expected):
    return UsageError(f"{name} {shown(value)}: expected {expected}")


def text(name, value, expected="a text"):
    """Returns a text; an empty one for None."""
    if value is None:
        return ""
    if not isinstance(value, str):
        raise _refuse(name, value, expected)
    try:
        value.encode()
    except UnicodeEncodeError:
        raise UsageError(f"{name} {value!r}: not Unicode, which has no halves of surrogate pairs; expected {expected}") from None
    return str(value)


def name_of(name, value):
    """Returns a text; refuses None."""
    if value is None:
        raise _refuse(name, value, "a name")
    return text(name, value, "a name")


def names(name, value, expected="a name, or a list of names", numbers=False):
    """Returns a list of texts from one text or several; an empty list for None. `numbers`: an index may replace a
    name."""
    if value is None:
        return []
    if isinstance(value, str) or (numbers and isinstance(value, _numbers.Integral)):
        value = [value]
    if isinstance(value, (bytes, _abc.Mapping)) or not isinstance(value, _abc.Iterable):
        raise _refuse(name, value, expected)
    listed = [str(int(one)) if numbers and isinstance(one, _numbers.Integral) else one for one in value]
    for one in listed:
        if one is None:
            raise _refuse(name, one, expected)
        text(name, one, expected)
    return listed


def path(name, value, expected="a file's name"):
    """Returns a file's name."""
    try:
        value = _os.fspath(value)
        if b"\0" in _os.fsencode(value):
            raise ValueError
    except (TypeError, ValueError):  # UnicodeEncodeError is a ValueError
        raise _refuse(name, value, expected) from None
    return value


def flag(name, value):
    """Returns True or False; also accepts 1 or 0."""
    if not isinstance(value, (bool, _np.bool_, _numbers.Integral)) or value not in (0, 1):
        raise _refuse(name, value, "True or False")
    return bool(value)


def _as_number(value):
    """Returns the value as int or float; None if it is not a real number."""
    if isinstance(value, _np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, (bool, _np.bool_)) or not isinstance(value, (_numbers.Real, _decimal.Decimal)):
        return None
    try:
        return int(value) if isinstance(value, _numbers.Integral) else float(value)
    except (OverflowError, ValueError):
        return None


def number(name, value, expected="a number"):
    """Returns a number as float. It may be NaN, which the library refuses with its own message."""
    found = _as_number(value)
    try:
        if found is not None:
            return float(found)
    except OverflowError:
        pass
    raise _refuse(name, value, expected)


def finite(name, value, expected="a finite number"):
    """Returns a number that is neither NaN nor infinite; None stays None."""
    if value is None:
        return None
    found = number(name, value, expected)
    if not _np.isfinite(found):
        raise _refuse(name, value, expected)
    return found


def whole(name, value, least=0, expected=None):
    """Returns an integer of at least `least`; 0 for None."""
    if value is None:
        return 0
    found = _as_number(value)
    if found is None or not least <= found <= LARGEST or found != int(found):
        raise _refuse(name, value, expected or f"a whole number, from {least} on")
    return int(found)


def size(value):
    """Returns width and height; (0, 0) for None."""
    if value is None:
        return 0, 0
    expected = "two whole numbers of pixels, at least 1"
    if isinstance(value, (str, bytes, _abc.Mapping, _abc.Set)) or not isinstance(value, _abc.Iterable):
        raise _refuse("size", value, expected)
    sides = list(value)
    if len(sides) != 2 or any(side is None for side in sides):
        raise _refuse("size", value, expected)
    for side in sides:
        found = _as_number(side)
        if found is None or not 1 <= found <= LARGEST or found != int(found):
            raise _refuse("size", value, expected)
    return int(sides[0]), int(sides[1])


def function(name, value, optional=True):
    """Returns a callable object, or None."""
    if not (callable(value) or (optional and value is None)):
        raise _refuse(name, value, "a function" + (" or None" if optional else ""))
    return value


def _array(name, value, expected):
    """Returns an array of real numbers. numpy alone would read numbers from texts, and silently drop imaginary parts
    and masks."""
    try:
        array = _np.asarray(value)
    except (TypeError, ValueError, RuntimeError, OverflowError) as error:
        raise UsageError(f"{name}: {expected}; numpy: {error}") from None
    if array.dtype.kind not in "iuf" and array.size > 0:
        raise UsageError(f"{name}: {expected}, not {_kind(array)}")
    if _np.ma.is_masked(value):
        raise UsageError(f"{name}: {expected}, without masked entries")
    return array


def _kind(array):
    kinds = {"c": "complex numbers", "O": "objects, or rows of different lengths", "U": "texts", "S": "bytes", "b": "bools"}
    return f"{kinds.get(array.dtype.kind, 'others')} ({array.dtype})"


def _available_bytes():
    """Returns the machine's available memory in bytes; None if it cannot be read."""
    try:
        with open("/proc/meminfo") as lines:
            return next(int(line.split()[1]) << 10 for line in lines if line.startswith("MemAvailable"))
    except (OSError, StopIteration, ValueError, IndexError):
        return None


def _rows_of_three(name, value, expected):
    """Returns an array (N, 3) whose copies fit into memory: otherwise the system would kill the process that makes
    them."""
    array = _array(name, value, expected)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)  # an empty list
    if array.ndim != 2 or array.shape[1] != 3:
        raise UsageError(f"{name}: {expected}, not of shape {array.shape}")
    needed = 3 * 8 * array.size  # one copy here, two in the library
    available = _available_bytes() if needed > 256 << 20 else None
    if available is not None and needed > available:
        raise ResourceError(f"{name}: an array of shape {array.shape} needs about {needed / 2 ** 30:.1f} GiB of memory, more than the "
                            f"{available / 2 ** 30:.1f} GiB that this machine has left; a mesh with fewer triangles needs less")
    return array


def _converted(name, array, kind):
    """Returns the array as one contiguous block of another type."""
    try:
        return _np.ascontiguousarray(array, kind)
    except MemoryError:
        raise ResourceError(f"{name}: an array of shape {array.shape} needs more memory than this process can have") from None


def rows(name, value, letter="V"):
    """Returns positions (V, 3) in double."""
    return _converted(name, _rows_of_three(name, value, f"expected numbers of shape ({letter}, 3)"), _np.float64)


def faces(name, value):
    """Returns faces (F, 3): indices of vertices."""
    array = _rows_of_three(name, value, "expected whole numbers of vertices, of shape (F, 3)")
    is_whole = (array >= 0) & (array <= LARGEST)
    if array.dtype.kind == "f":
        is_whole &= array == _np.floor(array)
    wrong = _np.flatnonzero(~is_whole.all(axis=1))
    if len(wrong) > 0:
        row = array[wrong[0]]
        error = InputError if (row == _np.floor(row)).all() and _np.isfinite(row).all() else UsageError
        raise error(f"{name}: row {wrong[0]} is {row.tolist()}; expected whole numbers of vertices, from 0 on")
    return _converted(name, array, _np.int64)


def vector(name, value):
    """Returns three numbers as a tuple of floats."""
    array = _array(name, value, "expected three numbers")
    if array.shape != (3,):
        raise _refuse(name, value, "three numbers")
    return tuple(array.astype(float).tolist())


def matrix(name, value):
    """Returns a matrix (4, 4), or its sixteen numbers row by row."""
    expected = "expected a matrix of numbers of shape (4, 4)"
    array = _array(name, value, expected)
    if array.shape not in ((4, 4), (16,)):
        raise UsageError(f"{name}: {expected}, not of shape {array.shape}")
    return _np.ascontiguousarray(array, float)


def values_of(name, answer, masks):
    """Returns the result of a method's function as an array: numbers, or with `masks` bools."""
    expected = f"{name}: expected its function to return " + ("bools of shape (K, N)" if masks else "V as numbers of shape (K,)")
    try:
        array = _np.asarray(answer)
    except (TypeError, ValueError, RuntimeError, OverflowError) as error:
        raise UsageError(f"{expected}; numpy: {error}") from None
    if array.dtype.kind not in ("biu" if masks else "biuf"):
        raise UsageError(f"{expected}, not {_kind(array)}")
    return _np.ascontiguousarray(array, bool if masks else _np.float32)


def options(name, given):
    """Returns a method's options as texts."""
    if given is None:
        return {}
    if not isinstance(given, _abc.Mapping):
        raise _refuse(name, given, 'a dict, such as {"size": 512}')
    texts = {}
    for key, value in given.items():
        name_of(f"{name}: the key", key)
        if isinstance(value, (bool, _np.bool_)):
            texts[key] = "on" if value else "off"
        elif isinstance(value, str):
            texts[key] = text(f"{name}: {key}", value)
        else:
            found = _as_number(value)
            if found is None:
                raise _refuse(f"{name}: {key}", value, "a number, a text or a bool")
            texts[key] = str(value if isinstance(value, (int, float, _np.number)) else found)
    return texts


def _are_finite(values):
    """Returns whether these are finite numbers, all of Python's own types."""
    try:
        return set(map(type, values)) <= {int, float} and all(map(_math.isfinite, values))
    except OverflowError:
        return False


def plain(value, place=""):
    """Returns a value of a scene's dict in the form that JSON supports. `place` is the JSON pointer to the value."""
    where = place or "the scene"
    if isinstance(value, (_np.ndarray, _np.generic)):
        value = value.tolist()  # complex numbers and objects are refused below
    if isinstance(value, (list, tuple)) and _are_finite(value):
        return list(value)
    if value is None or isinstance(value, (bool, str)):
        return text(where, value) if isinstance(value, str) else value
    if isinstance(value, _numbers.Real):
        found = _as_number(value)
        try:
            if found is not None and _np.isfinite(float(found)):
                return found
        except OverflowError:
            pass
        raise InputError(f"{where}: {shown(value)}; expected a finite number")
    if place.count("/") > _DEEPEST:
        raise UsageError(f"{place[:60]}…: lists in lists, more than {_DEEPEST}; does one contain itself?")
    if isinstance(value, _abc.Mapping):
        for key in value:
            name_of(f"{where}: the key", key)
        return {key: plain(part, f"{place}/{key.replace('~', '~0').replace('/', '~1')}") for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part, f"{place}/{index}") for index, part in enumerate(value)]
    if isinstance(value, _os.PathLike):
        return plain(path(where, value), place)
    raise _refuse(where, value, "a number, a text, a bool, a list, an array, a dict or None")
