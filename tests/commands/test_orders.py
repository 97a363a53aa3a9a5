"""Properties of the keyword checker, command by command: random orders that obey the rows are accepted, and every single mutation of
one is refused with a message that names the keyword."""

import copy
import random
import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
import support  # noqa: E402,F401  (the path of the package)

from lacon.core import catalog, checker  # noqa: E402
from lacon.tools import examples  # noqa: E402

ORDERS, MUTATIONS = 12, 40  # of each command


class Maker:
    """Random orders that obey the rows, by the rows' meaning and not by the checker's code."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def order(self, row):
        """Keywords of a command or factor keyword, from the shortest set on."""
        given = examples.minimal(row)
        names = [name for name in row.get("keyword", {}) if name not in given]
        self.random.shuffle(names)
        for name in names[:self.random.randrange(len(names) + 1)]:
            candidate = examples.close(row, {**given, name: None})
            for added in candidate.keys() - given.keys():
                candidate[added] = self.value(row["keyword"][added], added)
            candidate = examples.close(row, candidate)  # values may ask for further keywords
            if obeys(row, candidate):
                given = candidate
        return {name: self.value(row["keyword"][name], name) if self.free(row, name, given) else given[name] for name in given}

    def free(self, row, name, given):
        """No condition looks at the value of a keyword, so that any will do."""
        return not any(name in when.get("if", {}) for when in row.get("when", ()))

    def value(self, keyword, name):
        most = keyword.get("max", 1)
        count = self.random.randint(keyword.get("min", 1), keyword.get("min", 1) + 2 if most == "many" else most)
        if keyword["type"] == "factor":
            made = [self.order(keyword) for _ in range(count)]
        else:
            allowed = keyword.get("into")
            if keyword.get("unique") and allowed:
                count = min(count, len(allowed))
            first = self.random.randrange(len(allowed)) if allowed else 0
            made = [examples.single(keyword, first + i, name) for i in range(count)]
        return made[0] if count == 1 else made


def obeys(row, given):
    """Exclusions and prohibitions hold; occurrences have themselves what the command could hand down to them."""
    down = row.get("hands_down", {"keywords": (), "to": ()})
    if any(name in given for name in down["to"]) and any(name in given for name in down["keywords"]):
        return False
    for rule in row.get("rule", ()):
        if rule["kind"] in ("exactly_one", "exclusive") and sum(name in given for name in rule["of"]) > 1:
            return False
    keywords = row.get("keyword", {})
    return not any(examples.holds(when, keywords, given) and any(name in given for name in when.get("forbidden", ()))
                   for when in row.get("when", ()))


def levels(row, given):
    """(row, keywords) of the command and of every occurrence of its factor keywords."""
    yield row, given
    for name, value in given.items():
        keyword = row["keyword"][name]
        if keyword["type"] == "factor":
            for occurrence in value if isinstance(value, list) else [value]:
                yield from levels(keyword, occurrence)


def mutations(row, given):
    """(what is wrong, the names of which a message must have one, how to do it) of one set of keywords."""
    keywords = row.get("keyword", {})

    def put(name, value):
        return lambda: given.__setitem__(name, value)

    if "others" not in row:
        yield "unknown", ["NO_SUCH_KEYWORD"], put("NO_SUCH_KEYWORD", 1)
    for name in row.get("elsewhere", ()):
        yield "elsewhere", [name], put(name, 1)
    for rule in row.get("rule", ()):
        there = [name for name in rule["of"] if name in given]
        others = [name for name in rule["of"] if name not in given]
        if rule["kind"] in ("exactly_one", "exclusive") and there and others:
            yield "exclusive", others[:1], put(others[0], examples.value(keywords[others[0]], others[0]))
        if rule["kind"] in ("exactly_one", "at_least_one") and len(there) == 1:
            yield "none of them", there, lambda name=there[0]: given.pop(name)
        if rule["kind"] == "together" and len(there) > 1:
            yield "not together", there, lambda name=there[0]: given.pop(name)
    for when in row.get("when", ()):
        if examples.holds(when, keywords, given):
            for name in when.get("forbidden", ()):
                if name not in given and name not in when.get("absent", ()):
                    yield "forbidden", [name], put(name, examples.value(keywords[name], name))
    for name, keyword in keywords.items():
        if name not in given:
            continue
        value = given[name]
        if keyword.get("status") == "mandatory":
            yield "missing", [name], lambda name=name: given.pop(name)
        yield "of another type", [name], put(name, 3.5 if keyword["type"] == "factor" else {"NOT": "A VALUE"})
        most = keyword.get("max", 1)
        if most != "many":
            one = value[0] if isinstance(value, list) else value
            yield "too many", [name], put(name, [copy.copy(one)] * (most + 1))
        if keyword["type"] == "factor" or keyword.get("makes"):
            continue
        if "into" in keyword or "into_from" in keyword:
            yield "not one of them", [name], put(name, [-12345 if keyword["type"] == "integer" else "NO SUCH VALUE"] * keyword.get("min", 1))
        for value in keyword.get("elsewhere", ()):
            yield "a value from elsewhere", [name], put(name, value)
        for bound, beyond in (("above", 0), ("at_least", -1), ("below", 0), ("at_most", 1)):
            if bound in keyword:
                kind = int if keyword["type"] == "integer" else float
                yield "out of bounds", [name], put(name, [kind(keyword[bound] + beyond)] * keyword.get("min", 1))
        if keyword.get("unique"):
            yield "twice", [name], put(name, [examples.single(keyword, 0, name)] * 2)


class Orders(unittest.TestCase):
    def test_examples_are_accepted(self):
        for command in catalog.command_names():
            row = catalog.command(command)
            with self.subTest(command=command):
                self.assertEqual(checker.complete(command, row, examples.minimal(row))[1], [])
                self.assertIn(f"{command}(", examples.text(command))

    def test_random_orders_are_accepted(self):
        for command in catalog.command_names():
            row, maker = catalog.command(command), Maker(command)
            for k in range(ORDERS):
                given = maker.order(row)
                problems = checker.complete(command, row, given)[1]
                self.assertEqual(problems, [], f"{command}, order {k}: {given}")

    def test_every_mutation_is_refused_by_name(self):
        seen = set()
        for command in catalog.command_names():
            row, maker = catalog.command(command), Maker(command)
            for k in range(MUTATIONS):
                order = maker.order(row)
                where, given = maker.random.choice(list(levels(row, order)))
                possible = list(mutations(where, given))
                if not possible:
                    continue
                what, names, mutate = maker.random.choice(possible)
                mutate()
                seen.add(what)
                problems = checker.complete(command, row, order)[1]
                self.assertTrue(any(name in problem.text for problem in problems for name in names),
                                f"{command}, order {k}, {what} {names}: {[p.text for p in problems]}")
        self.assertEqual(seen, {"unknown", "elsewhere", "exclusive", "none of them", "forbidden", "missing", "of another type", "too many",
                                "not one of them", "a value from elsewhere", "out of bounds", "twice", "not together"})


if __name__ == "__main__":
    unittest.main()
