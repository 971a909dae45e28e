# SPDX-License-Identifier: Apache-2.0
"""Claims of tests of pages and live views: all are looked at, and those that do not hold are printed."""

_failed = []


def expect(claim, what):
    if not claim:
        _failed.append(what)
        print(f"FAILED: {what}")


def same(found, wanted, what):
    expect(found == wanted, f"{what}: {found!r}, not {wanted!r}")


def verdict():
    """The exit code."""
    print("failed" if _failed else "all is as it should be")
    return 1 if _failed else 0
