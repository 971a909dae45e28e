# SPDX-License-Identifier: Apache-2.0
"""Parts of a scene that a picture will not show."""

import re

_NUMBER = re.compile(r"[0-9.]+(e[-+]?[0-9]+)?")


class Losses:
    """`refused`: it would change a shadow, or take one away. `mentioned`: it changes how a surface looks, or is left out
    by design. Both: what, to the names that it is about."""

    def __init__(self):
        self.refused, self.mentioned = {}, {}

    def refuse(self, what, name):
        self.refused.setdefault(what, {})[name] = None

    def mention(self, what, name):
        self.mentioned.setdefault(what, {})[name] = None

    def take_news(self, other):
        """Adds what `other` has and this has not, numbers in the texts apart: of one scene a little later. Returns that alone."""
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
    """Returns the losses of all in one."""
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
