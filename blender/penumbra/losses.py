# SPDX-License-Identifier: Apache-2.0
"""Parts of a scene that a picture will not show."""

import re

_NUMBER = re.compile(r"[0-9.]+(e[-+]?[0-9]+)?")


class Losses:
    """`refused`: losses that would change or remove a shadow. `mentioned`: losses that change how a surface looks, or
    that are by design. Both map the text of a loss to the names that it concerns."""

    def __init__(self):
        self.refused, self.mentioned = {}, {}

    def refuse(self, what, name):
        self.refused.setdefault(what, {})[name] = None

    def mention(self, what, name):
        self.mentioned.setdefault(what, {})[name] = None

    def take_news(self, other):
        """Adds the losses of `other` that are missing here, and returns only these. Texts that differ only in numbers
        are the same: those of one scene at another time."""
        news = Losses()
        for mine, theirs, new in ((self.refused, other.refused, news.refused), (self.mentioned, other.mentioned, news.mentioned)):
            known = {(_NUMBER.sub("", what), name) for what, names in mine.items() for name in names}
            for what, names in theirs.items():
                for name in names:
                    if (_NUMBER.sub("", what), name) not in known:
                        for into in (mine, new):
                            into.setdefault(what, {})[name] = None
        return news


def together(several):
    """Returns the union of several Losses."""
    whole = Losses()
    for one in several:
        for into, what in ((whole.refused, one.refused), (whole.mentioned, one.mentioned)):
            for text, names in what.items():
                into.setdefault(text, {}).update(names)
    return whole


def sentences(losses):
    """Returns one message for each loss, with up to four names."""
    texts = []
    for what, names in losses.items():
        names = [f"'{name}'" for name in names]
        more = f" and {len(names) - 4} more" if len(names) > 4 else ""
        texts.append(f"{', '.join(names[:4])}{more} {what}")
    return texts
