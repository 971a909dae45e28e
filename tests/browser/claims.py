# SPDX-License-Identifier: Apache-2.0
"""Checks for tests of pages and live views: all of them are made, and those that fail are printed."""

_failed = []


def expect(claim, what):
    if not claim:
        _failed.append(what)
        print(f"FAILED: {what}")


def same(found, wanted, what):
    expect(found == wanted, f"{what}: {found!r}, not {wanted!r}")


def verdict():
    """Prints the result and returns the exit code."""
    print("failed" if _failed else "all is as it should be")
    return 1 if _failed else 0
